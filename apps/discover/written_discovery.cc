#include "discover/written_discovery.h"

#include <fmt/format.h>

#include <cmath>

#include "bio/opensim/osim_file.h"
#include "discover/discover_search.h"
#include "info/version.h"
#include "options/system_options.h"
#include "output/angle_unit.h"
#include "output/sha256.h"
#include "output/text.h"

namespace app {
namespace {

using bio::discover::RepairedTrial;
using info::discover::Finding;
using info::discover::Verdict;

/// The missing effect is not in the catalogue, but a formula describes it.
bool isFormula(const Verdict& verdict) {
  return verdict.finding == Finding::unknown && verdict.formula && verdict.formula->wins;
}

/// Nothing is missing, and the parameters were fitted all the same.
bool isRefitted(const Verdict& verdict) {
  return verdict.reached == info::discover::Stage::finished && verdict.finding == Finding::none;
}

/// The options of a command that say what is simulated.
std::string optionsOf(const SimulationOptions& options, bool withStep) {
  std::string text;
  if (options.coordinates != SimulationOptions().coordinates)
    for (const std::string& name : options.coordinates) text += " --coordinate " + shellWord(name);
  for (const Assignment& lock : options.locks)
    text += " --lock " + shellWord(fmt::format("{}={}", lock.name, lock.value));
  for (const std::string& name : options.wrapAsCylinder)
    text += " --wrap-as-cylinder " + shellWord(name);
  if (options.integrator != SimulationOptions().integrator)
    text += " --integrator " + options.integrator;
  if (options.ignoreExtra) text += " --ignore-extra";
  if (withStep && options.step) text += fmt::format(" --step {}", *options.step);
  return text;
}

class DiscoveryWriter {
 public:
  DiscoveryWriter(const ModelDiscoveryResult& found, Summary& summary, OutputFolder& folder)
      : found_(found), summary_(summary), folder_(folder) {
    provenance_.tool = "fisherhill " + std::string(info::version());
    for (const Summary::InputFile& input : summary.inputs())
      provenance_.data.push_back(fmt::format("{} SHA-256 {}", input.path, input.sha256));
  }

  WrittenDiscovery write() {
    const Verdict& verdict = found_.verdict;
    written_.replayFiles = found_.files;
    if (verdict.base.size() == 0) return std::move(written_);  // stopped before there was a model
    if (isFormula(verdict)) {
      const auto& data =
          dynamic_cast<const bio::discover::MusculoskeletalProblem&>(*verdict.formula->data);
      writeModels(data, *verdict.formula->verdict, verdict.formula->terms, "with_effect.osim");
    } else if (mayBeAdded(verdict)) {
      writeModels(found_.data, verdict, {}, "with_effect.osim");
    } else if (isRefitted(verdict)) {
      writeModels(found_.data, verdict, {}, "refitted.osim");
    } else {
      written_.trials = bio::discover::recordedTrials(found_.data, verdict, found_.heldOut,
                                                      found_.request.simulation.step);
    }
    measureEffects();
    tellCommands();
    return std::move(written_);
  }

 private:
  void writeModels(const bio::discover::MusculoskeletalProblem& data, const Verdict& verdict,
                   const std::vector<info::discover::FormulaTerm>& formula,
                   const std::string& name) {
    const SimulationOptions& typed = found_.request.simulation;
    bio::discover::Repaired& repaired = written_.repaired.emplace(
        bio::discover::repairedModel(data, verdict, found_.heldOut, typed.step, provenance_));
    bio::Model& model = repaired.added.model;
    std::size_t training = 0, heldOut = 0;
    for (const RepairedTrial& one : repaired.trials) {
      const std::size_t number = one.isHeldOut ? ++heldOut : ++training;
      if (one.driven) writeDriven(one, number, model);
    }
    written_.model = name;
    folder_.writeFile(name, [&](const std::filesystem::path& path) {
      bio::rewriteOsim(found_.request.model, model, path);
    });
    if (!verdict.effects.empty()) {
      const bio::discover::Augmented alone = bio::discover::addEffects(
          data.encompassing().base(), armOptions(typed), data.encompassing().coordinate().name,
          bio::discover::effectsToAdd(data, verdict), provenance_, formula);
      folder_.writeFile("effect_only.osim", [&](const std::filesystem::path& path) {
        bio::rewriteOsim(found_.request.model, alone.model, path);
      });
    }
    written_.trials = repaired.trials;
    for (const RepairedTrial& one : repaired.trials) compareWithFit(one, repaired.added.sensor);
  }

