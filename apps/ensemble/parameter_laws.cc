#include "ensemble/parameter_laws.h"

#include "options/named_pairs.h"
#include "sensitivity/named_covariance.h"

namespace app {

bio::LawRequest lawRequest(const TypedLaws& typed) {
  bio::LawRequest request{.names = typed.names, .spread = typed.spread, .optionPrefix = "--"};
  if (typed.distribution != "normal") request.shape = info::Marginal::Shape::even;
  for (const NamedPair& pair : parsePairs(typed.priors, "--prior")) {
    request.priors[pair.name] = {pair.first, pair.second};
  }
  for (const NamedPair& pair : parsePairs(typed.bounds, "--bounds")) {
    request.bounds[pair.name] = {pair.first, pair.second};
  }
  if (typed.covarianceFile.empty()) return request;
  request.covariance = readCovariance(typed.covarianceFile);
  request.covarianceFile = typed.covarianceFile;
  return request;
}

}  // namespace app
