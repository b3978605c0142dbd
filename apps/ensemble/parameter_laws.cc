#include "ensemble/parameter_laws.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "options/named_pairs.h"

namespace app {
namespace {

using Places = std::vector<std::size_t>;

std::invalid_argument wrongIn(const LawRequest& request, const std::string& what) {
  return std::invalid_argument(fmt::format("{}: {}", request.covarianceFile, what));
}

/// Places in the catalogue of the parameters that a covariance names.
Places placesIn(const bio::ParameterCatalogue& catalogue, const NamedCovariance& covariance,
                const LawRequest& request) {
  Places places;
  for (const std::string& name : covariance.names) {
    try {
      places.push_back(catalogue.find(name));
    } catch (const std::invalid_argument& error) {
      throw wrongIn(request, error.what());
    }
    if (std::find(places.begin(), places.end() - 1, places.back()) != places.end() - 1) {
      throw wrongIn(request, fmt::format("{} is listed under another name as well", name));
    }
  }
  return places;
}

DrawnParameter known(const bio::ModelParameter& p, const std::string& distribution) {
  const auto shape =
      distribution == "normal" ? info::Marginal::Shape::normal : info::Marginal::Shape::even;
  return {p.name, p.unit, p.value, {shape, p.value, p.sd, p.lower, p.upper}};
}

/// Deviations of the laws, and the correlation of all that is drawn.
void follow(const NamedCovariance& covariance, const Places& places, const LawRequest& request,
            DrawnLaws& laws) {
  const auto n = static_cast<Eigen::Index>(laws.selection.size());
  Eigen::MatrixXd correlation = Eigen::MatrixXd::Identity(n, n);
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto at = std::find(laws.selection.begin(), laws.selection.end(), places[i]);
    if (at == laws.selection.end()) {
      throw wrongIn(request, fmt::format("{} is not one of the --parameters", covariance.names[i]));
    }
    rows.push_back(at - laws.selection.begin());
    const auto k = static_cast<Eigen::Index>(i);
    laws.parameters[static_cast<std::size_t>(rows.back())].law.sd =
        std::sqrt(covariance.values(k, k));
  }
  correlation(rows, rows) = covariance.correlation();
  try {
    laws.together.emplace(correlation);
  } catch (const std::invalid_argument& error) {
    throw wrongIn(request, error.what());
  }
}

}  // namespace

DrawnLaws drawnLaws(const bio::ParameterCatalogue& catalogue, const LawRequest& request) {
  std::optional<NamedCovariance> covariance;
  Places correlated;
  if (!request.covarianceFile.empty()) {
    covariance = readCovariance(request.covarianceFile);
    correlated = placesIn(catalogue, *covariance, request);
  }
  DrawnLaws laws;
  if (request.names.empty() && covariance) {
    laws.selection = correlated;
  } else {
    laws.selection =
        catalogue.select(request.names.empty() ? std::vector<std::string>{"all"} : request.names);
  }
  for (const std::size_t place : laws.selection) {
    laws.parameters.push_back(known(catalogue.parameters()[place], request.distribution));
  }
  if (covariance) follow(*covariance, correlated, request, laws);
  const auto drawn = [&](const NamedPair& pair, const char* option) -> DrawnParameter& {
    const std::size_t place = catalogue.find(pair.name);
    const auto at = std::find(laws.selection.begin(), laws.selection.end(), place);
    if (at == laws.selection.end()) {
      throw std::invalid_argument(
          fmt::format("{}: {} is not one of the --parameters", option, pair.name));
    }
    return laws.parameters[static_cast<std::size_t>(at - laws.selection.begin())];
  };
  for (const NamedPair& prior : parsePairs(request.priors, "--prior")) {
    DrawnParameter& one = drawn(prior, "--prior");
    const std::size_t place = catalogue.find(prior.name);
    if (std::find(correlated.begin(), correlated.end(), place) != correlated.end()) {
      throw std::invalid_argument(
          fmt::format("--prior: {} already has its distribution from --covariance", prior.name));
    }
    one.law.mean = prior.first;
    one.law.sd = prior.second;
  }
  for (const NamedPair& bounds : parsePairs(request.bounds, "--bounds")) {
    DrawnParameter& one = drawn(bounds, "--bounds");
    one.law.lower = bounds.first;
    one.law.upper = bounds.second;
    catalogue.requireBelowLimit(catalogue.find(bounds.name), bounds.second, "--bounds: ");
  }
  for (DrawnParameter& one : laws.parameters) {
    one.law.sd *= request.spread;
    try {
      (void)one.law.quantile(0.5);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(
          fmt::format("{} [{}]: {}", one.name, one.unit.empty() ? "1" : one.unit, error.what()));
    }
  }
  return laws;
}

}  // namespace app
