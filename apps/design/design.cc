#include <fmt/format.h>

#include <chrono>

#include "bio/analysis/replay.h"
#include "bio/design/design_setup.h"
#include "bio/design/separating_design.h"
#include "command/command.h"
#include "design/design_methods.h"
#include "design/design_options.h"
#include "design/design_report.h"
#include "design/separating_report.h"
#include "options/model_methods.h"
#include "options/set_parameters.h"
#include "options/system_options.h"
#include "options/trial_input.h"
#include "output/interruption.h"
#include "output/progress_bar.h"
#include "report/result.h"

namespace app {
namespace {

class Design : public Command {
 public:
  About about() const override {
    return {"design", "Find the experiment that is most informative about chosen parameters",
            "fisherhill design models/elbow8.osim emg_data/curl_slow.sto --parameters TRI.radius "
            "--out out/design"};
  }

  void addOptions(CLI::App& options) override { addDesignOptions(options, typed_); }

  ExitStatus run(const CommandContext& context) override {
    checkDesignOptions(typed_);
    if (!typed_.dynamometer.coordinate.empty()) {
      return designOnDynamometer(context, typed_);
    }
    if (!typed_.separate.empty()) return separate(context);
    OutputFolder folder(context, {"design.sto"});
    Summary summary(context);
    bio::Model model = readModel(typed_.model, summary);
    chooseCoordinates(typed_.simulation, model, {typed_.trial}, false, typed_.observe);
    model = withSetParameters(std::move(model), typed_.simulation, summary);
    const bio::MusculoskeletalSystem system =
        movableSystem(model, typed_.model, typed_.simulation, summary);
    const TrialInput input =
        readTrialInput(typed_.trial, model, system, typed_.simulation, summary);
    const bio::ParameterCatalogue catalogue(model, system, {input.start.q, {}});
    const bio::SimulationOptions simulation = input.recorded.simulation;
    const bio::ExperimentDesign design(
        system, catalogue, catalogue.nominal(), input.trial, simulation,
        question(catalogue, designOutputs(typed_, model, system)), designLimits(typed_, system),
        bio::muscleGroups(system, input.start.q, typed_.excite), typed_.knots);
    bio::DesignResult result;
    search(context, [&] { result = design.search(typed_.settings); });
    folder.writeFile("design.sto", [&](const std::filesystem::path& path) {
      bio::writeTable(bio::plannedTable(system, result.after.trial), path);
    });
    DesignFindings findings{typed_.model, typed_.trial, model, design, result, {}, {}};
    if (folder.active())
      findings.playback = designPlayback(findings, systemOptions(typed_.simulation).wrapAsCylinder);
    for (const auto* list : {&design.question().parameters, &design.question().nuisance}) {
      for (const std::size_t index : *list) {
        findings.parameters.push_back(catalogue.parameters()[index]);
      }
    }
    if (typed_.monteCarlo > 0 && !result.stopped) {
      findings.monteCarlo = simulated(context, catalogue, simulation, design, result.after);
    }
    summary.setSimulation(typed_.simulation.integrator, simulation.step, input.trial.duration(),
                          result.after.motion.wallSeconds);
    tellDesign(findings, summary);
    sayDesign(findings, typed_, summary.methods());
    deliver(context, summary, designReport(findings), folder);
    if (result.stopped) throw Interrupted{};
    return result.improved ? ExitStatus::done : ExitStatus::answerIsNo;
  }

 private:
  template <class Search>
  void search(const CommandContext& context, const Search& run) {
    ProgressBar bar("design");
    typed_.settings.seed = context.seed;
    typed_.settings.threads = context.threads;
    typed_.settings.progress = [&](double done) {
      if (interruptionRequested()) return false;
      bar.update(done);
      return true;
    };
    run();
  }

