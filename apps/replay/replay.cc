#include <fmt/format.h>

#include <algorithm>

#include "bio/analysis/replay.h"
#include "bio/analysis/step_effect.h"
#include "bio/discovery/with_experimental_conditions.h"
#include "bio/opensim/osim_file.h"
#include "command/command.h"
#include "options/model_methods.h"
#include "options/set_parameters.h"
#include "options/system_options.h"
#include "options/trial_input.h"
#include "output/progress_bar.h"
#include "playback/playback.h"
#include "replay/replay_report.h"
#include "report/result.h"

namespace app {
namespace {

/// Mapping and start with the values of --set that belong to the trial.
bio::ParameterCatalogue::Setting trialSetting(const std::vector<bio::NamedValue>& typed,
                                              const bio::ParameterCatalogue& catalogue) {
  std::vector<std::size_t> selection;
  Eigen::VectorXd values(static_cast<Eigen::Index>(typed.size()));
  for (const bio::NamedValue& one : typed) {
    values[static_cast<Eigen::Index>(selection.size())] = one.value;
    selection.push_back(catalogue.find(one.name));
  }
  return catalogue.at(selection, values);
}

class Replay : public Command {
 public:
  About about() const override {
    return {"replay", "Simulate the motion produced by a trial's excitations",
            "fisherhill replay models/elbow8.osim emg_data/curl_slow.sto --out out/replay"};
  }

  void addOptions(CLI::App& options) override {
    addModelArgument(options, model_);
    addTrialArgument(options, trial_);
    addSimulationOptions(options, simulation_);
    addConvertMusclesOption(options, muscleClass_);
    addExternalLoadsOption(options, externalLoads_);
    addPrescribing(options, simulation_);
    options.add_flag(
        "--reactions", reactions_,
        "also the reactions at all locked coordinates, as NAME.reaction in forces.sto; "
        "without it, at those with a column NAME.moment");
    options.add_flag("--strict", strict_,
                     "exit with status 1 if a coordinate leaves its range by more than a tenth of "
                     "it, or a fibre leaves 0.2 to 2 optimal lengths");
  }

  ExitStatus run(const CommandContext& context) override {
    std::vector<std::string> files{"states.sto", "forces.sto"};
    if (!muscleClass_.empty()) files.push_back("model.osim");
    OutputFolder folder(context, files);
    Summary summary(context);
    bio::Model model = readModel(model_, summary);
    convertMuscles(muscleClass_, model, summary);
    addExternalLoads(externalLoads_, model, summary);
    chooseCoordinates(simulation_, model, {trial_}, reactions_);
    bio::ModelWithParameters set =
        withSetParameters(std::move(model), systemOptions(simulation_), simulation_.set, summary);
    model = std::move(set.model);
    if (!muscleClass_.empty()) {
      folder.writeFile("model.osim",
                       [&](const std::filesystem::path& path) { bio::writeOsim(model, path); });
    }
    summary.addInput(trial_);
    const bio::Trial trial = readTrialFile(trial_, model, simulation_,
                                           {.experimentalConditions = true, .channels = true});
    for (const std::string& warning : trial.warnings) summary.warn(warning);
    if (trial.conditions.any()) {
      model = bio::discover::withExperimentalConditions(model, systemOptions(simulation_),
                                                        simulation_.coordinates, trial);
    }
    const bio::MusculoskeletalSystem system = movableSystem(model, model_, simulation_, summary);
    bio::TrialBeginning beginning =
        bio::beginningOf(trial, model, system, byName(simulation_.initial));
    bio::EmgMapping mapping;
    if (!set.ofTrial.empty()) {
      bio::ParameterCatalogue::Setting setting =
          trialSetting(set.ofTrial, bio::ParameterCatalogue(model, system, beginning.point));
      mapping = std::move(setting.mapping);
      beginning.point = std::move(setting.start);
    }
    sayExcitations(system, summary.methods());
    bio::TrialReplay replay;
    {
      ProgressBar bar("replay");
      bio::SimulationOptions options = simulationOptions(simulation_, 0, 0);
      options.step = bio::stepOf(model, options.integrator, simulation_.step);
      options.progress = [&](double t) {
        bar.update((t - trial.times[0]) / trial.duration());
        return true;
      };
      replay = bio::replayTrial(system, trial, options, std::move(beginning), mapping);
    }
    const bio::Trajectory& motion = replay.motion;
    const std::optional<bio::LeftRange> left = bio::leftRange(system, motion);
    if (left) summary.warn(left->what);
    for (const bio::LeftRange& coordinate : bio::leftRanges(system, motion)) {
      if (!left || left->name != coordinate.name) summary.warn(coordinate.what);
    }
    const std::optional<bio::StepEffect> effect =
        bio::effectOfDoubtfulStep(system, trial, replay, simulation_.step.has_value());
    if (effect) summary.warn(describe(*effect));
    const bio::MuscleReport muscles = bio::reportMuscles(system, motion);
    folder.writeFile("states.sto", [&](const std::filesystem::path& path) {
      bio::writeTable(bio::statesTable(model, system, motion), path);
    });
    folder.writeFile("forces.sto", [&](const std::filesystem::path& path) {
      bio::writeTable(bio::forcesTable(system, motion, muscles), path);
    });

    ReplayFindings findings{model_, trial_, model, trial, system, replay, muscles, left, effect};
    if (folder.active()) {
      findings.playback = playbackOf("The motion in three dimensions",
                                     {{trial_, &trial, {{"simulated", model, system, motion}}}},
                                     systemOptions(simulation_).wrapAsCylinder);
    }
    summary.setSimulation(simulation_.integrator, replay.options.step, replay.options.duration,
                          motion.wallSeconds);
    tellReplay(findings, summary);
    deliver(context, summary, replayReport(findings), folder);
    const bool isFine = motion.outcome == bio::Outcome::completed && !effect && !(strict_ && left);
    return isFine ? ExitStatus::done : ExitStatus::answerIsNo;
  }

 private:
  std::string model_;
  std::string trial_;
  SimulationOptions simulation_;
  std::string muscleClass_;    ///< empty: as in the model
  std::string externalLoads_;  ///< empty: none
  bool reactions_ = false;
  bool strict_ = false;
};

}  // namespace

/// `replay`: simulates the motion produced by a trial's excitations and compares it with the
/// measurement.
std::unique_ptr<Command> replayCommand() {
  return std::make_unique<Replay>();
}

}  // namespace app
