#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "bio/arm_experiment.h"
#include "info/identifiability.h"

namespace bio {

/// What measuring one coordinate tells about each parameter, near the model's values.
struct ParameterInformation {
  std::vector<info::Parameter> parameters;  ///< with their default priors
  Eigen::MatrixXd fisher;  ///< Σ ΓᵀΓ/σ² over the samples of all trials, without priors
  /// Root mean square over the samples of dq/dθ·(prior deviation) [rad] or [m]: how far one
  /// standard deviation of what is known of it moves the motion.
  Eigen::VectorXd normalisedSensitivity;
  Eigen::VectorXd boundAlone;  ///< 1/√I_ii: all others known; +∞ without information
  Eigen::VectorXd boundJoint;  ///< √[(I + Λ)⁻¹]_ii, Λ the priors of all
  /// The data at least halve what was uncertain: boundJoint ≤ deviation/2.
  std::vector<bool> identifiable;
  Eigen::MatrixXd correlation;  ///< of estimates at the joint bound
  /// Independent combinations about which the data at least halve what was uncertain.
  Eigen::Index determinedCombinations = 0;
  /// What cannot be told apart, in words: how much is determined, pairs of which only a product or
  /// a sum is, most influential first, and what moves nothing.
  std::vector<std::string> sentences;
};

/// @param gammas  Γ of each trial: samples × parameters
/// @param noise   standard deviation of a measured value [rad] or [m] > 0
/// @throws std::invalid_argument if shapes do not fit, or the noise is not > 0; std::domain_error
///   if a Γ is not finite
ParameterInformation informationAbout(const ParameterCatalogue& catalogue,
                                      const std::vector<std::size_t>& selection,
                                      const std::vector<Eigen::MatrixXd>& gammas, double noise);

/// Two parameters whose effects look alike.
struct AlikePair {
  Eigen::Index first, second;
  double correlation;  ///< of their estimates if all others were known, −1 … 1
};
/// Pairs with |correlation| ≥ limit, the strongest first; parameters without information are left
/// out.
std::vector<AlikePair> alikePairs(const Eigen::MatrixXd& fisher, double limit);

}  // namespace bio
