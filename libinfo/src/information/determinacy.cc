#include "info/information/determinacy.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "info/information/symmetric_eigen.h"

namespace info {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double infinity = std::numeric_limits<double>::infinity();

std::string quantity(double value, const Parameter& parameter) {
  return fmt::format("{:.3g}{}", value, parameter.unit.empty() ? "" : " " + parameter.unit);
}

/// "BRA.gain +0.2, BRD.gain −0.19": the direction, so long that parameter i moves by its known
/// deviation; parameter i first.
std::string moves(const VectorXd& v, Index i, const std::vector<Parameter>& parameters,
                  const VectorXd& priorSds) {
  const double least = 0.25 * v.cwiseAbs().maxCoeff();
  std::string text;
  const auto add = [&](Index k) {
    const double by = v[k] / v[i] * priorSds[k];
    const Parameter& parameter = parameters[static_cast<std::size_t>(k)];
    text += fmt::format("{}{} by {}{}", text.empty() ? "" : ", ", parameter.name,
                        by < 0 ? "−" : "+", quantity(std::abs(by), parameter));
  };
  add(i);
  for (Index k = 0; k < v.size(); ++k) {
    if (k != i && std::abs(v[k]) >= least) add(k);
  }
  return text;
}

/// "a, b and c": those that take part in the direction beside parameter i; empty if none does.
std::string partners(const VectorXd& v, Index i, const std::vector<Parameter>& parameters) {
  const double least = 0.25 * v.cwiseAbs().maxCoeff();
  std::vector<std::string> names;
  for (Index k = 0; k < v.size(); ++k) {
    if (k != i && std::abs(v[k]) >= least) {
      names.push_back(parameters[static_cast<std::size_t>(k)].name);
    }
  }
  std::string text;
  for (std::size_t k = 0; k < names.size(); ++k) {
    text += (k == 0 ? "" : k + 1 == names.size() ? " and " : ", ") + names[k];
  }
  return text;
}

}  // namespace

std::vector<Determinacy> determinacy(const MatrixXd& information,
                                     const std::vector<Parameter>& parameters,
                                     const VectorXd& priorSds, const std::string& outcome) {
  const auto p = static_cast<Index>(parameters.size());
  if (p == 0 || information.rows() != p || information.cols() != p || priorSds.size() != p) {
    throw std::invalid_argument(fmt::format(
        "determinacy: information is {} × {} with {} prior standard deviations, for {} parameters",
        information.rows(), information.cols(), priorSds.size(), p));
  }
  for (Index i = 0; i < p; ++i) {
    if (!(priorSds[i] > 0 && std::isfinite(priorSds[i]))) {
      throw std::invalid_argument(
          fmt::format("parameter {}: prior standard deviation {} must be > 0 and finite",
                      label(parameters[static_cast<std::size_t>(i)]), priorSds[i]));
    }
  }
  if (!information.allFinite()) {
    throw std::domain_error("determinacy: every entry of the information must be finite");
  }

  const auto eigen = symmetricEigen(priorSds.asDiagonal() * information * priorSds.asDiagonal());
  const MatrixXd& v = eigen.vectors;
  // eigenvalues below rounding carry no information
  const double floor = 1e-14 * std::max(0.0, eigen.values[p - 1]);
  std::vector<Determinacy> result;
  for (Index i = 0; i < p; ++i) {
    const Parameter& parameter = parameters[static_cast<std::size_t>(i)];
    double variance = 0, largest = -1;
    Index loosest = 0;
    for (Index j = 0; j < p; ++j) {
      const double lambda = eigen.values[j];
      const double share = v(i, j) * v(i, j);
      const double part = lambda > floor ? share / lambda : (share > 1e-12 ? infinity : 0.0);
      variance += part;
      if (part > largest) {
        largest = part;
        loosest = j;
      }
    }
    Determinacy determinacy{1 / std::sqrt(information(i, i)), std::sqrt(variance) * priorSds[i],
                            false, ""};
    if (!(information(i, i) > 0)) determinacy.boundAlone = determinacy.bound = infinity;
    const double enough = priorSds[i] / std::sqrt(3.0);
    determinacy.identifiable = determinacy.bound <= enough;
    const std::string others = partners(v.col(loosest), i, parameters);
    if (determinacy.identifiable) {
      // nothing to explain
    } else if (std::isinf(determinacy.boundAlone)) {
      determinacy.why = fmt::format("{} has no effect on {}", parameter.name, outcome);
    } else if (determinacy.boundAlone > enough || others.empty()) {
      determinacy.why = fmt::format(
          "{} has too little effect on {}: even with all other parameters known, the data alone "
          "would determine it to ±{} only, and its prior is ±{}",
          parameter.name, outcome, quantity(determinacy.boundAlone, parameter),
          quantity(priorSds[i], parameter));
    } else {
      const double lambda = std::max(0.0, eigen.values[loosest]);
      determinacy.why = fmt::format(
          "{} is confounded with {}: {} together change {} by {:.2g} standard deviations in all; "
          "with the others known it would be determined to ±{}",
          parameter.name, others, moves(v.col(loosest), i, parameters, priorSds), outcome,
          std::sqrt(lambda) / std::abs(v(i, loosest)), quantity(determinacy.boundAlone, parameter));
    }
    result.push_back(std::move(determinacy));
  }
  return result;
}

}  // namespace info
