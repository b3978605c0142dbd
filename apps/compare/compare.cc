#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bio/analysis/replay.h"
#include "bio/model/units.h"
#include "bio/simulation/integrator_names.h"
#include "command/command.h"
#include "compare/compare_methods.h"
#include "compare/compare_muscles_report.h"
#include "compare/compare_report.h"
#include "options/set_parameters.h"
#include "options/system_options.h"
#include "options/trial_input.h"
#include "output/progress_bar.h"
#include "output/text.h"
#include "report/figure_files.h"
#include "report/result.h"

namespace app {
namespace {

class Compare : public Command {
 public:
  About about() const override {
    return {"compare", "Compare integrators over time steps: error, run time, and how each fails",
            "fisherhill compare models/elbow8.osim emg_data/curl_slow.sto --out out/compare"};
  }

  void addOptions(CLI::App& options) override {
    addModelArgument(options, model_);
    addTrialArgument(options, trial_);
    options
        .add_option("--integrators", integrators_,
                    "integrators to compare, of rk4, vi, vi-left, vi-adaptive, cvode")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("NAMES")
        ->default_str("rk4,vi,vi-left,cvode");
    options
        .add_option("--steps", steps_,
                    "time steps [s], in rising order; for cvode the interval of its output, for "
                    "vi-adaptive the longest step")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("SECONDS")
        ->default_str("0.0002,0.0003,0.0005,0.0008,0.001,0.002,0.005,0.01,0.02,0.05");
    options
        .add_option("--also", also_,
                    "another program's result to compare with: a table of states with the "
                    "coordinate; may be repeated")
        ->type_name("NAME=FILE")
        ->allow_extra_args(false);
    options
        .add_option("--muscles", classes_,
                    "compare classes of muscles instead of integrators: of Thelen2003, "
                    "Millard2012, DeGrooteFregly2016, Schutte1993, RigidTendon; \"all\": all five")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("CLASSES");
    options
        .add_option("--noise", noise_,
                    "with --muscles: standard deviation of the measured angle [deg] or "
                    "translation [mm]")
        ->check(CLI::PositiveNumber)
        ->type_name("DEGREES")
        ->capture_default_str();
    options.add_flag("--png", png_, "write the figures of the report as PNG files as well");
    addExternalLoadsOption(options, externalLoads_);
    addSimulationOptions(options, simulation_);
    addPrescribing(options, simulation_);
  }

  ExitStatus run(const CommandContext& context) override {
    if (png_) requireSvgConverter("--png");
    if (!classes_.empty()) return runMuscles(context);
    bio::CompareOptions options = compareOptions();
    OutputFolder folder(context, {"compare.csv"});
    Summary summary(context);
    bio::Model model = readModel(model_, summary);
    addExternalLoads(externalLoads_, model, summary);
    chooseCoordinates(simulation_, model, {trial_});
    requireFreeCoordinate(simulation_);
    model = withSetParameters(std::move(model), simulation_, summary);
    const bio::MusculoskeletalSystem system = movableSystem(model, model_, simulation_, summary);
    const TrialInput input = readTrialInput(trial_, model, system, simulation_, summary);
    const auto& free = system.skeleton().coordinates();
    const auto rotation =
        std::find_if(free.begin(), free.end(), [](const auto& c) { return c.isRotation; });
    if (rotation == free.end())
      throw std::invalid_argument("no free coordinate is a rotation, must have one");
    std::vector<AlsoCurve> also = readAlso(*rotation, summary);

    const bio::SimulationOptions& recorded = input.recorded.simulation;
    options.startTime = recorded.startTime;
    options.duration = recorded.duration;
    options.externalForce = recorded.externalForce;
    options.prescribed = recorded.prescribed;
    bio::Comparison comparison;
    {
      ProgressBar bar("compare");
      options.progress = [&](double done) { bar.update(done); };
      comparison = bio::compareIntegrators(system, input.recorded.excitation, input.start, options);
    }
    if (const auto left = bio::leftRange(system, comparison.reference.motion)) {
      summary.warn(left->what);
    }
    if (comparison.reference.completed()) {
      for (AlsoCurve& curve : also) {
        curve.rms =
            bio::rmsDifference(system, curve.curve, comparison.reference.motion, rotation->name);
      }
    }
    folder.write("compare.csv", [&](std::ostream& out) { writeCells(comparison, out); });

    const bio::CompareCell* chosen = chosenCell(comparison);
    const CompareFindings findings{model_,  trial_,     input.trial, system, *rotation,
                                   options, comparison, also,        chosen};
    if (chosen != nullptr) {
      summary.setSimulationFigures(bio::name(chosen->integrator), chosen->step, options.duration,
                                   chosen->wallSeconds);
    } else {
      summary.setSimulationFigures(simulation_.integrator, simulation_.stepOrDefault(),
                                   options.duration, comparison.reference.motion.wallSeconds);
    }
    sayComparison(findings, summary.methods());
    summary.set("start_from", bio::name(input.from));
    tellCompare(findings, summary);
    const Report report = compareReport(findings);
    if (png_) writeFigurePngs(report, folder);
    deliver(context, summary, report, folder);
    return comparison.reference.confirmed() ? ExitStatus::done : ExitStatus::answerIsNo;
  }