  void writeDriven(const RepairedTrial& trial, std::size_t number, bio::Model& model) {
    const std::string name =
        fmt::format("driven_{}{}.sto", trial.isHeldOut ? "held_out_" : "", number);
    folder_.writeFile(name, [&](const std::filesystem::path& path) {
      bio::writeTable(*trial.driven, path);
      bio::TrialStart start = trial.start;
      start.file = name;
      start.sha256 = sha256OfFile(path);
      model.fitted.starts.push_back(std::move(start));
    });
    written_.replayFiles[static_cast<std::size_t>(trial.index)] =
        folder_.active() ? folder_.path(name).string() : name;
  }

  /// A corrected recording has other degrees, and may have fewer samples.
  void compareWithFit(const RepairedTrial& one, const bio::discover::SensorLaw& sensor) {
    const bool turns = found_.data.encompassing().coordinate().isRotation;
    const double unit = turns ? radian : 1e3;
    bio::discover::SensorLaw besidesBias = sensor;
    besidesBias.bias = 0;
    if (!besidesBias.isTrue() || std::isnan(one.after)) return;
    if (unit * std::abs(one.after - one.fitted) <= 0.01) return;
    summary_.warn(
        fmt::format("{}: the written model replays with an RMS error of {} {}, the search itself "
                    "had {}; the report gives the value of the replay",
                    one.start.file, numberText(unit * one.after), turns ? "deg" : "mm",
                    numberText(unit * one.fitted)));
  }

  void measureEffects() {
    if (!found_.heldOut.empty()) written_.shown = found_.heldOut.front();
    for (const auto& effect : found_.verdict.effects)
      written_.sizes.push_back(bio::discover::effectSize(found_.data, effect.candidate,
                                                         found_.verdict.values, written_.shown));
  }

  void tellCommands() {
    const SimulationOptions& typed = found_.request.simulation;
    written_.commands.emplace_back("this report", summary_.commandLine());
    for (const RepairedTrial& one : written_.trials) {
      const std::string& file = found_.files[static_cast<std::size_t>(one.index)];
      const std::string& replayed = written_.replayFiles[static_cast<std::size_t>(one.index)];
      written_.commands.emplace_back(
          file + ", original model",
          fmt::format("fisherhill replay {} {}{}", shellWord(found_.request.model), shellWord(file),
                      optionsOf(typed, true)));
      if (written_.model.empty()) continue;
      const std::string model =
          folder_.active() ? folder_.path(written_.model).string() : written_.model;
      written_.commands.emplace_back(file + ", with all fitted parameters",
                                     fmt::format("fisherhill replay {} {}{}", shellWord(model),
                                                 shellWord(replayed), optionsOf(typed, false)));
    }
  }

  const ModelDiscoveryResult& found_;
  Summary& summary_;
  OutputFolder& folder_;
  bio::discover::EffectProvenance provenance_;
  WrittenDiscovery written_;
};

}  // namespace

std::vector<std::string> namesOfDiscovery(std::size_t training, std::size_t heldOut) {
  std::vector<std::string> names = {"verdict.json", "parameters.csv", "with_effect.osim",
                                    "effect_only.osim", "refitted.osim"};
  // trials that are held out may be fitted after all
  for (std::size_t i = 1; i <= training + heldOut; ++i)
    names.push_back(fmt::format("driven_{}.sto", i));
  for (std::size_t i = 1; i <= heldOut; ++i)
    names.push_back(fmt::format("driven_held_out_{}.sto", i));
  return names;
}

WrittenDiscovery writeDiscovery(const ModelDiscoveryResult& found, Summary& summary,
                                OutputFolder& folder) {
  return DiscoveryWriter(found, summary, folder).write();
}

}  // namespace app
