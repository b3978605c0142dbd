#pragma once

#include <vector>

#include "info/design/trajectory_search.h"
#include "info/dynamics/extended_system.h"

/// One motion for several candidate values of θ: the parameters are unknown before the experiment,
/// and a motion that is informative at one θ may be uninformative at another.
namespace info {

/// Combination of the costs φ_s = φ(I_s) of the S candidates.
enum class RobustRule {
  average,  ///< Σ φ_s / S
  worst     ///< (Σ φ_s^q)^{1/q}, q = 20: smooth, and between max φ_s and S^{1/20} max φ_s
};

/// The cost of all candidates and its gradient in each information matrix.
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

/// Several copies of a system at different θ, driven by one input: their states, ψ and rows of Γ
/// are stacked in the order of the candidates. A projection of the stack takes the design of a
/// single candidate; in tracking, model and gain each candidate has the weight 1/S.
/// @throws std::invalid_argument if there is no system or sizes differ
ExtendedStepMap stack(std::vector<ExtendedStepMap> candidates);
ExtendedFlow stack(std::vector<ExtendedFlow> candidates);

}  // namespace info
