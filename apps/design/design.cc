#include "design/design.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <sstream>

#include "bio/analysis/replay.h"
#include "bio/calibration/trial_predictor.h"
#include "bio/design/separating_design.h"
#include "design/design_report.h"
#include "design/dynamometer_design.h"
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

  void addOptions(CLI::App& options) override {
    addModelArgument(options, model_);
    options
        .add_option("TRIAL", trial_,
                    "baseline trial to improve on: excitations, duration, initial state; required "
                    "unless --dynamometer is given")
        ->check(CLI::ExistingFile)
        ->type_name("");
    const auto names = [&](const std::string& name, std::vector<std::string>& target,
                           const std::string& description) {
      return options.add_option(name, target, description)
          ->delimiter(',')
          ->allow_extra_args(false)
          ->type_name("NAMES");
    };
    names("--parameters", parameters_,
          "parameters of interest; sensitivity --list-parameters lists the choices");
    names(
        "--separate", separate_,
        "instead of --parameters: two effects of discover's catalogue, by id; find the experiment "
        "that best discriminates between them, given the default uncertainty of every parameter");
    options
        .add_option("--size", sizes_,
                    "with --separate: assumed size of an effect, in its unit; default: its prior "
                    "standard deviation")
        ->type_name("ID=SIZE")
        ->allow_extra_args(false);
    names(
        "--nuisance", nuisance_,
        "further unknown parameters, with their default priors; the bounds take them into account");
    options.add_flag("--priors", priors_, "use the default priors for the --parameters as well");
    options
        .add_option("--prior", givenPriors_,
                    "prior standard deviation of a parameter, in its unit; may be repeated")
        ->type_name("NAME=DEVIATION")
        ->allow_extra_args(false);
    options
        .add_option("--criterion", criterion_,
                    "design criterion, parameters scaled by their default prior standard "
                    "deviations; E: minimise the largest variance of any combination; A: the sum "
                    "of variances; D: the volume of the confidence ellipsoid")
        ->check(CLI::IsMember({"E", "A", "D"}))
        ->capture_default_str();
    const auto number = [&](const std::string& name, double& target, const std::string& unit,
                            const std::string& description) {
      options.add_option(name, target, description)->type_name(unit)->capture_default_str();
    };
    number("--noise", noise_deg_, "DEGREES", "standard deviation of the measured angle");
    number("--rate", rate_Hz_, "HZ", "measurement rate");
    number("--torque", limits_.torque, "NM", "largest external torque; 0: none");
    number("--torque-rate", limits_.torqueRate, "NM/S", "how fast it may change");
    names("--excite", excite_,
          "muscles whose excitations are designed: flexors, extensors, or names; BRA+BRD share one "
          "excitation")
        ->type_name("GROUPS");
    number("--excitation-max", limits_.largestExcitation, "0-1", "largest excitation of a group");
    number("--excitation-rate", limits_.excitationRate, "1/S", "how fast it may change");
    options
        .add_option("--range", range_,
                    "range to which the coordinate is limited, as 10deg,120deg; default: its range "
                    "in the model")
        ->delimiter(',')
        ->expected(2)
        ->type_name("LOW,HIGH");
    number("--speed", speed_deg_, "DEG/S", "largest speed of the coordinate");
    number("--surprise", limits_.surprise, "K",
           "respect the range even if the parameters are K prior standard deviations off");
    number("--knots", knots_, "SECONDS",
           "interval between the knots of the piecewise linear inputs");
    const auto count = [&](const std::string& name, int& target, const std::string& description) {
      options.add_option(name, target, description)
          ->check(CLI::Range(0, 1000000))
          ->type_name("N")
          ->capture_default_str();
    };
    count("--candidates", settings_.candidates, "number of random initial designs");
    count("--generations", settings_.generations,
          "generations of the evolution strategy that starts from the best of them");
    count("--iterations", settings_.iterations, "iterations of the final gradient search");
    count("--monte-carlo", monteCarlo_,
          "number of simulated and estimated repetitions of the designed experiment, to confirm "
          "the bounds");
    addDynamometerOptions(options, dynamometer_);
    addSimulationOptions(options, simulation_);
  }

  ExitStatus run(const CommandContext& context) override {
    check();
    if (!dynamometer_.coordinate.empty()) {
      return designOnDynamometer(context, model_, parameters_, nuisance_, dynamometer_, rate_Hz_,
                                 simulation_);
    }
    if (!separate_.empty()) return separate(context);
    OutputFolder folder(context, {"design.sto"});
    Summary summary(context);
    const bio::Model model = readModel(model_, summary);
    chooseCoordinates(simulation_, model, {trial_});
    const bio::MusculoskeletalSystem arm = movableSystem(model, model_, simulation_, summary);
    const TrialInput input = readTrialInput(trial_, model, arm, simulation_, summary);
    const bio::ParameterCatalogue catalogue(model, arm, {input.start.q, {}});
    const bio::Coordinate& coordinate = rotationOf(arm);
    const bio::SimulationOptions simulation =
        simulationOptions(simulation_, input.startTime, input.duration);
    const bio::ExperimentDesign design(arm, catalogue, catalogue.nominal(), input.trial, simulation,
                                       question(catalogue, coordinate), limits(coordinate),
                                       groups(arm, input.start.q), knots_);
    bio::DesignResult result;
    search(context, [&] { result = design.search(settings_); });
    folder.writeFile("design.sto", [&](const std::filesystem::path& path) {
      bio::writeTable(bio::designTable(arm, result.after, coordinate.name), path);
    });
    DesignFindings findings{model_, trial_, design, result, coordinate, {}, {}};
    for (const auto* list : {&design.question().parameters, &design.question().nuisance}) {
      for (const std::size_t index : *list) {
        findings.parameters.push_back(catalogue.parameters()[index]);
      }
    }
    if (monteCarlo_ > 0 && !result.stopped) {
      findings.monteCarlo = simulated(context, catalogue, simulation, design, result.after);
    }
    summary.setSimulation(simulation_.integrator, simulation.step, input.duration,
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
    settings_.seed = context.seed;
    settings_.threads = context.threads;
    settings_.progress = [&](double done) {
      if (interruptionRequested()) return false;
      bar.update(done);
      return true;
    };
    run();
  }

  ExitStatus separate(const CommandContext& context) {
    OutputFolder folder(context, {"design.sto"});
    Summary summary(context);
    const bio::Model model = readModel(model_, summary);
    chooseCoordinates(simulation_, model, {trial_});
    const bio::MusculoskeletalSystem arm = movableSystem(model, model_, simulation_, summary);
    summary.addInput(trial_);
    const bio::Trial trial =
        readTrialFile(trial_, model, simulation_, {.experimentalConditions = true});
    for (const std::string& warning : trial.warnings) summary.warn(warning);
    const bio::Coordinate& coordinate = rotationOf(arm);
    bio::discover::SeparationQuestion question;
    question.first = separate_[0];
    question.second = separate_[1];
    for (const std::string& text : sizes_) {
      const Assignment size = parseAssignment(text);
      if (size.name != question.first && size.name != question.second) {
        throw std::invalid_argument(
            fmt::format("--size: '{}' is not one of --separate", size.name));
      }
      if (size.value == 0) throw std::invalid_argument("--size: " + text + ", must not be 0");
      (size.name == question.first ? question.firstSize : question.secondSize) = size.value;
    }
    question.start = bio::startCoordinates(trial, arm, byName(simulation_.initial))[0];
    question.noise = noise_deg_ * degree;
    question.period = 1 / rate_Hz_;
    const double duration = trial.duration();
    bio::discover::MusculoskeletalProblemOptions options;
    options.simulation = simulationOptions(simulation_, trial.times[0], duration);
    const bio::discover::SeparatingDesign design(
        model, armOptions(simulation_), coordinate.name, trial, options, question,
        limits(coordinate), groups(arm, arm.skeleton().defaultValues()), knots_);
    bio::discover::SeparatingResult result;
    const auto begin = std::chrono::steady_clock::now();
    search(context, [&] { result = design.search(settings_); });
    const double wall =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const SeparatingFindings findings{model_, trial_, design, result, coordinate};
    folder.writeFile("design.sto", [&](const std::filesystem::path& path) {
      bio::writeTable(separatingTable(findings), path);
    });
    summary.setSimulation(simulation_.integrator, options.simulation.step, duration, wall);
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

  void check() const {
    if (trial_.empty() == dynamometer_.coordinate.empty()) {
      throw std::invalid_argument("either TRIAL or --dynamometer is required, and not both");
    }
    if (trial_.empty() && (!separate_.empty() || priors_ || !givenPriors_.empty() ||
                           monteCarlo_ > 0 || !excite_.empty() || !range_.empty())) {
      throw std::invalid_argument(
          "--separate, --priors, --prior, --monte-carlo, --excite and --range cannot be combined "
          "with --dynamometer");
    }
    if (parameters_.empty() == separate_.empty()) {
      throw std::invalid_argument(
          "either --parameters or --separate is required, and not both (see --help)");
    }
    if (!separate_.empty() && separate_.size() != 2) {
      throw std::invalid_argument(
          fmt::format("--separate: {} effects, must be two", separate_.size()));
    }
    if (!sizes_.empty() && separate_.empty()) {
      throw std::invalid_argument("--size requires --separate");
    }
    if (!separate_.empty() &&
        (!nuisance_.empty() || priors_ || !givenPriors_.empty() || monteCarlo_ > 0)) {
      throw std::invalid_argument(
          "--nuisance, --priors, --prior and --monte-carlo cannot be combined with --separate");
    }
    const auto positive = [](const char* name, double value, const char* unit) {
      if (!(value > 0 && std::isfinite(value))) {
        throw std::invalid_argument(fmt::format("{}: {} {}, must be > 0", name, value, unit));
      }
    };
    positive("--noise", noise_deg_, "deg");
    positive("--rate", rate_Hz_, "Hz");
    positive("--torque-rate", limits_.torqueRate, "N·m/s");
    positive("--excitation-rate", limits_.excitationRate, "1/s");
    positive("--speed", speed_deg_, "deg/s");
    positive("--knots", knots_, "s");
    if (!(limits_.torque >= 0 && std::isfinite(limits_.torque))) {
      throw std::invalid_argument(fmt::format("--torque: {} N·m, must be ≥ 0", limits_.torque));
    }
    if (!(limits_.surprise >= 0 && std::isfinite(limits_.surprise))) {
      throw std::invalid_argument(fmt::format("--surprise: {}, must be ≥ 0", limits_.surprise));
    }
    if (!(limits_.largestExcitation > limits_.leastExcitation && limits_.largestExcitation <= 1)) {
      throw std::invalid_argument(
          fmt::format("--excitation-max: {}, must be above {} and at most 1",
                      limits_.largestExcitation, limits_.leastExcitation));
    }
    if (limits_.torque == 0 && excite_.empty()) {
      throw std::invalid_argument("--torque 0 without --excite leaves nothing to change");
    }
    if (!simulation_.integrator.starts_with("vi")) {
      throw std::invalid_argument(
          fmt::format("--integrator {}: must be vi or vi-left, which alone have sensitivities",
                      simulation_.integrator));
    }
    if (monteCarlo_ > 0 && !nuisance_.empty()) {
      throw std::invalid_argument("--monte-carlo cannot be combined with --nuisance");
    }
  }

  bio::DesignQuestion question(const bio::ParameterCatalogue& catalogue,
                               const bio::Coordinate& coordinate) const {
    bio::DesignQuestion q;
    q.coordinate = coordinate.name;
    q.noise = noise_deg_ * degree;
    q.period = 1 / rate_Hz_;
    q.parameters = catalogue.select(parameters_);
    if (!nuisance_.empty()) q.nuisance = catalogue.select(nuisance_);
    // a pattern among the nuisance parameters may take in what is asked for
    std::erase_if(q.nuisance, [&](std::size_t index) {
      return std::find(q.parameters.begin(), q.parameters.end(), index) != q.parameters.end();
    });
    q.criterion = criterion_ == "A"   ? info::Optimality::a
                  : criterion_ == "D" ? info::Optimality::d
                                      : info::Optimality::e;
    std::vector<std::size_t> all = q.parameters;
    all.insert(all.end(), q.nuisance.begin(), q.nuisance.end());
    q.priorSd = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(all.size()),
                                          std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (priors_ || i >= q.parameters.size()) {
        q.priorSd[static_cast<Eigen::Index>(i)] = catalogue.parameters()[all[i]].sd;
      }
    }
    for (const std::string& text : givenPriors_) {
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
    bio::DesignLimits result = limits_;
    result.lower = coordinate.rangeMin;
    result.upper = coordinate.rangeMax;
    result.speed = speed_deg_ * degree;
    if (!range_.empty()) {
      try {
        result.lower = parseAngle(range_[0]);
        result.upper = parseAngle(range_[1]);
      } catch (const std::invalid_argument& error) {
        throw std::invalid_argument(fmt::format("--range: {}", error.what()));
      }
      if (!(result.lower < result.upper)) {
        throw std::invalid_argument(
            fmt::format("--range: {} to {}, must rise", range_[0], range_[1]));
      }
    }
    return result;
  }

  std::vector<bio::MuscleGroup> groups(const bio::MusculoskeletalSystem& arm,
                                       const Eigen::VectorXd& q) const {
    std::vector<bio::MuscleGroup> result;
    for (const std::string& text : excite_) {
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
        catalogue, armOptions(simulation_), after.excitation, q.coordinate,
        {after.measuredTimes.begin(), after.measuredTimes.end()}, q.parameters, simulation);
    info::MonteCarloOptions options;
    options.trials = monteCarlo_;
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

  std::string model_, trial_, criterion_ = "E";
  std::vector<std::string> parameters_, nuisance_, givenPriors_, excite_, range_, separate_, sizes_;
  bool priors_ = false;
  double noise_deg_ = 0.5, rate_Hz_ = 100, speed_deg_ = 500, knots_ = 0.3;
  bio::DesignLimits limits_ = {};
  bio::DesignSearchSettings settings_ = {};
  int monteCarlo_ = 0;
  DynamometerOptions dynamometer_;
  SimulationOptions simulation_;
};

}  // namespace

std::unique_ptr<Command> designCommand() {
  return std::make_unique<Design>();
}

}  // namespace app
