#include "discovery_score.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <set>
#include <stdexcept>

#include "random_numbers.h"

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

// (estimate − truth)/sd: the parameter whose name, or its last word, the label knows; else the
// first one beside the first reading. Nothing where the label tells no size.
std::optional<double> deviation(const Json& estimate, const Json& truth) {
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
  return (*value * unit - wanted->at("value").get<double>()) / (*sd * unit);
}

// What absence is of a quantity with this name.
double absenceOf(const std::string& name) {
  return lastWord(name) == "factor" ? 1 : 0;
}

// Amplitude over the least one that would have shown, five deviations: of the effect where it (or
// else a declared equivalent, by its own amplitude) is named, else by `undetectable_below`.
std::optional<double> visibility(const Json& verdict, const Json& truth) {
  constexpr double needed = 5;
  const Json effects = verdict.value("effects", Json::array());
  for (const std::string& id : accepted(truth)) {
    for (const Json& effect : effects) {
      const Json parameters = effect.value("parameters", Json::object());
      if (effect.at("id") != id || parameters.empty()) continue;
      const auto& first = *parameters.items().begin();
      const auto value = finite(first.value(), "value"), sd = finite(first.value(), "sd");
      if (!value || !sd || !(*sd > 0)) continue;
      const double z = id == truth.at("id") ? deviation(effect, truth).value_or(0) : 0;
      return std::abs((*value - absenceOf(first.key())) / *sd - z) / needed;
    }
  }
  const auto known = verdict.find("undetectable_below");
  const auto amplitude = finite(truth, "amplitude");
  if (known == verdict.end() || !amplitude) return {};
  const auto least = finite(*known, truth.at("id").get<std::string>().c_str());
  if (!least || !(*least > 0)) return {};
  return std::abs(*amplitude) / *least;
}

std::string describe(const Outcome& o) {
  const std::string truth =
      o.truth.empty() ? "nothing" : fmt::format("{}", fmt::join(o.truth, "+"));
  const std::string given =
      !o.hasVerdict
          ? "no verdict"
          : fmt::format(
                "{} [{}]{}", o.verdict, fmt::join(o.named, ", "),
                o.inClass.empty() ? "" : fmt::format(", class [{}]", fmt::join(o.inClass, ", ")));
  return fmt::format("{} ({}, size {:g}, EMG noise {:g}): {}; said: {}", o.name, o.suite, o.size,
                     o.emgNoise, truth, given);
}

// A row whose k counts outcomes that `counts`; misses are those on the wrong side of the target.
template <class In, class Counts>
Row row(const std::vector<Outcome>& all, const std::string& metric, const std::string& target,
        double bound, bool atMost, In&& in, Counts&& counts) {
  Row r;
  r.metric = metric;
  r.target = target;
  r.bound = bound;
  r.atMost = atMost;
  for (const Outcome& o : all) {
    if (!in(o)) continue;
    const bool counted = counts(o);
    ++r.n;
    if (counted) ++r.k;
    if (counted == atMost) r.misses.push_back(describe(o));
  }
  const double share = r.n == 0 ? 0 : static_cast<double>(r.k) / r.n;
  r.met = r.n > 0 && (atMost ? share <= bound : share >= bound);
  return r;
}

