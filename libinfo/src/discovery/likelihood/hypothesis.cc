#include "info/discovery/likelihood/hypothesis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace info::discover {

double FreeQuantity::value(double xi) const {
  return logarithmic ? nominal * std::exp(sd * xi) : nominal + sd * xi;
}
double FreeQuantity::slope(double xi) const {
  return logarithmic ? sd * value(xi) : sd;
}
double FreeQuantity::coordinate(double value) const {
  return (logarithmic ? std::log(value / nominal) : value - nominal) / sd;
}

namespace {

FreeQuantity freeQuantity(const Quantity& q, std::size_t index, double sd) {
  if (!(q.lower <= q.nominal && q.nominal <= q.upper))
    throw std::invalid_argument(fmt::format("{}: {} must lie within its bounds {} to {}", q.name,
                                            q.nominal, q.lower, q.upper));
  if (!(sd > 0) || !std::isfinite(sd))
    throw std::invalid_argument(
        fmt::format("{}: prior standard deviation is {}, must be > 0", q.name, sd));
  if (q.logarithmic && !(q.nominal > 0 && q.lower > 0))
    throw std::invalid_argument(
        fmt::format("{}: nominal value {} and lower bound {} of a logarithmic quantity must be > 0",
                    q.name, q.nominal, q.lower));
  if (!(q.nominalShare >= 0 && q.nominalShare < 1))
    throw std::invalid_argument(
        fmt::format("{}: prior probability of its nominal value is {}, must be at least 0 and < 1",
                    q.name, q.nominalShare));
  FreeQuantity free{index, q.nominal, sd, q.logarithmic, 0, 0, q.nominalShare};
  free.lowest = free.coordinate(q.lower);
  free.highest = free.coordinate(q.upper);
  return free;
}

bool belongs(const Quantity& q, const std::vector<int>& trials) {
  return q.trial < 0 || std::find(trials.begin(), trials.end(), q.trial) != trials.end();
}

}  // namespace

int Hypothesis::indexOf(std::size_t quantity) const {
  for (std::size_t i = 0; i < free.size(); ++i)
    if (free[i].quantity == quantity) return static_cast<int>(i);
  return -1;
}

Hypothesis makeHypothesis(const DiscoveryProblem& data, const std::vector<std::size_t>& effects,
                          const std::vector<int>& trials) {
  const auto& quantities = data.quantities();
  Hypothesis hypothesis;
  hypothesis.effects = effects;
  for (const std::size_t index : data.nuisances()) {
    const Quantity& q = quantities.at(index);
    if (belongs(q, trials)) hypothesis.free.push_back(freeQuantity(q, index, q.sd));
  }
  for (const std::size_t effect : effects) {
    const Candidate& candidate = data.candidates().at(effect);
    if (candidate.quantities.empty() || candidate.sds.size() != candidate.quantities.size())
      throw std::invalid_argument(fmt::format(
          "{}: must have quantities, and a prior standard deviation for each", candidate.id));
    for (std::size_t i = 0; i < candidate.quantities.size(); ++i) {
      const std::size_t index = candidate.quantities[i];
      const FreeQuantity free = freeQuantity(quantities.at(index), index, candidate.sds[i]);
      const int there = hypothesis.indexOf(index);
      if (there < 0)
        hypothesis.free.push_back(free);
      else if (hypothesis.free[static_cast<std::size_t>(there)].sd < free.sd)
        hypothesis.free[static_cast<std::size_t>(there)] = free;
    }
  }
  return hypothesis;
}

Hypothesis startsOnly(const DiscoveryProblem& data, const std::vector<int>& trials) {
  Hypothesis hypothesis;
  for (const std::size_t index : data.nuisances()) {
    const Quantity& q = data.quantities().at(index);
    if (q.trial >= 0 && belongs(q, trials)) hypothesis.free.push_back(freeQuantity(q, index, q.sd));
  }
  return hypothesis;
}

Eigen::VectorXd nominalValues(const DiscoveryProblem& data) {
  const auto& quantities = data.quantities();
  Eigen::VectorXd values(static_cast<Eigen::Index>(quantities.size()));
  for (std::size_t i = 0; i < quantities.size(); ++i)
    values[static_cast<Eigen::Index>(i)] = quantities[i].nominal;
  return values;
}

std::string describe(const DiscoveryProblem& data, const std::vector<std::size_t>& effects) {
  if (effects.empty()) return "base";
  std::string text;
  for (const std::size_t e : effects)
    text += (text.empty() ? "" : " + ") + data.candidates().at(e).id;
  return text;
}

}  // namespace info::discover
