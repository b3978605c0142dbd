#include "robots/hidden_robots.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <stdexcept>

#include "generator/data_set.h"

namespace hidden {
namespace {

using Json = nlohmann::ordered_json;

const RobotEffect& effectOf(const RobotKind& kind, const std::string& id) {
  std::vector<std::string> known;
  for (const RobotEffect& e : kind.effects) {
    if (e.id == id) return e;
    known.push_back(e.id);
  }
  throw std::invalid_argument(
      fmt::format("effect '{}', must be one of {}", id, fmt::join(known, ", ")));
}

bool belongs(const std::string& suite, const RobotEffect& e) {
  if (suite == "single" || suite == "two") return e.inCatalogue && e.kind != "parameter";
  if (suite == "parameter") return e.inCatalogue && e.kind == "parameter";
  if (suite == "out") return !e.inCatalogue;
  if (suite == "null") return false;
  throw std::invalid_argument(
      fmt::format("suite '{}', must be null, single, parameter, two or out", suite));
}

// Not two effects that one entry of the catalogue imitates.
bool tooAlike(const RobotEffect& a, const RobotEffect& b) {
  const auto family = [](const std::string& id) {
    if (id.starts_with("coulomb") || id.starts_with("stribeck"))
      return "dry" + id.substr(id.size() - 1);
    if (id == "lag" || id == "clock") return std::string("late");
    if (id == "tilt" || id.starts_with("bias_")) return std::string("off");
    return id;
  };
  return family(a.id) == family(b.id);
}

// A cart motion with a quiet start and end: five sines of 0.4 to 2 Hz under a window.
std::vector<double> drawCommand(const std::vector<double>& times, double strength,
                                RandomNumbers& random) {
  struct Sine {
    double amplitude, omega, phase;
  };
  std::vector<Sine> sines;
  for (int i = 0; i < 5; ++i) {
    const double omega = 2 * std::numbers::pi * random.between(0.4, 2.0);
    sines.push_back({strength * random.between(0.5, 1) / (omega * omega), omega,
                     random.between(0, 2 * std::numbers::pi)});
  }
  const double end = times.back(), rise = 0.8;
  // the quintic step and its slopes, per second
  const auto window = [&](double t, double& w, double& w1, double& w2) {
    const bool up = t < end / 2;
    const double z = std::clamp((up ? t : end - t) / rise, 0.0, 1.0), turn = up ? 1 : -1;
    w = z * z * z * (10 + z * (-15 + 6 * z));
    w1 = turn * 30 * z * z * (1 - z) * (1 - z) / rise;
    w2 = 60 * z * (1 - z) * (1 - 2 * z) / (rise * rise);
  };
  std::vector<double> command;
  for (const double t : times) {
    double w, w1, w2, place = 0, speed = 0, acceleration = 0;
    window(t, w, w1, w2);
    for (const Sine& s : sines) {
      place += s.amplitude * std::sin(s.omega * t + s.phase);
      speed += s.amplitude * s.omega * std::cos(s.omega * t + s.phase);
      acceleration -= s.amplitude * s.omega * s.omega * std::sin(s.omega * t + s.phase);
    }
    // what is written is what the cart is told
    command.push_back(std::round(1e5 * (w2 * place + 2 * w1 * speed + w * acceleration)) / 1e5);
  }
  return command;
}

RobotTrial drawTrial(const RobotKind& kind, const Numbers& plant, const RobotPlan& plan,
                     const std::string& name, std::uint64_t stream) {
  RobotTrial trial;
  trial.name = name;
  RobotRecord& record = trial.record;
  for (double t = 0; t < plan.seconds + kind.interval / 2; t += kind.interval)
    record.times.push_back(std::round(t * 1e6) / 1e6);
  RandomNumbers random(plan.seed, stream);
  // lively, but neither over the top nor slack
  double strength = 1;
  for (int attempt = 0;; ++attempt) {
    if (attempt == 60) throw std::runtime_error(name + ": 60 draws failed");
    record.command = drawCommand(record.times, strength, random);
    record.unasked.clear();
    if (plan.inputNoise > 0) {
      const double kept = std::exp(-kind.interval / 0.08);
      double d = plan.inputNoise * random.normal();
      for (std::size_t i = 0; i < record.times.size(); ++i) {
        record.unasked.push_back(d);
        d = kept * d + plan.inputNoise * std::sqrt(1 - kept * kept) * random.normal();
      }
    }
    try {
      kind.observe(plant, record, 1e-10);
    } catch (const std::runtime_error&) {
      strength *= 0.7;
      continue;
    }
    const bool slack = kind.name == "suspended-mass" && record.leastForce < 0.2;
    if (record.largestAngle > 1.3 || slack)
      strength *= 0.8;
    else if (record.largestAngle < 0.6)
      strength *= 1.2;
    else
      break;
  }
  const double unit = kind.inDegrees ? 180 / std::numbers::pi : 1,
               grain = kind.inDegrees ? 0.01 : 0.001;
  for (std::size_t c = 0; c < record.seen.size(); ++c) {
    trial.read.emplace_back();
    for (const double y : record.seen[c])
      trial.read[c].push_back(grain *
                              std::round(unit * (y + kind.noise[c] * random.normal()) / grain));
  }
  return trial;
}

double rms(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

}  // namespace

std::vector<std::string> chosenEffects(const RobotPlan& plan) {
  const RobotKind& kind = robotKind(plan.system);
  std::vector<const RobotEffect*> rows;
  for (const RobotEffect& e : kind.effects)
    if (e.bySeed && belongs(plan.suite, e)) rows.push_back(&e);
  const std::size_t count = plan.suite == "null" ? 0 : plan.suite == "two" ? 2 : 1;
  if (!plan.effects.empty()) {
    if (plan.effects.size() != count)
      throw std::invalid_argument(fmt::format("suite '{}' hides {} effects, {} are named",
                                              plan.suite, count, plan.effects.size()));
    for (const std::string& id : plan.effects)
      if (!belongs(plan.suite, effectOf(kind, id)))
        throw std::invalid_argument(fmt::format("'{}' is not of suite '{}'", id, plan.suite));
    return plan.effects;
  }
  if (count == 0) return {};
  if (count == 1) return {rows[plan.seed % rows.size()]->id};
  std::vector<std::pair<std::string, std::string>> pairs;
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t k = i + 1; k < rows.size(); ++k)
      if (!tooAlike(*rows[i], *rows[k])) pairs.emplace_back(rows[i]->id, rows[k]->id);
  const auto& pair = pairs[(plan.seed * 7919) % pairs.size()];
  return {pair.first, pair.second};
}

RobotDataSet makeRobotDataSet(const RobotPlan& plan) {
  const RobotKind& kind = robotKind(plan.system);
  RandomNumbers draw(plan.seed, 0), hiding(plan.seed, 1);
  Numbers base = kind.nominal;
  Json drawn = Json::object();
  for (const auto& [name, deviation] : kind.tolerance) {
    const double factor = std::exp(plan.nuisances * deviation * draw.normalWithin(2.5));
    base[name] *= factor;
    drawn[name] = factor;
  }
  Numbers plant = base;
  Json effects = Json::array();
  for (const std::string& id : chosenEffects(plan)) {
    const RobotEffect& e = effectOf(kind, id);
    double amplitude = plan.size * e.fullSize, value = 0;
    if (e.eitherSign && hiding.between(0, 1) < 0.5) amplitude = -amplitude;
    if (e.kind == "parameter") {
      value = plant.at(id) *= 1 + amplitude;
    } else {
      value = plant[id] = amplitude;
      if (id == "saturation") plant["saturation_at"] = 1.4;
      if (id == "link_3") plant["link_3_length"] = 0.1 * std::exp(0.3 * hiding.normalWithin(2.5));
    }
    effects.push_back(
        {{"id", e.id},
         {"kind", e.kind},
         {"in_catalogue", e.inCatalogue},
         {"law", e.law},
         {"amplitude", amplitude},
         {"unit", e.unit},
         {"readings", Json::array({{{"name", e.id}, {"unit", e.unit}, {"value", value}}})},
         {"equivalents", e.equivalents}});
  }
  RobotDataSet set;
  Json strength = Json::array();
  const char* names[] = {"train_1", "train_2", "train_3", "held_out"};
  for (std::uint64_t i = 0; i < 4; ++i) {
    set.trials.push_back(drawTrial(kind, plant, plan, names[i], 100 * (i + 1)));
    RobotRecord bare = set.trials.back().record;
    kind.observe(base, bare, 1e-8);
    Json far = Json::array();
    for (std::size_t c = 0; c < bare.seen.size(); ++c)
      far.push_back(rms(bare.seen[c], set.trials.back().record.seen[c]) / kind.noise[c]);
    strength.push_back({{"trial", names[i]}, {"effect_rms_in_noise_sd", far}});
  }
  set.label = {{"seed", plan.seed},  {"system", plan.system},        {"suite", plan.suite},
               {"size", plan.size},  {"emg_noise", plan.inputNoise}, {"nuisances", plan.nuisances},
               {"effects", effects}, {"strength", strength},         {"nuisance_factors", drawn}};
  return set;
}

std::string asTable(const RobotKind& kind, const RobotTrial& trial, const std::string& title) {
  std::string text = fmt::format(
      "{}\nversion=1\nnRows={}\nnColumns={}\ninDegrees=no\nendheader\ntime\tinput\t{}\n", title,
      trial.record.times.size(), 2 + kind.columns.size(), fmt::join(kind.columns, "\t"));
  for (std::size_t k = 0; k < trial.record.times.size(); ++k) {
    text += fmt::format("{:.10g}\t{:.10g}", trial.record.times[k], trial.record.command[k]);
    for (const auto& channel : trial.read) text += fmt::format("\t{:.10g}", channel[k]);
    text += '\n';
  }
  return text;
}

void writeRobotDataSet(const RobotDataSet& set, const RobotKind& kind,
                       const std::filesystem::path& folder, const std::filesystem::path& labels) {
  const auto write = [](const std::filesystem::path& file, const std::string& text) {
    std::filesystem::create_directories(file.parent_path());
    std::ofstream stream(file, std::ios::binary);
    stream << text;
    stream.close();
    if (!stream) throw std::runtime_error(file.string() + ": cannot be written");
  };
  const std::string name = folder.filename().string();
  for (const RobotTrial& trial : set.trials)
    write(folder / (trial.name + ".sto"), asTable(kind, trial, name + " " + trial.name));
  const std::string label = set.label.dump(2) + "\n";
  write(labels / (name + ".json"), label);
  write(folder / "truth.sha256", sha256(label) + "\n");
}

}  // namespace hidden
