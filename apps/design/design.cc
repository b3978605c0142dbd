#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <sstream>

#include "bio/analysis/replay.h"
#include "bio/calibration/trial_predictor.h"
#include "bio/design/separating_design.h"
#include "command/command.h"
#include "design/design_options.h"
#include "design/design_report.h"
#include "design/separating_report.h"
#include "options/system_options.h"
#include "options/trial_input.h"
#include "output/angle_unit.h"
#include "output/interruption.h"
#include "output/progress_bar.h"
#include "output/result.h"

namespace app {
namespace {

/// "a+b" → a, b
std::vector<std::string> joinedByPlus(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, '+');) parts.push_back(part);
  return parts;
}

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
    const bio::Model model = readModel(typed_.model, summary);
    chooseCoordinates(typed_.simulation, model, {typed_.trial});
    const bio::MusculoskeletalSystem arm =
        movableSystem(model, typed_.model, typed_.simulation, summary);
    const TrialInput input = readTrialInput(typed_.trial, model, arm, typed_.simulation, summary);
    const bio::ParameterCatalogue catalogue(model, arm, {input.start.q, {}});
    const bio::Coordinate& coordinate = rotationOf(arm);
    const bio::SimulationOptions simulation =
        simulationOptions(typed_.simulation, input.startTime, input.duration);
    const bio::ExperimentDesign design(arm, catalogue, catalogue.nominal(), input.trial, simulation,
                                       question(catalogue, coordinate), limits(coordinate),
                                       groups(arm, input.start.q), typed_.knots);
    bio::DesignResult result;
    search(context, [&] { result = design.search(typed_.settings); });
    folder.writeFile("design.sto", [&](const std::filesystem::path& path) {
      bio::writeTable(bio::designTable(arm, result.after, coordinate.name), path);
    });
    DesignFindings findings{typed_.model, typed_.trial, design, result, coordinate, {}, {}};
    for (const auto* list : {&design.question().parameters, &design.question().nuisance}) {
      for (const std::size_t index : *list) {
        findings.parameters.push_back(catalogue.parameters()[index]);
      }
    }
    if (typed_.monteCarlo > 0 && !result.stopped) {
      findings.monteCarlo = simulated(context, catalogue, simulation, design, result.after);
    }
    summary.setSimulation(typed_.simulation.integrator, simulation.step, input.duration,
                          result.after.motion.wallSeconds);
    tellDesign(findings, summary);
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
    const bio::Model model = readModel(typed_.model, summary);
    chooseCoordinates(typed_.simulation, model, {typed_.trial});
    const bio::MusculoskeletalSystem arm =
        movableSystem(model, typed_.model, typed_.simulation, summary);
    summary.addInput(typed_.trial);
    const bio::Trial trial =
        readTrialFile(typed_.trial, model, typed_.simulation, {.experimentalConditions = true});
    for (const std::string& warning : trial.warnings) summary.warn(warning);
    const bio::Coordinate& coordinate = rotationOf(arm);
    bio::discover::SeparationQuestion question;
    question.first = typed_.separate[0];
    question.second = typed_.separate[1];
    for (const std::string& text : typed_.sizes) {
      const Assignment size = parseAssignment(text);
      if (size.name != question.first && size.name != question.second) {
        throw std::invalid_argument(
            fmt::format("--size: '{}' is not one of --separate", size.name));
      }
      if (size.value == 0) throw std::invalid_argument("--size: " + text + ", must not be 0");
      (size.name == question.first ? question.firstSize : question.secondSize) = size.value;
    }
    question.start = bio::startCoordinates(trial, arm, byName(typed_.simulation.initial))[0];
    question.noise = typed_.noise_deg * degree;
    question.period = 1 / typed_.rate_Hz;
    const double duration = trial.duration();
    bio::discover::MusculoskeletalProblemOptions options;
    options.simulation = simulationOptions(typed_.simulation, trial.times[0], duration);
    const bio::discover::SeparatingDesign design(
        model, armOptions(typed_.simulation), coordinate.name, trial, options, question,
        limits(coordinate), groups(arm, arm.skeleton().defaultValues()), typed_.knots);
    bio::discover::SeparatingResult result;
    const auto begin = std::chrono::steady_clock::now();
    search(context, [&] { result = design.search(typed_.settings); });
    const double wall =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const SeparatingFindings findings{typed_.model, typed_.trial, design, result, coordinate};
    folder.writeFile("design.sto", [&](const std::filesystem::path& path) {
      bio::writeTable(separatingTable(findings), path);
    });
    summary.setSimulation(typed_.simulation.integrator, options.simulation.step, duration, wall);
    tellSeparation(findings, summary);
    deliver(context, summary, separatingReport(findings), folder);
    if (result.stopped) throw Interrupted{};
    return result.improved ? ExitStatus::done : ExitStatus::answerIsNo;
  }

  static const bio::Coordinate& rotationOf(const bio::MusculoskeletalSystem& arm) {
    const bio::Coordinate& coordinate = arm.skeleton().coordinates().front();
    if (!coordinate.isRotation) {
      throw std::invalid_argument(
          fmt::format("--coordinate: '{}' must be a rotation", coordinate.name));
    }
    return coordinate;
  }

  bio::DesignQuestion question(const bio::ParameterCatalogue& catalogue,
                               const bio::Coordinate& coordinate) const {
    bio::DesignQuestion q;
    q.coordinate = coordinate.name;
    q.noise = typed_.noise_deg * degree;
    q.period = 1 / typed_.rate_Hz;
    q.parameters = catalogue.select(typed_.parameters);
    if (!typed_.nuisance.empty()) q.nuisance = catalogue.select(typed_.nuisance);
    // a pattern among the nuisance parameters may take in what is asked for
    std::erase_if(q.nuisance, [&](std::size_t index) {
      return std::find(q.parameters.begin(), q.parameters.end(), index) != q.parameters.end();
    });
    q.criterion = typed_.criterion == "A"   ? info::Optimality::a
                  : typed_.criterion == "D" ? info::Optimality::d
                                            : info::Optimality::e;
    std::vector<std::size_t> all = q.parameters;
    all.insert(all.end(), q.nuisance.begin(), q.nuisance.end());
    q.priorSd = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(all.size()),
                                          std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (typed_.priors || i >= q.parameters.size()) {
        q.priorSd[static_cast<Eigen::Index>(i)] = catalogue.parameters()[all[i]].sd;
      }
    }
    for (const std::string& text : typed_.givenPriors) {
      const Assignment prior = parseAssignment(text);
      const auto at = std::find(all.begin(), all.end(), catalogue.find(prior.name));
      if (at == all.end()) {
        throw std::invalid_argument(
            fmt::format("--prior: {} is in neither --parameters nor --nuisance", prior.name));
      }
      if (!(prior.value > 0)) {
        throw std::invalid_argument(
            fmt::format("--prior: {} = {}, must be > 0", prior.name, prior.value));
      }
      q.priorSd[at - all.begin()] = prior.value;
    }
    return q;
  }

  bio::DesignLimits limits(const bio::Coordinate& coordinate) const {
    bio::DesignLimits result = typed_.limits;
    result.lower = coordinate.rangeMin;
    result.upper = coordinate.rangeMax;
    result.speed = typed_.speed_deg * degree;
    if (!typed_.range.empty()) {
      try {
        result.lower = parseAngle(typed_.range[0]);
        result.upper = parseAngle(typed_.range[1]);
      } catch (const std::invalid_argument& error) {
        throw std::invalid_argument(fmt::format("--range: {}", error.what()));
      }
      if (!(result.lower < result.upper)) {
        throw std::invalid_argument(
            fmt::format("--range: {} to {}, must rise", typed_.range[0], typed_.range[1]));
      }
    }
    return result;
  }

  std::vector<bio::MuscleGroup> groups(const bio::MusculoskeletalSystem& arm,
                                       const Eigen::VectorXd& q) const {
    std::vector<bio::MuscleGroup> result;
    for (const std::string& text : typed_.excite) {
      const auto named = bio::flexorsAndExtensors(arm, q);
      const auto at = std::find_if(named.begin(), named.end(), [&](const bio::MuscleGroup& group) {
        return group.name == text;
      });
      result.push_back(at != named.end() ? *at : bio::MuscleGroup{text, joinedByPlus(text)});
    }
    return result;
  }

  info::MonteCarloResult simulated(const CommandContext& context,
                                   const bio::ParameterCatalogue& catalogue,
                                   bio::SimulationOptions simulation,
                                   const bio::ExperimentDesign& design,
                                   const bio::DesignedExperiment& after) const {
    const bio::DesignQuestion& q = design.question();
    simulation.externalForce = after.torque;
    const bio::TrialPredictor experiment(
        catalogue, armOptions(typed_.simulation), after.excitation, q.coordinate,
        {after.measuredTimes.begin(), after.measuredTimes.end()}, q.parameters, simulation);
    info::MonteCarloOptions options;
    options.trials = typed_.monteCarlo;
    options.seed = context.seed;
    options.threads = context.threads;
    options.startSpread = 0.0005;
    options.estimate.decrementTolerance = 1e-6;
    ProgressBar bar("monte carlo");
    options.progress = [&](int done, int trials) {
      bar.update(static_cast<double>(done) / trials);
      return true;
    };
    return info::monteCarlo(
        experiment.predictor(), catalogue.values(q.parameters),
        info::OutputCovariance(Eigen::MatrixXd::Constant(1, 1, q.noise * q.noise)),
        catalogue.asEstimated(q.parameters, false), options);
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