 private:
  /// The model as it is and with its muscles of each class.
  ExitStatus runMuscles(const CommandContext& context) {
    if (!integrators_.empty() || !steps_.empty() || !also_.empty()) {
      throw std::invalid_argument("--muscles excludes --integrators, --steps and --also");
    }
    if (!simulation_.isVariational()) {
      throw std::invalid_argument(
          fmt::format("--integrator {}: must be vi-adaptive, vi or vi-left with --muscles",
                      simulation_.integrator));
    }
    if (classes_.size() == 1 && classes_.front() == "all") {
      classes_ = {"Schutte1993", "Thelen2003", "Millard2012", "DeGrooteFregly2016", "RigidTendon"};
    }
    OutputFolder folder(context, {"muscles.csv", "muscle_bounds.csv"});
    Summary summary(context);
    bio::Model model = readModel(model_, summary);
    addExternalLoads(externalLoads_, model, summary);
    chooseCoordinates(simulation_, model, {trial_});
    requireFreeCoordinate(simulation_);
    model = withSetParameters(std::move(model), simulation_, summary);
    const bio::MusculoskeletalSystem system = movableSystem(model, model_, simulation_, summary);
    const TrialInput input = readTrialInput(trial_, model, system, simulation_, summary);
    const bio::Coordinate& coordinate = system.skeleton().coordinates().front();
    bio::MuscleClassTrial trial;
    trial.recorded = input.recorded;
    trial.start = {input.start.q, input.start.qDot};
    trial.coordinate = coordinate.name;
    trial.times = bio::observedTimes(input.trial, coordinate.name, input.recorded.simulation.step);
    trial.noise = noise_ * (coordinate.isRotation ? bio::radiansPerDegree : 1e-3);
    std::vector<bio::MuscleClassMotion> classes;
    {
      ProgressBar bar("compare");
      trial.progress = [&](double done) { bar.update(done); };
      classes = bio::compareMuscleClasses(model, systemOptions(simulation_), classes_, trial);
    }
    if (const auto left = bio::leftRange(system, classes.front().motion)) summary.warn(left->what);
    const MuscleFindings findings{model_, trial_, coordinate, classes, trial.noise};
    folder.write("muscles.csv", [&](std::ostream& out) { writeMuscleClasses(findings, out); });
    folder.write("muscle_bounds.csv", [&](std::ostream& out) { writeMuscleBounds(findings, out); });
    summary.setSimulation(simulation_.integrator, trial.recorded.simulation.step,
                          input.recorded.simulation.duration, classes.front().motion.wallSeconds);
    summary.set("start_from", bio::name(input.from));
    tellMuscles(findings, summary);
    sayMuscleClasses(findings, summary.methods());
    const Report report = musclesReport(findings);
    if (png_) writeFigurePngs(report, folder);
    deliver(context, summary, report, folder);
    const bool isFine = std::all_of(classes.begin(), classes.end(), [](const auto& muscles) {
      return muscles.motion.outcome == bio::Outcome::completed;
    });
    return isFine ? ExitStatus::done : ExitStatus::answerIsNo;
  }

