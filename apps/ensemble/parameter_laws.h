#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bio/parameters/parameters.h"
#include "ensemble/ensemble_draws.h"
#include "info/probability/gaussian_copula.h"
#include "sensitivity/named_covariance.h"

namespace app {

/// The distributions of the parameters, as given on the command line.
struct LawRequest {
  std::vector<std::string> names;  ///< --parameters; empty: those of the covariance, else all
  std::vector<std::string> priors, bounds;
  std::string distribution = "normal";
  double spread = 1;
  std::string covarianceFile;  ///< empty: independent parameters
};

/// The drawn parameters, their distributions and their correlation.
struct DrawnLaws {
  std::vector<std::size_t> selection;  ///< places in the catalogue
  std::vector<DrawnParameter> parameters;
  std::optional<info::GaussianCopula> together;
};

/// Distributions of the selected parameters: those of the catalogue unless the request gives
/// others. A covariance gives the standard deviations and correlations of the parameters that it
/// names; means and bounds stay.
/// @throws std::invalid_argument for a name that is not drawn or an invalid distribution, and what
///   readCovariance and GaussianCopula throw, with the file's name
DrawnLaws drawnLaws(const bio::ParameterCatalogue& catalogue, const LawRequest& request);

}  // namespace app
