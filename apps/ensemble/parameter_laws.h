#pragma once

#include <string>
#include <vector>

#include "bio/analysis/parameter_laws.h"

namespace app {

/// The distributions of the parameters, as given on the command line.
struct TypedLaws {
  std::vector<std::string> names, priors, bounds;
  std::string distribution = "normal";
  double spread = 1;
  std::string covarianceFile;  ///< empty: independent parameters
};

/// @throws what parsePairs and readCovariance throw
bio::LawRequest lawRequest(const TypedLaws& typed);

}  // namespace app
