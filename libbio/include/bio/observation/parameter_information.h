#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "bio/observation/trial_predictor.h"
#include "info/information/identifiability.h"

namespace bio {

/// Information of a measured coordinate about each parameter, near the model's values.
struct ParameterInformation {
  std::vector<info::Parameter> parameters;  ///< with their default priors
  Eigen::MatrixXd fisher;  ///< Σ ΓᵀΓ/σ² over the samples of all trials, without priors
  /// RMS over the samples of dq/dθ·(prior sd) [rad] or [m]: change of the motion per prior standard
  /// deviation.
  Eigen::VectorXd normalisedSensitivity;
  Eigen::VectorXd boundAlone;  ///< 1/√I_ii: all others known; +∞ without information
  Eigen::VectorXd boundJoint;  ///< √[(I + Λ)⁻¹]_ii, Λ the priors of all
  /// True if the data at least halve the prior standard deviation: boundJoint ≤ deviation/2.
  std::vector<bool> identifiable;
  Eigen::MatrixXd correlation;  ///< of the estimates at the joint bound
  /// Number of independent combinations whose uncertainty the data at least halve.
  Eigen::Index determinedCombinations = 0;
  /// Identifiability in words: number of determined combinations, pairs of which only a product or
  /// a sum is determined (most influential first), and parameters without effect.
  std::vector<std::string> sentences;
};

/// @param gammas  Γ of each trial: samples × parameters
/// @param noise   standard deviation of a measured value [rad] or [m] > 0
/// @throws std::invalid_argument if shapes do not fit, or the noise is not > 0; std::domain_error
///   if a Γ is not finite
ParameterInformation informationAbout(const ParameterCatalogue& catalogue,
                                      const std::vector<std::size_t>& selection,
                                      const std::vector<Eigen::MatrixXd>& gammas, double noise);

/// Two parameters with similar effects.
struct AlikePair {
  Eigen::Index first, second;
  double correlation;  ///< correlation of their estimates if all others were known, −1 … 1
};
/// Pairs with |correlation| ≥ limit, the strongest first; parameters without information are left
/// out.
std::vector<AlikePair> alikePairs(const Eigen::MatrixXd& fisher, double limit);

}  // namespace bio
