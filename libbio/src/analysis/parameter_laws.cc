#include "bio/analysis/parameter_laws.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace bio {
namespace {

using CataloguePlaces = std::vector<std::size_t>;
using PairsByName = std::map<std::string, std::pair<double, double>>;

std::invalid_argument wrongInCovariance(const LawRequest& request, const std::string& what) {
  return std::invalid_argument(fmt::format("{}: {}", request.covarianceFile, what));
}

/// Places in the catalogue of the parameters that a covariance names.
CataloguePlaces placesOfCovariance(const ParameterCatalogue& catalogue, const LawRequest& request) {
  CataloguePlaces places;
  for (const std::string& name : request.covariance->names) {
    try {
      places.push_back(catalogue.find(name));
    } catch (const std::invalid_argument& error) {
      throw wrongInCovariance(request, error.what());
    }
    if (std::find(places.begin(), places.end() - 1, places.back()) != places.end() - 1) {
      throw wrongInCovariance(request,
                              fmt::format("{} is listed under another name as well", name));
    }
  }
  return places;
}

/// Standard deviations of the laws, and the correlation of all that is drawn.
void followCovariance(const CataloguePlaces& places, const LawRequest& request,
                      ParameterLaws& laws) {
  const NamedCovariance& covariance = *request.covariance;
  const auto n = static_cast<Eigen::Index>(laws.selection.size());
  Eigen::MatrixXd correlation = Eigen::MatrixXd::Identity(n, n);
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto at = std::find(laws.selection.begin(), laws.selection.end(), places[i]);
    if (at == laws.selection.end()) {
      throw wrongInCovariance(request, fmt::format("{} is not one of the {}parameters",
                                                   covariance.names[i], request.optionPrefix));
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
    throw wrongInCovariance(request, error.what());
  }
}

/// Pairs that an option gives to drawn parameters, by their place among these.
std::map<std::size_t, std::pair<double, double>> givenByPlace(const ParameterCatalogue& catalogue,
                                                              const PairsByName& pairs,
                                                              const std::string& option,
                                                              const LawRequest& request,
                                                              const ParameterLaws& laws) {
  std::map<std::size_t, std::pair<double, double>> given;
  for (const auto& [name, pair] : pairs) {
    const auto at = std::find(laws.selection.begin(), laws.selection.end(), catalogue.find(name));
    if (at == laws.selection.end()) {
      throw std::invalid_argument(
          fmt::format("{}: {} is not one of the {}parameters", option, name, request.optionPrefix));
    }
    if (!given.emplace(static_cast<std::size_t>(at - laws.selection.begin()), pair).second) {
      throw std::invalid_argument(
          fmt::format("{}: {} is given under another name as well", option, name));
    }
  }
  return given;
}

void setPriorsAndBounds(const ParameterCatalogue& catalogue, const CataloguePlaces& correlated,
                        const LawRequest& request, ParameterLaws& laws) {
  const std::string prior = request.optionPrefix + "prior";
  for (const auto& [i, pair] : givenByPlace(catalogue, request.priors, prior, request, laws)) {
    if (std::find(correlated.begin(), correlated.end(), laws.selection[i]) != correlated.end()) {
      throw std::invalid_argument(
          fmt::format("{}: {} already has its distribution from {}covariance", prior,
                      laws.parameters[i].name, request.optionPrefix));
    }
    laws.parameters[i].law.mean = pair.first;
    laws.parameters[i].law.sd = pair.second;
  }
  const std::string bounds = request.optionPrefix + "bounds";
  for (const auto& [i, pair] : givenByPlace(catalogue, request.bounds, bounds, request, laws)) {
    laws.parameters[i].law.lower = pair.first;
    laws.parameters[i].law.upper = pair.second;
    catalogue.requireBelowLimit(laws.selection[i], pair.second, bounds + ": ");
  }
}

void spreadAndCheck(const LawRequest& request, ParameterLaws& laws) {
  if (!(request.spread > 0) || !std::isfinite(request.spread)) {
    throw std::invalid_argument(
        fmt::format("{}spread = {}, must be > 0", request.optionPrefix, request.spread));
  }
  for (DrawnParameter& parameter : laws.parameters) {
    parameter.law.sd *= request.spread;
    try {
      (void)parameter.law.quantile(0.5);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("{} [{}]: {}", parameter.name,
                                              parameter.unit.empty() ? "1" : parameter.unit,
                                              error.what()));
    }
  }
}

}  // namespace