  ExitStatus separate(const CommandContext& context) {
    OutputFolder folder(context, {"design.sto"});
    Summary summary(context);
    bio::Model model = readModel(typed_.model, summary);
    chooseCoordinates(typed_.simulation, model, {typed_.trial}, false, typed_.observe);
    model = withSetParameters(std::move(model), typed_.simulation, summary);
    const bio::MusculoskeletalSystem system =
        movableSystem(model, typed_.model, typed_.simulation, summary);
    summary.addInput(typed_.trial);
    const bio::Trial trial =
        readTrialFile(typed_.trial, model, typed_.simulation, {.experimentalConditions = true});
    for (const std::string& warning : trial.warnings) summary.warn(warning);
    bio::discover::SeparationQuestion question;
    question.first = typed_.separate[0];
    question.second = typed_.separate[1];
    question = bio::discover::withSizes(question, byName(assignments(typed_.sizes)));
    const Eigen::VectorXd start =
        bio::startCoordinates(trial, system, byName(typed_.simulation.initial));
    for (Eigen::Index i = 0; i < start.size(); ++i) {
      question.start[system.skeleton().coordinates()[static_cast<std::size_t>(i)].name] = start[i];
    }
    question.observed = designOutputs(typed_, model, system);
    question.period = 1 / typed_.rate_Hz;
    const double duration = trial.duration();
    bio::discover::MusculoskeletalProblemOptions options;
    options.simulation = simulationOptions(typed_.simulation, trial.times[0], duration);
    const bio::discover::SeparatingDesign design(
        model, systemOptions(typed_.simulation), trial, options, question,
        designLimits(typed_, system),
        bio::muscleGroups(system, system.skeleton().defaultValues(), typed_.excite), typed_.knots);
    bio::discover::SeparatingResult result;
    const auto begin = std::chrono::steady_clock::now();
    search(context, [&] { result = design.search(typed_.settings); });
    const double wall =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    SeparatingFindings findings{typed_.model, typed_.trial, model, design, result};
    if (folder.active())
      findings.playback =
          separatingPlayback(findings, systemOptions(typed_.simulation), options.simulation);
    folder.writeFile("design.sto", [&](const std::filesystem::path& path) {
      bio::writeTable(bio::plannedTable(system, result.after.trial), path);
    });
    summary.setSimulation(typed_.simulation.integrator, options.simulation.step, duration, wall);
    tellSeparation(findings, summary);
    sayExcitations(system, summary.methods());
    saySeparation(findings, typed_, summary.methods());
    deliver(context, summary, separatingReport(findings), folder);
    if (result.stopped) throw Interrupted{};
    return result.improved ? ExitStatus::done : ExitStatus::answerIsNo;
  }

  static std::vector<Assignment> assignments(const std::vector<std::string>& texts) {
    std::vector<Assignment> all;
    for (const std::string& text : texts) all.push_back(parseAssignment(text));
    return all;
  }

  bio::DesignQuestion question(const bio::ParameterCatalogue& catalogue,
                               std::vector<bio::ChannelCandidate> observed) const {
    bio::DesignQuestion question;
    question.observed = std::move(observed);
    question.period = 1 / typed_.rate_Hz;
    question.criterion = bio::optimalityNamed(typed_.criterion);
    return bio::designQuestion(catalogue,
                               {typed_.parameters, typed_.nuisance, typed_.priors,
                                byName(assignments(typed_.givenPriors))},
                               std::move(question));
  }

  info::MonteCarloResult simulated(const CommandContext& context,
                                   const bio::ParameterCatalogue& catalogue,
                                   const bio::SimulationOptions& simulation,
                                   const bio::ExperimentDesign& design,
                                   const bio::DesignedExperiment& after) const {
    info::MonteCarloOptions options;
    options.trials = typed_.monteCarlo;
    options.seed = context.seed;
    options.threads = context.threads;
    ProgressBar bar("monte carlo");
    options.progress = [&](int done, int trials) {
      bar.update(static_cast<double>(done) / trials);
      return true;
    };
    return bio::simulatedRepetitions(design, after, catalogue, systemOptions(typed_.simulation),
                                     simulation, options);
  }

  DesignOptions typed_;
};

}  // namespace

/// `fisherhill design MODEL TRIAL`: finds the experiment that is most informative about chosen
/// parameters.
std::unique_ptr<Command> designCommand() {
  return std::make_unique<Design>();
}

}  // namespace app