template <class Value>
Spread spread(const std::vector<Outcome>& all, const std::string& metric, const std::string& unit,
              const std::string& target, double bound, bool atMost, Value&& value) {
  Spread s{metric, unit, target, {}, bound, atMost, false};
  for (const Outcome& o : all) {
    if (const std::optional<double> v = value(o)) s.values.push_back(*v);
  }
  std::sort(s.values.begin(), s.values.end());
  s.met = !s.values.empty() && (atMost ? s.median() <= bound : s.median() >= bound);
  return s;
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
                  candidates.size() <= std::max<std::size_t>(1, o.named.size());
  for (const Json& truth : hiding) {
    for (const Json& effect : effects) {
      // an equivalent has its own amplitude, which the truth does not tell
      if (o.claims && !o.z && effect.at("id") == truth.at("id")) o.z = deviation(effect, truth);
    }
  }
  const auto gap = verdict.find("gap");
  if (gap != verdict.end() && gap->contains("held_out") && (*gap)["held_out"].is_object()) {
    const Json& heldOut = (*gap)["held_out"];
    o.gapClosed = finite(heldOut, "gap_closed");
    for (const std::string unit : {"_deg", "_N"}) {
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

bool Row::within(double deviations) const {
  const double expected = n * bound, slack = deviations * std::sqrt(n * bound * (1 - bound));
  return atMost ? k <= expected + slack : k >= expected - slack;
}

bool Spread::within(double deviations) const {
  const auto right = std::count_if(values.begin(), values.end(), [&](double value) {
    return atMost ? value <= bound : value >= bound;
  });
  const auto n = static_cast<double>(values.size());
  return static_cast<double>(right) >= n / 2 - deviations * std::sqrt(n) / 2;
}

namespace {

struct Claim {
  double probability;
  bool right;
};

Calibration binned(const std::vector<Claim>& claims) {
  constexpr int parts = 10;
  std::vector<Calibration::Bin> bins(parts);
  Calibration c;
  for (const Claim& claim : claims) {
    auto& bin = bins[static_cast<std::size_t>(
        std::clamp(static_cast<int>(claim.probability * parts), 0, parts - 1))];
    ++bin.n;
    bin.probability += claim.probability;
    bin.right += claim.right;
  }
  for (Calibration::Bin& bin : bins) {
    if (bin.n == 0) continue;
    bin.probability /= bin.n, bin.right /= bin.n;
    c.n += bin.n;
    c.error += bin.n * std::abs(bin.right - bin.probability);
    c.bins.push_back(bin);
  }
  if (c.n > 0) c.error /= c.n;
  return c;
}

// Sets without a truth count: whatever is named there is wrong.
Calibration calibrationOf(const std::vector<Outcome>& outcomes) {
  std::vector<Claim> claims;
  for (const Outcome& o : outcomes) {
    if (!o.probability || *o.probability <= 0 || o.suite == "out") continue;  // 0: vetoed
    claims.push_back({*o.probability, o.firstIsTrue});
  }
  Calibration c = binned(claims);
  if (claims.empty()) return c;
  constexpr std::size_t draws = 2000;
  RandomNumbers random(1, 0);
  std::vector<double> errors;
  for (std::size_t draw = 0; draw < draws; ++draw) {
    for (Claim& claim : claims) claim.right = random.between(0, 1) < claim.probability;
    errors.push_back(binned(claims).error);
    c.chance += errors.back() / draws;
  }
  std::nth_element(errors.begin(), errors.begin() + draws * 19 / 20, errors.end());
  c.chanceHighest = errors[draws * 19 / 20];
  return c;
}

}  // namespace

double Spread::median() const {
  const std::size_t n = values.size();
  if (n == 0) return std::numeric_limits<double>::quiet_NaN();
  return n % 2 == 1 ? values[n / 2] : (values[n / 2 - 1] + values[n / 2]) / 2;
}

Score score(const std::vector<Outcome>& outcomes) {
  const auto of = [](const char* suite) {
    return [suite](const Outcome& o) { return o.suite == suite; };
  };
  const auto oneTruth = [](const Outcome& o) { return o.truth.size() == 1 && o.suite != "out"; };
  const auto withNoise = [&](bool noisy, bool full) {
    return [=](const Outcome& o) {
      return oneTruth(o) && (o.emgNoise > 0) == noisy && (o.size >= 0.99) == full;
    };
  };
  const auto firstIsRight = [](const Outcome& o) { return o.firstIsRight; };
  const auto hasZ = [](const Outcome& o) { return o.z.has_value(); };
  Score s;
  auto& r = s.rows;
  r.push_back(row(outcomes, "false alarms on null data", "≤ 2 %", 0.02, true, of("null"),
                  [](const Outcome& o) { return o.claims || !o.hasVerdict; }));
  r.push_back(row(outcomes, "structure named when only parameters are wrong", "≤ 2 %", 0.02, true,
                  of("parameter"),
                  [](const Outcome& o) { return o.namesStructure || !o.hasVerdict; }));
  r.push_back(row(outcomes, "right name first, clean EMG, full size", "≥ 97 %", 0.97, false,
                  withNoise(false, true), firstIsRight));
  r.push_back(row(outcomes, "right name first, clean EMG, smaller", "≥ 92 %", 0.92, false,
                  withNoise(false, false), firstIsRight));
  r.push_back(row(outcomes, "right name first, noisy EMG, full size", "≥ 85 %", 0.85, false,
                  withNoise(true, true), firstIsRight));
  r.push_back(row(
      outcomes, "of the first of these, single effects without parameters in error", "–", 0, false,
      [&](const Outcome& o) { return o.suite == "single" && withNoise(false, true)(o); },
      firstIsRight));
  const auto visible = [&](const auto& chosen) {
    return [=](const Outcome& o) { return chosen(o) && o.detectable; };
  };
  r.push_back(row(outcomes, "the same, clean, full size, not called too small to see", "–", 0,
                  false, visible(withNoise(false, true)), firstIsRight));
  r.push_back(row(outcomes, "the same, clean, smaller, not called too small to see", "–", 0, false,
                  visible(withNoise(false, false)), firstIsRight));
  r.push_back(row(outcomes, "the same, noisy, full size, not called too small to see", "–", 0,
                  false, visible(withNoise(true, true)), firstIsRight));
  r.push_back(row(outcomes, "right name first, noisy EMG, smaller", "–", 0, false,
                  withNoise(true, false), firstIsRight));
  r.push_back(row(
      outcomes, "truth inside the class, of those detected", "≥ 98 %", 0.98, false,
      [&](const Outcome& o) { return oneTruth(o) && o.claims; },
      [](const Outcome& o) { return o.classHasTruth; }));
  r.push_back(row(
      outcomes, "confidently wrong", "≤ 1 %", 0.01, true,
      [](const Outcome& o) { return o.suite != "out"; },
      [](const Outcome& o) { return o.confidentlyWrong(); }));
  r.push_back(row(outcomes, "two effects: both named", "≥ 85 %", 0.85, false, of("two"),
                  [](const Outcome& o) { return o.allNamed; }));
  r.push_back(row(outcomes, "out of catalogue: no unqualified name", "≥ 90 %", 0.9, false,
                  of("out"), [](const Outcome& o) { return o.hasVerdict && !o.unqualified; }));
  r.push_back(row(outcomes, "equivalents: given as a class of both", "100 %", 1, false,
                  of("equivalents"), [](const Outcome& o) { return o.asClass; }));
  r.push_back(row(outcomes, "equivalents after the follow-up: the one right name", "≥ 92 %", 0.92,
                  false, of("follow-up"), [](const Outcome& o) { return o.uniquelyRight; }));
  r.push_back(row(outcomes, "parameter within 2 sd of the truth", "–", 0, false, hasZ,
                  [](const Outcome& o) { return std::abs(*o.z) <= 2; }));
  Row coverage = row(outcomes, "95 % interval covers the truth", "90–98 %", 0.9, false, hasZ,
                     [](const Outcome& o) { return std::abs(*o.z) <= 1.959964; });
  coverage.met = coverage.met && coverage.k <= 0.98 * coverage.n;
  r.push_back(coverage);

  const auto hidden = [](const Outcome& o) { return !o.truth.empty() && o.suite != "out"; };
  const auto clean = [&](const Outcome& o) { return hidden(o) && !(o.emgNoise > 0) && o.claims; };
  s.spreads.push_back(
      spread(outcomes, "gap closed on the held-out trial", "", "median ≥ 0.97", 0.97, false,
             [&](const Outcome& o) { return hidden(o) ? o.gapClosed : std::nullopt; }));
  s.spreads.push_back(
      spread(outcomes, "held-out error over the noise floor", "", "median ≤ 1.03", 1.03, true,
             [&](const Outcome& o) { return hidden(o) ? o.overFloor : std::nullopt; }));
  s.spreads.push_back(
      spread(outcomes, "the same, clean EMG, as verdicts expect it", "", "–", 0, false,
             [&](const Outcome& o) { return clean(o) ? o.expectedOverFloor : std::nullopt; }));
  s.spreads.push_back(
      spread(outcomes, "the same, clean EMG, as it is", "", "–", 0, false,
             [&](const Outcome& o) { return clean(o) ? o.overFloor : std::nullopt; }));
  s.spreads.push_back(spread(outcomes, "time per data set", "s", "≤ 60 s", 60, true,
                             [](const Outcome& o) { return o.seconds; }));
  s.calibration = calibrationOf(outcomes);
  Spread& time = s.spreads.back();
  time.met = !time.values.empty() && time.values.back() <= 60;
  return s;
}

Json Score::asJson() const {
  Json json = {{"shares", Json::array()}, {"spreads", Json::array()}};
  for (const Row& r : rows) {
    const Interval i = r.interval();
    json["shares"].push_back({{"metric", r.metric},
                              {"k", r.k},
                              {"n", r.n},
                              {"share", r.n > 0 ? Json(static_cast<double>(r.k) / r.n) : Json()},
                              {"wilson_low", i.low},
                              {"wilson_high", i.high},
                              {"target", r.target},
                              {"met", r.n > 0 ? Json(r.met) : Json()},
                              {"misses", r.misses}});
  }
  for (const Spread& s : spreads) {
    const bool any = !s.values.empty();
    json["spreads"].push_back({{"metric", s.metric},
                               {"unit", s.unit},
                               {"n", s.values.size()},
                               {"median", any ? Json(s.median()) : Json()},
                               {"least", any ? Json(s.values.front()) : Json()},
                               {"greatest", any ? Json(s.values.back()) : Json()},
                               {"target", s.target},
                               {"met", any ? Json(s.met) : Json()}});
  }
  json["calibration"] = {{"n", calibration.n},
                         {"error", calibration.error},
                         {"error_by_chance", calibration.chance},
                         {"error_by_chance_95", calibration.chanceHighest}};
  for (const Calibration::Bin& bin : calibration.bins)
    json["calibration"]["bins"].push_back(
        {{"n", bin.n}, {"probability", bin.probability}, {"right", bin.right}});
  return json;
}

std::string Score::asMarkdown() const {
  std::string text =
      "| metric | k of n | share | 95 % interval | target | met |\n"
      "|---|---|---|---|---|---|\n";
  const auto yes = [](bool any, bool met) { return !any ? "–" : met ? "yes" : "no"; };
  for (const Row& r : rows) {
    const Interval i = r.interval();
    text += r.n == 0 ? fmt::format("| {} | 0 of 0 | – | – | {} | – |\n", r.metric, r.target)
                     : fmt::format("| {} | {} of {} | {:.1f} % | {:.1f}–{:.1f} % | {} | {} |\n",
                                   r.metric, r.k, r.n, 100.0 * r.k / r.n, 100 * i.low, 100 * i.high,
                                   r.target, r.target == "–" ? "–" : yes(true, r.met));
  }
  text +=
      "\n| metric | n | median | least – greatest | target | met |\n|---|---|---|---|---|---|\n";
  for (const Spread& s : spreads) {
    const bool any = !s.values.empty();
    text += any ? fmt::format("| {} | {} | {:.4g} {} | {:.4g} – {:.4g} | {} | {} |\n", s.metric,
                              s.values.size(), s.median(), s.unit, s.values.front(),
                              s.values.back(), s.target, s.target == "–" ? "–" : yes(any, s.met))
                : fmt::format("| {} | 0 | – | – | {} | – |\n", s.metric, s.target);
  }
  if (calibration.n > 0) {
    text += fmt::format(
        "\nProbability of the first name and share of first names that are the truth itself "
        "({} names, calibration error {:.3f}, target ≤ 0.05; true probabilities would give {:.3f}, "
        "19 times of 20 below {:.3f}):",
        calibration.n, calibration.error, calibration.chance, calibration.chanceHighest);
    for (const auto& bin : calibration.bins)
      text += fmt::format(" {:.2f}: {:.2f} of {};", bin.probability, bin.right, bin.n);
    text.back() = '.';
    text += '\n';
  }
  text += "\nMisses\n\n";
  for (const Row& r : rows) {
    for (const std::string& miss : r.misses) text += fmt::format("- {}: {}\n", r.metric, miss);
  }
  return text;
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
