#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "info/estimation/parameter.h"

namespace info {

/// What data tell about one parameter.
struct Determinacy {
  double boundAlone;  ///< Cramér–Rao deviation with all others known: 1/√I_ii; +∞ without effect
  double bound;       ///< with the others unknown: √(I⁻¹)_ii; +∞ where undetermined
  bool identifiable;  ///< bound ≤ known/√3: together with what was known at least halves it
  std::string why;    ///< one sentence where not identifiable, else empty
};

/// Which parameters the data determine well beyond what was known beforehand, and why the others
/// are not.
///
/// With S = diag(known), a unit of S·I·S is one standard deviation of prior knowledge. A parameter
/// whose bound from the data alone exceeds known/√3 is not identifiable: an estimate of it would
/// repeat the prior, or follow the noise along a valley of the cost. The sentence says whether it
/// hardly moves what is measured, or names those it is confounded with (components of the least
/// informed direction that it takes part in, at least a quarter of the largest). Where
/// identifiability.h finds exact relations, this compares against what is worth knowing.
///
/// @param information of the data (without the priors of `parameters`), p × p
/// @param known       standard deviation of what was known beforehand, > 0, in the parameters'
///   units
/// @param outcome     what the outputs are called in the sentence
/// @throws std::invalid_argument if sizes differ or a known deviation is not > 0;
///   std::domain_error if I is not finite
std::vector<Determinacy> determinacy(const Eigen::MatrixXd& information,
                                     const std::vector<Parameter>& parameters,
                                     const Eigen::VectorXd& known,
                                     const std::string& outcome = "what was measured");

}  // namespace info
