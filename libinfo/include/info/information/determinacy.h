#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "info/information/parameter.h"

namespace info {

/// The information of data about one parameter.
struct Determinacy {
  double boundAlone;  ///< Cramér–Rao standard deviation if all others are known: 1/√I_ii; +∞
                      ///< without effect
  double bound;       ///< if the others are unknown: √(I⁻¹)_ii; +∞ if undetermined
  bool identifiable;  ///< bound ≤ known/√3: the posterior standard deviation is at most half the
                      ///< prior one
  std::string why;  ///< the reason in one sentence if not identifiable, else empty
};

/// Which parameters the data determine clearly better than their priors, and why they do not
/// determine the others.
///
/// With S = diag(known), S·I·S is the information in units of the prior standard deviations. A
/// parameter whose bound from the data alone exceeds known/√3 is not identifiable: its estimate
/// would reproduce the prior, or follow the noise along a flat direction of the cost. The sentence
/// says that the outputs hardly depend on it, or names the parameters that it is confounded with
/// (components of the least informed direction in which it takes part, at least a quarter of the
/// largest). identifiability.h finds exact relations; this function compares with the priors.
///
/// @param information of the data (without the priors of `parameters`), p × p
/// @param known prior standard deviations > 0, in the parameters' units
/// @param outcome name of the outputs in the sentence
/// @throws std::invalid_argument if sizes differ or a prior standard deviation is not > 0;
///   std::domain_error if I is not finite
std::vector<Determinacy> determinacy(const Eigen::MatrixXd& information,
                                     const std::vector<Parameter>& parameters,
                                     const Eigen::VectorXd& priorSds,
                                     const std::string& outcome = "what was measured");

}  // namespace info