  /// The typed lists; --step joins the steps.
  bio::CompareOptions compareOptions() const {
    bio::CompareOptions options;
    if (!integrators_.empty()) {
      options.integrators.clear();
      for (const std::string& name : integrators_) {
        if (name.empty())
          throw std::invalid_argument("--integrators: the list is empty, must name at least one");
        options.integrators.push_back(integratorNamed(name));
      }
    }
    if (!steps_.empty()) {
      options.steps.clear();
      for (const std::string& text : steps_) {
        if (text.empty())
          throw std::invalid_argument("--steps: the list is empty, must have at least one");
        double step = 0;
        try {
          step = parseNumber(text);
        } catch (const std::invalid_argument& error) {
          throw std::invalid_argument(fmt::format("--steps: {}", error.what()));
        }
        if (!(step > 0)) {
          throw std::invalid_argument(fmt::format("--steps: {} s, must be > 0", text));
        }
        if (!options.steps.empty() && !(step > options.steps.back())) {
          throw std::invalid_argument(fmt::format("--steps: {} s after {} s, must rise", text,
                                                  numberText(options.steps.back())));
        }
        options.steps.push_back(step);
      }
    }
    if (simulation_.step) {
      const auto at =
          std::lower_bound(options.steps.begin(), options.steps.end(), *simulation_.step);
      if (at == options.steps.end() || *at != *simulation_.step) {
        options.steps.insert(at, *simulation_.step);
      }
    }
    return options;
  }

  static bio::Integrator integratorNamed(const std::string& name) {
    if (const auto found = bio::integratorNamed(name)) return *found;
    throw std::invalid_argument(
        fmt::format("--integrators: '{}', must be rk4, vi, vi-left, vi-adaptive or cvode", name));
  }

  std::vector<AlsoCurve> readAlso(const bio::Coordinate& coordinate, Summary& summary) const {
    std::vector<AlsoCurve> also;
    for (const std::string& text : also_) {
      const std::size_t sign = text.find('=');
      if (sign == 0 || sign == text.npos || sign + 1 == text.size()) {
        throw std::invalid_argument(fmt::format("--also: '{}' must be NAME=FILE", text));
      }
      const std::string file = text.substr(sign + 1);
      also.push_back({text.substr(0, sign), bio::readCoordinate(file, coordinate)});
      summary.addInput(file);
    }
    return also;
  }

  /// The run of --integrator, else of the first integrator, at the step nearest to --step.
  const bio::CompareCell* chosenCell(const bio::Comparison& comparison) const {
    const bio::CompareCell* best = nullptr;
    const auto distance = [&](const bio::CompareCell& cell) {
      return std::abs(std::log(cell.step / simulation_.stepOrDefault()));
    };
    const auto isAsked = [&](const bio::CompareCell& cell) {
      return bio::name(cell.integrator) == simulation_.integrator;
    };
    for (const bio::CompareCell& cell : comparison.cells) {
      if (best == nullptr || (isAsked(cell) && !isAsked(*best)) ||
          (cell.integrator == best->integrator && distance(cell) < distance(*best))) {
        best = &cell;
      }
    }
    return best;
  }

  std::string model_;
  std::string trial_;
  std::vector<std::string> integrators_;
  std::vector<std::string> steps_;
  std::vector<std::string> also_;
  std::vector<std::string> classes_;  ///< of muscles; empty: integrators are compared
  double noise_ = 1;
  std::string externalLoads_;  ///< empty: none
  bool png_ = false;
  SimulationOptions simulation_;
};

}  // namespace

/// `compare`: integrators at time steps, against a converged reference.
std::unique_ptr<Command> compareCommand() {
  return std::make_unique<Compare>();
}

}  // namespace app
