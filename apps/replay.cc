#include "replay.h"

#include <fmt/format.h>

#include <numbers>

#include "arm_options.h"
#include "bio/osim_file.h"
#include "bio/replay.h"
#include "progress_bar.h"
#include "replay_report.h"
#include "result.h"

namespace app {
namespace {

class Replay : public Command {
 public:
  About about() const override {
    return {"replay", "Simulate the motion that a trial's excitations make",
            "fisherhill replay models/elbow8.osim emg_data/curl_slow.sto --out out/replay"};
  }

  void addOptions(CLI::App& options) override {
    options.add_option("MODEL", model_, "model (.osim)")
        ->required()
        ->check(CLI::ExistingFile)
        ->type_name("");
    options.add_option("TRIAL", trial_, "excitations, and the measured coordinate if there is one")
        ->required()
        ->check(CLI::ExistingFile)
        ->type_name("");
    addSimulationOptions(options, simulation_);
  }

  ExitStatus run(const CommandContext& context) override {
    OutputFolder folder(context, {"states.sto", "forces.sto"});
    Summary summary(context);
    summary.addInput(model_);
    summary.addInput(trial_);
    const bio::Model model = bio::readOsim(model_);
    const bio::Trial trial = bio::readTrial(trial_, model, {simulation_.ignoreExtra});
    for (const std::string& warning : model.warnings) summary.warn(warning);
    for (const std::string& warning : trial.warnings) summary.warn(warning);

    const bio::Arm arm(model, armOptions(simulation_));
    for (const std::string& warning : arm.warnings()) summary.warn(warning);
    if (arm.numMuscles() == 0) {
      throw std::invalid_argument(
          fmt::format("{}: no muscle moves {}", model_, fmt::join(simulation_.coordinates, ", ")));
    }
    const bio::ExcitationSignal excitation = bio::excitationOf(trial, arm);
    const double start = trial.times[0];
    const double duration = trial.times[trial.times.size() - 1] - start;
    bio::SimulationOptions options = simulationOptions(simulation_, start, duration);
    const bio::ArmState state = bio::initialState(
        arm, bio::startCoordinates(trial, arm, byName(simulation_.initial)), excitation, start);

    bio::Trajectory motion;
    {
      ProgressBar bar("replay");
      options.progress = [&](double t) {
        bar.update((t - start) / duration);
        return true;
      };
      motion = bio::simulate(arm, excitation, state, options);
    }
    for (const std::string& sentence : bio::rangeRemarks(arm, motion)) summary.warn(sentence);
    const bio::MuscleReport muscles = bio::reportMuscles(arm, motion);
    folder.writeFile("states.sto", [&](const std::filesystem::path& path) {
      bio::writeTable(bio::statesTable(model, arm, motion), path);
    });
    folder.writeFile("forces.sto", [&](const std::filesystem::path& path) {
      bio::writeTable(bio::forcesTable(arm, motion, muscles), path);
    });

    const ReplayFindings findings{model_, trial_, model, trial, arm, motion, muscles, options};
    summary.setSimulation(simulation_.integrator, options.step, duration, motion.wallSeconds);
    tellReplay(findings, summary);
    deliver(context, summary, replayReport(findings), folder);
    return motion.outcome == bio::Outcome::completed ? ExitStatus::done : ExitStatus::answerIsNo;
  }

 private:
  std::string model_;
  std::string trial_;
  SimulationOptions simulation_;
};

}  // namespace

std::unique_ptr<Command> replayCommand() {
  return std::make_unique<Replay>();
}

}  // namespace app
