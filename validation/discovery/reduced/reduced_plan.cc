#include "reduced/reduced_plan.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "info/probability/random_stream.h"

namespace reduced {
namespace {

using Ids = std::vector<std::string>;
using Json = nlohmann::ordered_json;

const Ids catalogued = {"visc",    "coulomb", "stribeck", "drag",    "stiffness",
                        "limit",   "payload", "tilt",     "const",   "handforce",
                        "fatigue", "delay",   "shape",    "tri<bic", "bic<tri",
                        "wrapBIC", "wrapTRI", "bias",     "gain",    "clock"};
const Ids parameters = {"tau",     "FmaxBIC", "FmaxBRA", "FmaxBRD", "FmaxTRI",
                        "loptBIC", "loptBRA", "loptBRD", "loptTRI", "mass"};
const Ids outside = {"cubic", "powerdamp", "qdamp", "tremor", "hysteresis", "flwidth"};
const Ids twins = {"tilt", "handforce", "delay", "clock", "payload"};

bool contains(const Ids& ids, const std::string& id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

const Ids& idsOf(const std::string& suite) {
  if (suite == "single" || suite == "two") return catalogued;
  if (suite == "parameter") return parameters;
  if (suite == "out") return outside;
  if (suite == "equivalents") return twins;
  throw std::invalid_argument("suite '" + suite +
                              "', must be null, single, parameter, two, equivalents or out");
}

// Of a parameter the factor e^{5σ}.
double amplitudeOf(const std::string& id, double size) {
  static const double tolerance[] = {0.2, 0.15, 0.15, 0.15, 0.15, 0.04, 0.04, 0.04, 0.04, 0.05};
  const auto at = std::find(parameters.begin(), parameters.end(), id);
  if (at == parameters.end()) return size * fullSize(id);
  return std::exp(size * 5 * tolerance[at - parameters.begin()]);
}

// Effects that the same data can never tell apart, as the design declares them.
Ids equivalentsOf(const std::string& id) {
  static const std::vector<std::pair<std::string, std::string>> pairs = {
      {"payload", "mass"}, {"tilt", "handforce"}, {"delay", "clock"}};
  for (const auto& [a, b] : pairs) {
    if (id == a) return {b};
    if (id == b) return {a};
  }
  return {};
}

Json labelOf(const Plan& plan, const Recipe& recipe) {
  Json effects = Json::array();
  for (const auto& [id, amplitude] : recipe.effects) {
    Json readings = Json::array();
    if (!contains(parameters, id)) readings.push_back({{"name", id}, {"value", amplitude}});
    effects.push_back({{"id", id}, {"readings", readings}, {"equivalents", equivalentsOf(id)}});
  }
  return {{"seed", plan.seed},
          {"suite", plan.suite},
          {"size", plan.size},
          {"emg_noise", plan.emgNoise},
          {"effects", effects}};
}

}  // namespace

std::vector<std::string> DataSet::hidden() const {
  Ids ids;
  for (const auto& one : recipe.effects) ids.push_back(one.first);
  return ids;
}

std::vector<std::string> DataSet::explaining() const {
  std::vector<std::string> ids = hidden();
  for (const std::string& id : hidden()) {
    for (const std::string& equal : equivalentsOf(id)) ids.push_back(equal);
    if (id == "coulomb") ids.push_back("stribeck");  // which is dry friction and more
  }
  return ids;
}

DataSet makeDataSet(const Plan& plan) {
  info::RandomStream pick(plan.seed, 99);
  const auto choose = [&](const Ids& from) {
    return from[static_cast<std::size_t>(pick.uniform() * static_cast<double>(from.size()))];
  };
  Ids ids;
  if (plan.suite != "null") {
    const Ids& from = idsOf(plan.suite);
    const std::string drawn = choose(from);
    ids.push_back(plan.effect.empty() ? drawn : plan.effect);
    if (!contains(from, ids[0]))
      throw std::invalid_argument("'" + ids[0] + "' is not of suite '" + plan.suite + "'");
    while (plan.suite == "two" && ids.size() < 2) {
      const std::string second = choose(from);
      if (second != ids[0]) ids.push_back(second);
    }
  }
  DataSet set;
  set.recipe.trials = plan.trials;
  set.recipe.seconds = plan.seconds;
  set.recipe.emgNoise = plan.emgNoise;
  static const std::set<std::string> eitherSign = {"tilt",    "const",   "handforce", "shape",
                                                   "wrapBIC", "wrapTRI", "bias",      "gain"};
  for (const std::string& id : ids) {
    const bool sign = pick.uniform() < 0.5;
    double amplitude = amplitudeOf(id, plan.size);
    if (sign && contains(parameters, id)) amplitude = 1 / amplitude;
    if (sign && eitherSign.count(id) > 0) amplitude = -amplitude;
    set.recipe.effects.emplace_back(id, amplitude);
  }
  set.trials = record(set.recipe, plan.seed);
  set.label = labelOf(plan, set.recipe);
  return set;
}

}  // namespace reduced
