#pragma once

#include <vector>

#include "info/estimation/estimate.h"

namespace info {

/// Convergence of one iteration of an estimation.
struct ConvergenceRow {
  int iteration;
  double cost;
  double error;  ///< e_k = |θ_k − θ*|
  double
      ratio;  ///< e_k/e_{k−1}: a constant below 1 is linear convergence, a falling one superlinear
  double
      order;  ///< ln(e_k/e_{k−1})/ln(e_{k−1}/e_{k−2}): 1 linear, 2 quadratic; NaN where undefined
};

/// The history of an estimation relative to a known minimum. θ is compared in units of its own
/// components at the minimum, e_k = |diag(1/θ*)(θ_k − θ*)|, where these are not 0.
std::vector<ConvergenceRow> convergenceTable(const Estimate& estimate,
                                             const Eigen::VectorXd& minimum);

}  // namespace info
