#include "discover/written_discovery.h"

#include <fmt/format.h>

#include <cmath>

#include "bio/analysis/replay.h"
#include "bio/opensim/osim_file.h"
#include "options/set_parameters.h"
#include "options/system_options.h"
#include "output/driven_trials.h"
#include "output/text.h"
#include "playback/replayed_trials.h"

namespace app {
namespace {

using bio::discover::RepairedTrial;

/// The effects in the written model are only the closest match, or found with steps that are too
/// long.
bool mayBeWrong(const info::discover::Verdict& verdict) {
  const bool isFormula = verdict.finding == info::discover::Finding::unknown && verdict.formula &&
                         verdict.formula->wins;
  return !mayBeAdded(verdict) && !isFormula;
}

/// The written model in words.
std::string nameOf(const WrittenDiscovery& written) {
  if (written.model == "with_effect.osim") return "with the effect";
  return written.model == "refitted.osim" ? "refitted, without an effect"
                                          : "with the closest match";
}

class DiscoveryWriter {
 public:
  DiscoveryWriter(const DiscoveryToWrite& discovery, Summary& summary, OutputFolder& folder)
      : request_(discovery.request),
        files_(discovery.files),
        wording_(discovery.wording),
        result_(discovery.result),
        summary_(summary),
        folder_(folder) {}

  WrittenDiscovery write() {
    written_.replayFiles = files_;
    written_.trials = result_.trials;
    written_.shown = result_.shown;
    written_.sizes = result_.sizes;
    written_.inputs = result_.inputs;
    written_.positionBreak = result_.positionBreak;
    written_.trialsAreCut = result_.trialsAreCut;
    if (result_.found.verdict.base.size() == 0)
      return std::move(written_);  // stopped before there was a model
    if (result_.repaired) writeModels(*result_.repaired);
    tellCommands();
    return std::move(written_);
  }

 private:
  void writeModels(bio::discover::Repaired& repaired) {
    bio::Model& model = repaired.added.model;
    std::size_t training = 0, heldOut = 0;
    for (const RepairedTrial& trial : repaired.trials) {
      const std::size_t number = trial.isHeldOut ? ++heldOut : ++training;
      if (trial.driven)
        written_.replayFiles[trial.index] = writeDriven(trial, number, model, folder_);
    }
    written_.model = !result_.addsEffect                 ? "refitted.osim"
                     : mayBeWrong(result_.found.verdict) ? "closest_match.osim"
                                                         : "with_effect.osim";
    writeOsim(written_.model, model);
    if (result_.effectOnly) writeOsim("effect_only.osim", result_.effectOnly->model);
    for (const RepairedTrial& trial : repaired.trials)
      compareWithFit(trial, repaired.added.sensors);
  }

  void writeOsim(const std::string& name, const bio::Model& model) {
    folder_.writeFile(name, [&](const std::filesystem::path& path) {
      bio::rewriteOsim(request_.model, model, path);
    });
  }

  /// A corrected recording has other degrees, and may have fewer samples.
  void compareWithFit(const RepairedTrial& trial,
                      const std::vector<bio::discover::SensorLaw>& laws) {
    for (bio::discover::SensorLaw law : laws) {
      law.bias = 0;
      if (!law.isTrue()) return;
    }
    if (std::isnan(trial.after)) return;
    const double unit = wording_.unit;
    const double tolerance = wording_.errorEnd == "_deg" ? 0.01
                             : wording_.errorEnd == "_m" ? 1e-5
                                                         : 0.02 * unit * trial.floor;
    if (unit * std::abs(trial.after - trial.fitted) <= tolerance) return;
    summary_.warn(fmt::format(
        "{}: the written model replays with an RMS error of {}, the search itself had {}; the "
        "report gives the value of the replay",
        files_[trial.index], withUnit(unit * trial.after, wording_.errorUnit),
        withUnit(unit * trial.fitted, wording_.errorUnit)));
  }

  void tellCommands() {
    const SimulationOptions& typed = request_.simulation;
    written_.commands.emplace_back("this report", summary_.commandLine());
    for (const RepairedTrial& trial : written_.trials) {
      const std::string& file = files_[trial.index];
      const std::string& replayed = written_.replayFiles[trial.index];
      if (!written_.trialsAreCut)
        written_.commands.emplace_back(
            file + ", original model",
            fmt::format("fisherhill replay {} {}{}{}", shellWord(request_.model), shellWord(file),
                        typedOptions(typed, true), setWords(typed)));
      if (written_.model.empty()) continue;
      const std::string model =
          folder_.active() ? folder_.path(written_.model).string() : written_.model;
      written_.commands.emplace_back(file + ", with all fitted parameters",
                                     fmt::format("fisherhill replay {} {}{}", shellWord(model),
                                                 shellWord(replayed), typedOptions(typed, false)));
    }
  }

  const ModelDiscoveryRequest& request_;
  const std::vector<std::string>& files_;
  const DiscoverWording& wording_;
  bio::discover::DiscoveryResult& result_;
  Summary& summary_;
  OutputFolder& folder_;
  WrittenDiscovery written_;
};

}  // namespace

std::vector<std::string> namesOfDiscovery(std::size_t training, std::size_t heldOut) {
  std::vector<std::string> names = {"verdict.json",     "parameters.csv",     "with_effect.osim",
                                    "effect_only.osim", "closest_match.osim", "refitted.osim"};
  // trials that are held out may be fitted after all
  for (std::size_t i = 1; i <= training + heldOut; ++i) names.push_back(drivenName(i, false));
  for (std::size_t i = 1; i <= heldOut; ++i) names.push_back(drivenName(i, true));
  return names;
}

WrittenDiscovery writeDiscovery(const DiscoveryToWrite& discovery, Summary& summary,
                                OutputFolder& folder) {
  return DiscoveryWriter(discovery, summary, folder).write();
}

std::optional<Playback> discoverPlayback(const DiscoveryToWrite& discovery,
                                         const WrittenDiscovery& written, const bio::Model& model) {
  const SimulationOptions& typed = discovery.request.simulation;
  const bio::discover::DiscoveryResult& result = discovery.result;
  const bio::discover::MusculoskeletalProblem& data = *result.data;
  const bio::SimulationOptions simulation = simulationOptions(typed, 0, 1);
  const double before = bio::stepOf(model, simulation.integrator, typed.step);
  ReplayedTrials replayed(systemOptions(typed), simulation);
  for (const bool heldOut : {true, false}) {
    for (const bio::discover::RepairedTrial& one : result.trials) {
      if (one.isHeldOut != heldOut) continue;
      const bio::Trial& recorded = data.trial(static_cast<int>(one.index));
      replayed.beginTrial(recorded.file + (heldOut ? " (held out)" : ""), recorded);
      if (result.repaired) {
        const bio::Model& repaired = result.repaired->added.model;
        replayed.add(nameOf(written), repaired,
                     one.driven ? bio::drivenTrial(*one.driven, recorded, repaired) : recorded,
                     {.step = result.found.step, .starts = one.starts});
      }
      replayed.add("original model", model, recorded,
                   {.step = before, .given = byName(typed.initial)});
    }
  }
  return replayed.playback("The motion in three dimensions");
}

}  // namespace app
