#pragma once

#include <Eigen/Dense>

#include "bio/analysis/sensitivity_study.h"
#include "bio/sensitivity/cost_gradient.h"

namespace bio {

/// What gradientOfOutputs() finds.
struct OutputGradient {
  Eigen::VectorXd outputs;  ///< y, as of predictorOf()
  CostGradient sum;         ///< J and its derivatives
};

/// J = Σ w_i y_i(θ) over all that is measured of a trial, with dJ/dθ and dJ/du by one sweep back:
/// wᵀ dy/dθ for the price of a few simulations, however many parameters there are.
/// @param question  as predictorOf() takes it; coordinates, their speeds and markers only
/// @param theta     of the selection
/// @param weights   w, as long as the outputs of predictorOf() [1 / unit of the output]
/// @return J and derivatives are NaN if the motion ends before the last sample
/// @throws std::invalid_argument for weights that are not finite or not as many as outputs,
///   observables without an adjoint, and what simulateWithGradient() throws
OutputGradient gradientOfOutputs(const StudiedTrial& trial, const SensitivityQuestion& question,
                                 const Eigen::VectorXd& theta, const Eigen::VectorXd& weights);

}  // namespace bio
