#pragma once

#include "info/design/riccati.h"

/// Rules of an LQ problem, whichever way of time; each throws with quantity, value and rule.
namespace info::detail {

/// A problem's sizes and the weights that may be left out, filled in.
struct CheckedLq {
  Eigen::Index n, m;
  std::size_t steps;
  Eigen::MatrixXd S, Qf;
};
CheckedLq checkLq(const LinearSequence& system, const QuadraticWeights& weights, bool continuous);

void checkLinearCost(const LinearCost& cost, const CheckedLq& problem, std::size_t inputs);

/// @throws std::domain_error if the solution of the Riccati equation at a node is not finite
void checkRiccati(const Eigen::MatrixXd& P, std::size_t node);

}  // namespace info::detail
