#pragma once

#include <Eigen/Dense>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bio/parameters/parameters.h"
#include "info/probability/gaussian_copula.h"
#include "info/probability/marginal.h"

/// Distributions from which an ensemble draws parameters.
namespace bio {

/// A covariance of named parameters.
struct NamedCovariance {
  std::vector<std::string> names;
  Eigen::MatrixXd values;  ///< symmetric, > 0 on the diagonal [product of the two units]

  Eigen::MatrixXd correlation() const;
};

/// Checks everything about a covariance but that it is positive definite.
/// @throws std::invalid_argument for sizes that differ, a name given twice, a value that is not
///   finite, a variance that is not > 0, or an asymmetry of more than 1e-6 of the product of the
///   standard deviations
void requireCovariance(const NamedCovariance& covariance);

/// A drawn parameter and its distribution.
struct DrawnParameter {
  std::string name, unit;
  double value;  ///< in the model [unit]
  info::Marginal law;
};

/// Which parameters are drawn, and from which distributions.
struct LawRequest {
  std::vector<std::string> names = {};  ///< empty: those of the covariance, else all
  info::Marginal::Shape shape = info::Marginal::Shape::normal;
  double spread = 1;  ///< factor of every standard deviation > 0
  /// Mean and standard deviation, and bounds, instead of the catalogue's, by name [unit].
  std::map<std::string, std::pair<double, double>> priors = {}, bounds = {};
  std::optional<NamedCovariance> covariance = {};  ///< none: independent parameters
  std::string covarianceFile = "covariance";       ///< what messages call it
  std::string optionPrefix = {};  ///< before names of options in messages, e.g. "--"
};

/// The drawn parameters, their distributions and their correlation.
struct ParameterLaws {
  std::vector<std::size_t> selection;  ///< places in the catalogue
  std::vector<DrawnParameter> parameters;
  std::optional<info::GaussianCopula> together;  ///< none: independent

  /// The parameters at a point u of the unit cube: x_i = F_i⁻¹(u_i), with u correlated before by
  /// the Gaussian copula if there is one. u uniform gives samples of the distributions.
  Eigen::VectorXd at(Eigen::VectorXd unit) const;
};

/// Distributions of the selected parameters: those of the catalogue (mean: the model's value)
/// unless the request gives others. A covariance gives the standard deviations and correlations of
/// the parameters that it names; means and bounds stay.
/// @throws std::invalid_argument for a name that is not drawn or given twice, an invalid
///   distribution, a covariance together with even distributions, and what requireCovariance and
///   GaussianCopula throw, with the covariance's name
ParameterLaws parameterLaws(const ParameterCatalogue& catalogue, const LawRequest& request);

}  // namespace bio
