#pragma once

#include <vector>

#include "info/design/trajectory_search.h"
#include "info/dynamics/extended_system.h"

/// One motion for several candidate values of θ: the parameters are unknown before the experiment,
/// and a motion that tells much at one θ may tell little at another.
namespace info {

/// How the costs φ_s = φ(I_s) of the S candidates make one.
enum class RobustRule {
  average,  ///< Σ φ_s / S
  worst     ///< (Σ φ_s^q)^{1/q}, q = 20: smooth, and between max φ_s and S^{1/20} max φ_s
};

/// The cost of all candidates and how it follows each information matrix.
struct CandidatesCost {
  double value;
  std::vector<Eigen::MatrixXd> dvalue_dI;
};

/// @param repeatedTolerance as in informationCost
/// @throws as informationCost, and std::domain_error for the worst case with a weight on
///   D-optimality, whose cost may be negative
CandidatesCost candidatesCost(RobustRule rule, const InformationWeights& weights,
                              const std::vector<Eigen::MatrixXd>& information,
                              double repeatedTolerance);

/// The same system at several θ as one, driven by one input: states one below the other, ψ
/// likewise, and Γ, whose rows belong to the candidates in their order. A projection of it takes
/// the design of a single candidate; tracking, model and gain count each candidate with 1/S.
/// @throws std::invalid_argument for no system at all, or sizes that differ
ExtendedStepMap stack(std::vector<ExtendedStepMap> candidates);
ExtendedFlow stack(std::vector<ExtendedFlow> candidates);

}  // namespace info
