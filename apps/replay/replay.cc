#include <fmt/format.h>

#include <algorithm>

#include "bio/analysis/replay.h"
#include "bio/analysis/step_effect.h"
#include "bio/discovery/with_experimental_conditions.h"
#include "bio/opensim/osim_file.h"
#include "command/command.h"
#include "options/model_methods.h"
#include "options/system_options.h"
#include "options/trial_input.h"
#include "output/progress_bar.h"
#include "playback/playback.h"
#include "replay/replay_report.h"
#include "report/result.h"

namespace app {
namespace {

/// The model, mapping and start with the values of --set.
bio::ParameterCatalogue::Setting settingOf(const std::vector<Assignment>& typed,
                                           const bio::ParameterCatalogue& catalogue) {
  std::vector<std::size_t> selection;
  Eigen::VectorXd values(static_cast<Eigen::Index>(typed.size()));
  for (const Assignment& one : typed) {
    const std::size_t index = catalogue.find(one.name);
    if (std::find(selection.begin(), selection.end(), index) != selection.end())
      throw std::invalid_argument(fmt::format("--set: '{}' is given twice", one.name));
    values[static_cast<Eigen::Index>(selection.size())] = one.value;
    selection.push_back(index);
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
    addAssignments(options, "--set", set_,
                   "another value of a parameter, in its unit (an angle also as 34deg), as "
                   "TRI.radius=0.018; may be repeated; `sensitivity MODEL --list-parameters` lists "
                   "them");
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
    if (!muscleClass_.empty()) {
      folder.writeFile("model.osim",
                       [&](const std::filesystem::path& path) { bio::writeOsim(model, path); });
    }
    addExternalLoads(externalLoads_, model, summary);
    chooseCoordinates(simulation_, model, {trial_}, reactions_);
    summary.addInput(trial_);
    const bio::Trial trial = readTrialFile(trial_, model, simulation_,
                                           {.experimentalConditions = true, .channels = true});
    for (const std::string& warning : trial.warnings) summary.warn(warning);
    if (trial.conditions.any()) {
      model = bio::discover::withExperimentalConditions(model, systemOptions(simulation_),
                                                        simulation_.coordinates, trial);
    }
    bio::MusculoskeletalSystem system = movableSystem(model, model_, simulation_, summary);
    bio::TrialBeginning beginning =
        bio::beginningOf(trial, model, system, byName(simulation_.initial));
    bio::EmgMapping mapping;
    if (!set_.empty()) {
      bio::ParameterCatalogue::Setting setting =
          settingOf(set_, bio::ParameterCatalogue(model, system, beginning.point));
      model = std::move(setting.model);
      mapping = std::move(setting.mapping);
      beginning.point = std::move(setting.start);
      system = bio::MusculoskeletalSystem(model, systemOptions(simulation_));
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
  std::string muscleClass_;      ///< empty: as in the model
  std::string externalLoads_;    ///< empty: none
  std::vector<Assignment> set_;  ///< other values of parameters
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
