#include "score/outcome.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <stdexcept>

namespace hidden {
namespace {

// What one of a unit is in SI; 1 for units that are SI or unknown.
double inSi(const std::string& unit) {
  constexpr double degree = 0.017453292519943295;
  if (unit == "mm") return 1e-3;
  if (unit == "ms") return 1e-3;
  if (unit == "deg" || unit == "°") return degree;
  if (unit == "%") return 0.01;
  if (unit == "N m/deg" || unit == "N·m/deg") return 1 / degree;
  return 1;
}

bool has(const std::vector<std::string>& list, const std::string& item) {
  return std::find(list.begin(), list.end(), item) != list.end();
}

std::vector<std::string> accepted(const Json& effect) {
  auto names = effect.value("equivalents", std::vector<std::string>{});
  names.insert(names.begin(), effect.at("id").get<std::string>());
  return names;
}

std::optional<double> finite(const Json& object, const char* key) {
  const auto at = object.find(key);
  if (at == object.end() || !at->is_number()) return {};
  return at->get<double>();
}

// "factor" of "Fmax_TRI factor", "torque" of "coulomb.torque".
std::string lastWord(const std::string& name) {
  return name.substr(name.find_last_of(". ") + 1);
}

// What an estimate says of a quantity, in SI units, beside what it truly is.
struct Compared {
  std::string reading;  // the label's name of the quantity
  double estimate, sd, truth;
  double z() const { return (estimate - truth) / sd; }
};

// The parameter whose name, or its last word, the label knows; else the first one beside the first
// reading. Nothing where the label tells no size.
std::optional<Compared> compared(const Json& estimate, const Json& truth) {
  const Json parameters = estimate.value("parameters", Json::object());
  if (parameters.empty()) return {};
  const Json& readings = truth.at("readings");
  if (readings.empty()) return {};
  const Json* parameter = &*parameters.begin();
  const Json* wanted = &readings.front();
  bool known = false;
  for (const Json& reading : readings) {
    for (const auto& item : parameters.items()) {
      const std::string name = reading.at("name");
      if (known || (item.key() != name && lastWord(item.key()) != name)) continue;
      parameter = &item.value();
      wanted = &reading;
      known = true;
    }
  }
  const auto value = finite(*parameter, "value"), sd = finite(*parameter, "sd");
  if (!value || !sd || !(*sd > 0)) return {};
  const double unit = inSi(parameter->value("unit", ""));
  return Compared{wanted->at("name"), *value * unit, *sd * unit, wanted->at("value").get<double>()};
}

// What absence is of a quantity with this name.
double absenceOf(const std::string& name) {
  return lastWord(name) == "factor" ? 1 : 0;
}

// The change of a quantity that the label tells as a share of its nominal value but reads as a
// value (a robot's: × (1 + a), com_1 = 0.112 m), in that value's unit.
std::optional<double> changeOf(const Json& truth) {
  const auto share = finite(truth, "amplitude");
  const Json& readings = truth.at("readings");
  if (!share || !(*share > -1) || truth.value("unit", "") != "change" || readings.empty() ||
      readings.front().at("name") != truth.at("id"))
    return {};
  return readings.front().at("value").get<double>() * *share / (1 + *share);
}

// Amplitude over the least one that would have shown, five deviations: of the effect where it (or
// else a declared equivalent, by its own amplitude) is named, else by `undetectable_below`.
std::optional<double> visibility(const Json& verdict, const Json& truth) {
  constexpr double needed = 5;
  const auto change = changeOf(truth);
  const Json effects = verdict.value("effects", Json::array());
  for (const std::string& id : accepted(truth)) {
    for (const Json& effect : effects) {
      if (effect.at("id") != id) continue;
      if (id == truth.at("id")) {
        if (const auto own = compared(effect, truth))
          return std::abs(change.value_or(own->truth - absenceOf(own->reading))) / own->sd / needed;
        continue;
      }
      const Json parameters = effect.value("parameters", Json::object());
      if (parameters.empty()) continue;
      const auto first = parameters.begin();
      const auto value = finite(first.value(), "value"), sd = finite(first.value(), "sd");
      if (value && sd && *sd > 0) return std::abs(*value - absenceOf(first.key())) / *sd / needed;
    }
  }
  const auto known = verdict.find("undetectable_below");
  const auto amplitude = change ? change : finite(truth, "amplitude");
  if (known == verdict.end() || !amplitude) return {};
  const auto least = finite(*known, truth.at("id").get<std::string>().c_str());
  if (!least || !(*least > 0)) return {};
  return std::abs(*amplitude) / *least;
}

Json readJson(const std::filesystem::path& file) {
  std::ifstream stream(file);
  try {
    return Json::parse(stream);
  } catch (const std::exception& e) {
    throw std::runtime_error(fmt::format("{}: {}", file.string(), e.what()));
  }
}

}  // namespace

Outcome judge(const std::string& name, const Json& label, const Json& verdict) {
  Outcome o;
  o.name = name;
  o.suite = label.at("suite");
  o.hides = label.value("hides", o.suite);
  o.violation = label.value("violation", Json::object()).value("id", "");
  o.size = label.value("size", 1.0);
  o.emgNoise = label.value("emg_noise", 0.0);
  const Json& hiding = label.at("effects");
  for (const Json& effect : hiding) o.truth.push_back(effect.at("id"));
  if (verdict.is_null()) return o;

  o.hasVerdict = true;
  o.verdict = verdict.at("verdict");
  static const std::set<std::string> quiet = {"none", "numerical"};
  o.claims = quiet.count(o.verdict) == 0;
  const Json effects = verdict.value("effects", Json::array());
  if (o.claims) {
    for (const Json& effect : effects) o.named.push_back(effect.at("id"));
    o.inClass = verdict.value("class", std::vector<std::string>{});
  }
  std::vector<std::string> all = o.named;
  all.insert(all.end(), o.inClass.begin(), o.inClass.end());
  o.allNamed = o.claims && !o.truth.empty();
  for (const Json& truth : hiding) {
    const auto names = accepted(truth);
    const auto given = [&](const std::string& id) { return has(names, id); };
    o.firstIsRight =
        o.firstIsRight || (o.verdict != "unknown" && !o.named.empty() && given(o.named[0]));
    if (const auto seen = visibility(verdict, truth)) {
      o.visibility = std::min(o.visibility.value_or(*seen), *seen);
      o.detectable = o.detectable && *seen >= 1;
    }
    o.classHasTruth = o.classHasTruth || std::any_of(all.begin(), all.end(), given);
    o.allNamed = o.allNamed && std::any_of(o.named.begin(), o.named.end(), given);
  }
  if (!o.named.empty()) {
    o.namesStructure = !o.firstIsRight && effects[0].value("kind", "") != "parameter";
    o.confident = finite(effects[0], "probability").value_or(0) >= 0.95;
  }
  const std::set<std::string> candidates(o.inClass.begin(), o.inClass.end());
  for (const Json& truth : hiding) {
    const std::string id = truth.at("id");
    const auto mates = truth.value("equivalents", std::vector<std::string>{});
    o.asClass = o.asClass || (candidates.count(id) > 0 &&
                              std::any_of(mates.begin(), mates.end(), [&](const auto& mate) {
                                return candidates.count(mate) > 0;
                              }));
    o.uniquelyRight = o.verdict == "named" && hiding.size() == 1 && o.named == std::vector{id} &&
                      (candidates.empty() || candidates == std::set{id});
    o.firstIsTrue = o.firstIsTrue || (!o.named.empty() && o.named[0] == id);
  }
  static const std::set<std::string> naming = {"named", "ambiguous", "parameter"};
  if (naming.count(o.verdict) > 0 && !o.named.empty())
    o.probability = finite(effects[0], "probability");
  o.unqualified = (o.verdict == "named" || o.verdict == "parameter") &&
                  candidates.size() <= std::max<std::size_t>(1, o.named.size()) &&
                  !verdict.value("probability_vetoed", false);
  for (const Json& truth : hiding) {
    for (const Json& effect : effects) {
      // an equivalent has its own amplitude, which the truth does not tell
      if (!o.claims || o.z || effect.at("id") != truth.at("id")) continue;
      if (const auto both = compared(effect, truth)) o.z = both->z();
    }
  }
  const auto gap = verdict.find("gap");
  if (gap != verdict.end() && gap->contains("held_out") && (*gap)["held_out"].is_object()) {
    const Json& heldOut = (*gap)["held_out"];
    o.gapClosed = finite(heldOut, "gap_closed");
    for (const std::string unit : {"_deg", "_N", "_Nm", "_sd"}) {
      const auto after = finite(heldOut, ("rmse_after" + unit).c_str());
      const auto floor = finite(heldOut, ("noise_floor" + unit).c_str());
      if (after && floor && *floor > 0) o.overFloor = *after / *floor;
      const auto expected = finite(heldOut, ("rmse_expected" + unit).c_str());
      if (expected && floor && *floor > 0) o.expectedOverFloor = *expected / *floor;
    }
  }
  o.seconds = finite(verdict, "processor_s");
  if (!o.seconds) o.seconds = finite(verdict, "wall_s");
  return o;
}

std::vector<Outcome> readOutcomes(const std::filesystem::path& labels,
                                  const std::filesystem::path& verdicts) {
  std::vector<std::filesystem::path> files;
  if (std::filesystem::is_directory(labels)) {
    for (const auto& entry : std::filesystem::directory_iterator(labels)) {
      if (entry.path().extension() == ".json") files.push_back(entry.path());
    }
  }
  if (files.empty()) throw std::runtime_error(labels.string() + ": holds no label");
  std::sort(files.begin(), files.end());
  std::vector<Outcome> outcomes;
  for (const auto& file : files) {
    const std::string name = file.stem().string();
    const auto folder = verdicts / name;
    auto given = folder / "verdict.json";
    if (!std::filesystem::exists(given)) given = verdicts / (name + ".json");
    Json verdict;
    if (std::filesystem::exists(given)) verdict = readJson(given);
    try {
      outcomes.push_back(judge(name, readJson(file), verdict));
    } catch (const nlohmann::json::exception& e) {
      throw std::runtime_error(fmt::format("{}, {}: {}", file.string(), given.string(), e.what()));
    }
    const auto summary = folder / "summary.json";
    if (!outcomes.back().seconds && std::filesystem::exists(summary)) {
      outcomes.back().seconds = finite(readJson(summary), "wall_s");
    }
  }
  return outcomes;
}

}  // namespace hidden
