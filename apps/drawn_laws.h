#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bio/parameters.h"
#include "ensemble_draws.h"
#include "info/gaussian_copula.h"
#include "named_covariance.h"

namespace app {

/// What is said on the command line of the laws that parameters are drawn from.
struct LawRequest {
  std::vector<std::string> names;  ///< --parameters; none: those of the covariance, else all
  std::vector<std::string> priors, bounds;
  std::string distribution = "normal";
  double spread = 1;
  std::string covarianceFile;  ///< none: every parameter by itself
};

/// What is drawn, and how it hangs together.
struct DrawnLaws {
  std::vector<std::size_t> selection;  ///< places in the catalogue
  std::vector<DrawnParameter> parameters;
  std::optional<info::GaussianCopula> together;
};

/// Laws of the selected parameters: the catalogue's, unless the request says otherwise. A
/// covariance gives deviations and correlations of those it names; means and bounds stay.
/// @throws std::invalid_argument for a name that is not drawn, a law that is none, and what
///   readCovariance and GaussianCopula throw, with the file's name
DrawnLaws drawnLaws(const bio::ParameterCatalogue& catalogue, const LawRequest& request);

}  // namespace app
