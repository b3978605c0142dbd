#pragma once

#include <Eigen/Dense>

#include "info/design/projected_motion.h"

/// Rules that both projections check; each throws with quantity, value and rule.
namespace info::detail {

/// Sizes of one candidate, and how many there are.
struct CandidateSizes {
  Eigen::Index n, m, p, h;
  int count;
};
template <class Extended>
CandidateSizes sizesOf(const Extended& system) {
  const Dimensions d = system.dimensions;
  return {d.state / system.candidates, d.input, d.parameter, d.output / system.candidates,
          system.candidates};
}

/// Fills an empty weight with zeros, unless it must be definite.
void fillWeight(const char* name, Eigen::MatrixXd& W, Eigen::Index size, bool definite);

/// A weight on (x, e more, vec ψ of p columns) of one candidate as one on the states of all, each
/// candidate counted with 1/count.
Eigen::MatrixXd overCandidates(const Eigen::MatrixXd& W, const CandidateSizes& sizes,
                               Eigen::Index more, Eigen::Index p);

/// Checks a design of one candidate, and fills and spreads it over all of them.
/// @param more states of the direction beside (x, vec ψ), fed back as well
void prepareDesign(MotionDesign& design, const CandidateSizes& sizes, Eigen::Index more);

/// Σ⁻¹. @throws std::domain_error unless Σ is symmetric and positive definite
Eigen::MatrixXd inverseCovariance(const Eigen::MatrixXd& covariance, Eigen::Index outputs);

/// Each of `count` inputs has `size` entries, all finite.
void checkInputs(const char* name, const std::vector<Eigen::VectorXd>& inputs, std::size_t count,
                 Eigen::Index size);

}  // namespace info::detail
