#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "info/information/parameter.h"

namespace info {

/// Scale on which changes of parameters are compared and described.
enum class ParameterScale {
  linear,  ///< in units of the prior standard deviation, else of |start|, else of 1; sums: "a −
           ///< 2·b"
  logarithmic  ///< in fractions of |start| (must not be 0); products: "m1·L1"
};

/// A direction in which the parameters can change without an effect on the outputs.
struct UndeterminedDirection {
  Eigen::VectorXd direction;            ///< change of θ, in the parameters' units
  std::vector<std::string> parameters;  ///< the parameters involved
  std::string words;  ///< e.g. "m1 +1 %, m2 +1 %": changes that leave all outputs unchanged
};

struct IdentifiabilityReport {
  Eigen::Index rank;             ///< number of determined combinations
  Eigen::VectorXd eigenvalues;   ///< of the scaled information, rising
  Eigen::MatrixXd eigenvectors;  ///< columns, of the scaled information
  std::vector<UndeterminedDirection> undetermined;
  std::vector<std::string>
      determined;  ///< determined combinations of undetermined parameters: "m1/m2"
  std::vector<std::string>
      sentences;                ///< the result, one line per group of parameters; never empty
  Eigen::VectorXd sd;           ///< Cramér–Rao standard deviations; +∞ where undetermined
  Eigen::MatrixXd correlation;  ///< of estimates at the bound; NaN where undetermined
};

/// Identifiability of parameters and of their combinations from an information matrix.
///
/// With S = diag(scale), a direction n counts as undetermined if nᵀ(SIS)n ≤ tolerance·λ_max(SIS).
/// Sparse vectors that span these directions are computed (Gauss–Jordan); parameters in the same
/// vector form a group, and the combinations orthogonal to the group's directions are determined.
/// The result is local: it holds near the values at which I was evaluated.
///
/// @param information I or I plus prior information, p × p
/// @param parameters their names, units, start values and priors
/// @throws std::invalid_argument if sizes differ, I is not symmetric but for rounding, or a start
///         is 0 on the logarithmic scale; std::domain_error if I is not finite
IdentifiabilityReport identifiability(const Eigen::MatrixXd& information,
                                      const std::vector<Parameter>& parameters,
                                      ParameterScale scale = ParameterScale::logarithmic,
                                      double tolerance = 1e-12);

}  // namespace info
