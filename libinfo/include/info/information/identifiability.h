#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "info/estimation/parameter.h"

namespace info {

/// How changes of parameters are compared and put into words.
enum class ParameterScale {
  linear,  ///< in units of the prior's deviation, else of |start|, else of 1; sums: "a − 2·b"
  logarithmic  ///< in fractions of |start| (must not be 0); products: "m1·L1"
};

/// A direction in which the parameters can move without any effect on what is measured.
struct UndeterminedDirection {
  Eigen::VectorXd direction;            ///< change of θ, in the parameters' units
  std::vector<std::string> parameters;  ///< those that take part
  std::string words;  ///< e.g. "m1 +1 %, m2 +1 %": moves together that change no output
};

struct IdentifiabilityReport {
  Eigen::Index rank;             ///< number of combinations that are determined
  Eigen::VectorXd eigenvalues;   ///< of the scaled information, rising
  Eigen::MatrixXd eigenvectors;  ///< columns, of the scaled information
  std::vector<UndeterminedDirection> undetermined;
  std::vector<std::string>
      determined;  ///< combinations known among parameters that are not: "m1/m2"
  std::vector<std::string>
      sentences;                ///< the verdict, one line per group of parameters; never empty
  Eigen::VectorXd sd;           ///< Cramér–Rao standard deviations; +∞ where undetermined
  Eigen::MatrixXd correlation;  ///< of estimates at the bound; NaN where undetermined
};

/// What an information matrix says about which parameters can be told apart.
///
/// With S = diag(scale), a direction n counts as undetermined if nᵀ(SIS)n ≤ tolerance·λ_max(SIS).
/// Sparse vectors that span these directions are sought (Gauss–Jordan), parameters that share one
/// form a group, and the combinations orthogonal to the group's directions are those that are
/// determined. The statement is local: it holds near the values at which I was taken.
///
/// @param information I or I plus prior information, p × p
/// @param parameters their names, units, start values and priors
/// @throws std::invalid_argument if sizes differ, or a start is 0 on the logarithmic scale;
///         std::domain_error if I is not finite
IdentifiabilityReport identifiability(const Eigen::MatrixXd& information,
                                      const std::vector<Parameter>& parameters,
                                      ParameterScale scale = ParameterScale::logarithmic,
                                      double tolerance = 1e-12);

}  // namespace info