Eigen::MatrixXd NamedCovariance::correlation() const {
  const Eigen::VectorXd scale = values.diagonal().cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd r = scale.asDiagonal() * (values + values.transpose()) * scale.asDiagonal() / 2;
  r.diagonal().setOnes();
  return r;
}

void requireCovariance(const NamedCovariance& c) {
  const auto n = static_cast<Eigen::Index>(c.names.size());
  if (c.values.rows() != n || c.values.cols() != n) {
    throw std::invalid_argument(fmt::format("{} × {} values for {} names, must be as many",
                                            c.values.rows(), c.values.cols(), n));
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::string& name = c.names[static_cast<std::size_t>(i)];
    if (std::find(c.names.begin(), c.names.begin() + i, name) != c.names.begin() + i) {
      throw std::invalid_argument(fmt::format("{} is listed twice, must be listed once", name));
    }
    if (!c.values.row(i).allFinite()) {
      throw std::invalid_argument(
          fmt::format("the row of {} has a value that is not finite", name));
    }
    if (!(c.values(i, i) > 0)) {
      throw std::invalid_argument(
          fmt::format("the variance of {} is {}, must be > 0", name, c.values(i, i)));
    }
    for (Eigen::Index j = 0; j < i; ++j) {
      const double apart = std::abs(c.values(i, j) - c.values(j, i));
      if (apart <= 1e-6 * std::sqrt(c.values(i, i) * c.values(j, j))) continue;
      throw std::invalid_argument(
          fmt::format("the covariance of {} and {} is {} in one place and {} in the other, must be "
                      "symmetric",
                      name, c.names[static_cast<std::size_t>(j)], c.values(i, j), c.values(j, i)));
    }
  }
}

Eigen::VectorXd ParameterLaws::at(Eigen::VectorXd unit) const {
  if (together) unit = together->shares(unit);
  for (Eigen::Index i = 0; i < unit.size(); ++i) {
    unit[i] = parameters[static_cast<std::size_t>(i)].law.quantile(unit[i]);
  }
  return unit;
}

ParameterLaws parameterLaws(const ParameterCatalogue& catalogue, const LawRequest& request) {
  ParameterLaws laws;
  CataloguePlaces correlated;
  if (request.covariance) {
    if (request.shape == info::Marginal::Shape::even) {
      throw std::invalid_argument(fmt::format(
          "{0}covariance cannot be combined with {0}distribution uniform", request.optionPrefix));
    }
    try {
      requireCovariance(*request.covariance);
    } catch (const std::invalid_argument& error) {
      throw wrongInCovariance(request, error.what());
    }
    correlated = placesOfCovariance(catalogue, request);
  }
  if (request.names.empty() && request.covariance) {
    laws.selection = correlated;
  } else {
    laws.selection =
        catalogue.select(request.names.empty() ? std::vector<std::string>{"all"} : request.names);
  }
  for (const std::size_t place : laws.selection) {
    const ModelParameter& p = catalogue.parameters()[place];
    laws.parameters.push_back(
        {p.name, p.unit, p.value, {request.shape, p.value, p.sd, p.lower, p.upper}});
  }
  if (request.covariance) followCovariance(correlated, request, laws);
  setPriorsAndBounds(catalogue, correlated, request, laws);
  spreadAndCheck(request, laws);
  return laws;
}

}  // namespace bio
