#include "generator/data_set.h"

#include <fmt/format.h>
#include <openssl/sha.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <set>
#include <stdexcept>

#include "generator/open_loop_trial.h"
#include "generator/passive_trial.h"

namespace hidden {
namespace {

using Json = nlohmann::ordered_json;
constexpr const char* unseen = "wrap_BIC";  // touched below 20° only

bool belongs(const std::string& suite, const EffectRow& row) {
  static const std::set<std::string> twins = {"delay", "clock", "tilt", "handforce"};
  const bool isParameter = row.kind == "parameter";
  if (suite == "single" || suite == "two") return row.inCatalogue && !isParameter;
  if (suite == "parameter") return row.inCatalogue && isParameter;
  if (suite == "out") return !row.inCatalogue;
  if (suite == "equivalents") return twins.count(row.id) > 0;
  if (suite == "null") return false;
  throw std::invalid_argument(
      fmt::format("suite '{}', must be null, single, parameter, two, out, equivalents, far or "
                  "violated",
                  suite));
}

// The how-manieth of its kind a set is, by seed.
std::uint64_t turnOf(const DataSetPlan& plan, const std::string& kind) {
  if (plan.suite == "violated") return plan.seed / 30 * 10 + plan.seed % 10;
  if (plan.suite != "far") return plan.seed;
  return kind == "single" ? plan.seed / 4 * 2 + (plan.seed % 4 == 3 ? 1 : 0) : plan.seed / 4;
}

// Effects whose sum is one of them again.
bool tooAlike(const EffectRow& a, const EffectRow& b) {
  static const std::set<std::string> dry = {"coulomb", "stribeck", "powerdamp"};
  const auto& e = a.equivalents;
  return a.id == b.id || std::find(e.begin(), e.end(), b.id) != e.end() ||
         (dry.count(a.id) && dry.count(b.id));
}

double rms(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

// RMS distance [deg] between what the sensor saw and what another elbow does with the same file;
// null where that elbow fails.
Json distance_deg(const Truth& truth, const Truth& other, const NamedTrial& named, bool trueEmg) {
  Recording recording = named.trial.truth;
  recording.emg = named.trial.recorded;
  if (!trueEmg) recording.unfaith.clear();
  const auto seen = throughSensor(truth.sensor, recording, named.trial.angle);
  try {
    const auto q = replayed(other, recording, named.trial.angle.front(), 1e-7);
    return std::round(1000 * rms(seen, q) / degree) / 1000;
  } catch (const std::runtime_error&) {
    return nullptr;
  }
}

Trial made(const Truth& truth, const TrialPlan& plan, RandomNumbers& random) {
  if (plan.passive) return makePassiveTrial(truth, plan, random);
  if (plan.openLoop) return makeOpenLoopTrial(truth, plan, random);
  return makeTrial(truth, plan, random);
}

// Trials are drawn until the nominal model follows one to within 30° RMS (40° in open loop), at
// most 12 times; then the one that it follows best is taken: the experimenter drops efforts that
// run away from every model. Returns the nominal model's distance [deg].
Json drawTrial(NamedTrial& named, const Truth& truth, const Truth& nominal, const TrialPlan& plan,
               std::uint64_t seed, std::uint64_t stream) {
  const double farthest = plan.openLoop ? 40 : 30;
  Json best;
  std::string why;
  int done = 0;
  for (std::uint64_t attempt = 0; attempt < 60 && done < 12; ++attempt) {
    RandomNumbers random(seed, stream + attempt);
    NamedTrial drawn = named;
    try {
      drawn.trial = made(truth, plan, random);
    } catch (const std::runtime_error& e) {
      why = e.what();
      continue;
    }
    ++done;
    const Json distance = distance_deg(truth, nominal, drawn, false);
    const bool better = best.is_null() || (!distance.is_null() && distance < best);
    if (done > 1 && !better) continue;
    best = distance;
    named = std::move(drawn);
    if (!best.is_null() && best <= farthest) break;
  }
  if (done == 0) throw std::runtime_error(named.name + ": 60 draws failed, the last: " + why);
  return best;
}

Json describe(const EffectRow& row, double amplitude) {
  Json readings = Json::array();
  for (const Reading& r : row.readings(amplitude)) {
    readings.push_back({{"name", r.name}, {"unit", r.unit}, {"value", r.value}});
  }
  return {{"id", row.id},
          {"name", row.name},
          {"kind", row.kind},
          {"in_catalogue", row.inCatalogue},
          {"law", row.formula},
          {"amplitude", amplitude},
          {"unit", row.unit},
          {"readings", readings},
          {"equivalents", row.equivalents}};
}

void write(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace

std::string hides(const DataSetPlan& plan) {
  if (plan.suite != "far" && plan.suite != "violated") return plan.suite;
  if (!plan.effects.empty()) {
    return hiddenEffect(plan.effects[0]).kind == "parameter" ? "parameter" : "single";
  }
  constexpr std::array<const char*, 4> far = {"null", "single", "parameter", "single"};
  constexpr std::array<const char*, 3> violated = {"null", "single", "parameter"};
  return plan.suite == "far" ? far[plan.seed % 4] : violated[plan.seed / 10 % 3];
}

const Violation& chosenViolation(const DataSetPlan& plan) {
  if (!plan.violation.empty()) return violation(plan.violation);
  return violations()[plan.seed % violations().size()];
}

std::vector<std::string> chosenEffects(const DataSetPlan& plan) {
  const std::string kind = hides(plan);
  std::vector<const EffectRow*> rows;
  for (const EffectRow& row : hiddenEffects()) {
    if (belongs(kind, row) && row.id != unseen) rows.push_back(&row);
  }
  const std::size_t count = kind == "null" ? 0 : kind == "two" ? 2 : 1;
  if (!plan.effects.empty()) {
    if (plan.effects.size() != count) {
      throw std::invalid_argument(fmt::format("suite '{}' hides {} effects, {} are named",
                                              plan.suite, count, plan.effects.size()));
    }
    for (const std::string& id : plan.effects) {
      if (!belongs(kind, hiddenEffect(id))) {
        throw std::invalid_argument(fmt::format("'{}' is not of suite '{}'", id, plan.suite));
      }
    }
    return plan.effects;
  }
  if (count == 0) return {};
  if (count == 1) return {rows[turnOf(plan, kind) % rows.size()]->id};
  std::vector<std::pair<std::string, std::string>> pairs;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t k = i + 1; k < rows.size(); ++k) {
      if (!tooAlike(*rows[i], *rows[k])) pairs.emplace_back(rows[i]->id, rows[k]->id);
    }
  }
  // a step without common divisor goes through all pairs, and nearby seeds differ in both names
  const auto& pair = pairs[(plan.seed * 7919) % pairs.size()];
  return {pair.first, pair.second};
}

DataSet makeDataSet(const ElbowNumbers& nominal, const DataSetPlan& plan) {
  Truth base;
  base.numbers = nominal;
  RandomNumbers person(plan.seed, 0), hiding(plan.seed, 1);
  const std::vector<std::string> chosen = chosenEffects(plan);
  std::vector<std::string> replaced;
  for (const std::string& id : chosen) {
    if (const std::string& own = hiddenEffect(id).inPlaceOf; !own.empty()) replaced.push_back(own);
  }
  const bool far = plan.suite == "far";
  const Violation* broken = plan.suite == "violated" ? &chosenViolation(plan) : nullptr;
  const Departures departures = far ? Departures{0.12, 0.03, 0.01, 0, 0} : Departures{};
  const auto nuisances = drawNuisances(base, person, plan.nuisances, replaced, departures);
  Truth truth = base, bare;
  bare.numbers = nominal;
  DataSet set;
  Json effects = Json::array();
  for (const std::string& id : chosen) {
    const EffectRow& row = hiddenEffect(id);
    row.apply(truth, row.amplitude(plan.size), hiding);
    effects.push_back(describe(row, row.amplitude(plan.size)));
    if (row.leftOut.empty()) continue;
    set.leftOut = row.leftOut;
    for (Truth* lacking : {&base, &bare}) {
      for (HillMuscle& m : lacking->numbers.muscles) {
        if (m.name == row.leftOut) m.maxForce = 0;
      }
    }
  }

  std::vector<std::string> names = {"train_1", "train_2", "train_3", "held_out"};
  if (plan.suite == "equivalents") names.emplace_back("follow_up");
  const bool timing = truth.chain.delay != 0 || truth.sensor.clock != 0;
  double emgNoise = plan.emgNoise;
  Json strength = Json::array();
  for (std::size_t i = 0; i < names.size(); ++i) {
    TrialPlan trialPlan;
    trialPlan.emgNoise = plan.emgNoise;
    trialPlan.openLoop = far;
    if (broken) trialPlan = planFor(*broken, trialPlan);
    emgNoise = trialPlan.emgNoise;
    NamedTrial named{names[i], {}, 0};
    Truth held = truth, known = bare;
    // what tells delay from clock is a push that no EMG announces; tilt from a force, a known mass;
    // a force from a stiffness, an arm that is turned
    if (named.name == "follow_up" && timing) trialPlan.torquePulses = true;
    if (named.name == "follow_up" && !timing) {
      trialPlan.passive = true;
      named.knownMass = 1;
      named.knownTurn = -45;
      for (Truth* one : {&held, &known}) {
        one->numbers.forearm.push_back(
            {"known", named.knownMass, nominal.hand, Eigen::Matrix3d::Zero()});
        one->extras.turn = named.knownTurn * degree;
      }
    }
    const Json nominalDistance = drawTrial(named, held, known, trialPlan, plan.seed, 100 * (i + 1));
    if (named.name != "follow_up") {
      strength.push_back({{"trial", named.name},
                          {"tracking_rms_deg",
                           far ? Json() : Json(std::round(100 * named.trial.tracking_deg) / 100)},
                          {"effect_rms_deg", distance_deg(truth, base, named, true)},
                          {"nominal_rms_deg", nominalDistance}});
    }
    if (broken) {
      RandomNumbers random(plan.seed, 1000 + i);
      violate(*broken, held, trialPlan, named.trial, random);
    }
    set.trials.push_back(std::move(named));
  }

  Json drawn = Json::object();
  for (const Nuisance& n : nuisances) drawn[n.name] = n.factor;
  set.label = {{"seed", plan.seed},           {"suite", plan.suite},
               {"size", plan.size},           {"emg_noise", emgNoise},
               {"nuisances", plan.nuisances}, {"angle_noise_deg", TrialPlan{}.angleNoise},
               {"effects", effects},          {"strength", strength},
               {"nuisance_factors", drawn}};
  if (far || broken) set.label["hides"] = hides(plan);
  if (broken) set.label["violation"] = {{"id", broken->id}, {"what", broken->what}};
  return set;
}

std::string asTable(const NamedTrial& named, const std::string& title, const std::string& leftOut) {
  static const std::array<std::string, 8> names = {"TRIlong", "TRIlat",   "TRImed", "ANC",
                                                   "BIClong", "BICshort", "BRA",    "BRD"};
  const Recording& truth = named.trial.truth;
  const bool pushed = !truth.torque.empty();
  std::string muscles;
  int columns = pushed ? 3 : 2;
  for (const std::string& name : names) {
    if (name == leftOut) continue;
    muscles += "\t" + name;
    ++columns;
  }
  std::string text = fmt::format("{}\nversion=1\nnRows={}\nnColumns={}\ninDegrees=no\n", title,
                                 truth.times.size(), columns);
  if (named.knownTurn != 0) text += fmt::format("known_arm_turn_deg={:g}\n", named.knownTurn);
  if (named.knownMass > 0) text += fmt::format("known_mass_in_hand_kg={:g}\n", named.knownMass);
  text += fmt::format("endheader\ntime{}\telbow_flexion_deg{}\n", muscles,
                      pushed ? "\telbow_flexion.torque" : "");
  for (std::size_t k = 0; k < truth.times.size(); ++k) {
    text += fmt::format("{:.10g}", truth.times[k]);
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i] != leftOut) text += fmt::format("\t{:.10g}", named.trial.recorded[k][i]);
    }
    text += fmt::format("\t{:.10g}", named.trial.measured_deg[k]);
    if (pushed) text += fmt::format("\t{:.10g}", truth.torque[k]);
    text += '\n';
  }
  return text;
}

void writeDataSet(const DataSet& set, const std::filesystem::path& model,
                  const std::filesystem::path& folder, const std::filesystem::path& labels) {
  const std::string name = folder.filename().string();
  for (const NamedTrial& trial : set.trials) {
    const bool after = trial.name == "follow_up";
    write((after ? folder / "follow_up" : folder) / (trial.name + ".sto"),
          asTable(trial, name + " " + trial.name, set.leftOut));
  }
  if (!set.leftOut.empty()) write(folder / "model.osim", withoutMuscle(model, set.leftOut));
  const std::string label = set.label.dump(2) + "\n";
  write(labels / (name + ".json"), label);
  write(folder / "truth.sha256", sha256(label) + "\n");
}

std::string sha256(const std::string& bytes) {
  unsigned char digest[SHA256_DIGEST_LENGTH];
  SHA256(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), digest);
  std::string hex;
  for (const unsigned char byte : digest) hex += fmt::format("{:02x}", byte);
  return hex;
}

}  // namespace hidden
