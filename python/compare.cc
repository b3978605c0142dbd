#include "bio/analysis/compare.h"

#include <fmt/format.h>

#include "arguments/columns.h"
#include "arguments/file_name.h"
#include "bio/analysis/compare_muscles.h"
#include "bio/analysis/coordinate_curve.h"
#include "bio/analysis/replay.h"
#include "bio/model/units.h"
#include "bio/opensim/external_loads.h"
#include "bio/simulation/integrator_names.h"
#include "docstrings.h"
#include "interruptible.h"
#include "systems.h"

namespace python {
namespace {

/// A table of states, or times [s] and values [rad].
using OtherMotion = std::variant<FileName, std::pair<py::object, py::object>>;

/// Another motion with numbers of C++: a thread beside Python may read it.
using KnownMotion = std::variant<FileName, bio::CoordinateCurve>;

std::map<std::string, KnownMotion> motionsOf(const std::map<std::string, OtherMotion>& also) {
  std::map<std::string, KnownMotion> motions;
  for (const auto& [name, motion] : also) {
    if (const auto* file = std::get_if<FileName>(&motion)) {
      motions[name] = *file;
      continue;
    }
    const auto& given = std::get<1>(motion);
    const Eigen::VectorXd times = columnOf(given.first, fmt::format("also: times of '{}'", name));
    const Eigen::VectorXd values =
        columnOf(given.second, fmt::format("also: values of '{}'", name));
    if (times.size() != values.size()) {
      throw std::invalid_argument(
          fmt::format("also: '{}' has {} times and {} values, must be equal", name, times.size(),
                      values.size()));
    }
    motions[name] =
        bio::CoordinateCurve{{times.begin(), times.end()}, {values.begin(), values.end()}};
  }
  return motions;
}

bio::CoordinateCurve curveOf(const KnownMotion& motion, const bio::Coordinate& coordinate) {
  if (const auto* file = std::get_if<FileName>(&motion)) {
    return bio::readCoordinate(file->text, coordinate);
  }
  return std::get<bio::CoordinateCurve>(motion);
}

/// Curves of the coordinate by which motions are compared, the first that turns; null: none does.
struct OtherCurves {
  const bio::Coordinate* coordinate = nullptr;
  std::map<std::string, bio::CoordinateCurve> curves = {};

  OtherCurves(const std::map<std::string, KnownMotion>& also,
              const bio::MusculoskeletalSystem& system) {
    for (const bio::Coordinate& one : system.skeleton().coordinates()) {
      if (one.isRotation && coordinate == nullptr) coordinate = &one;
    }
    if (coordinate == nullptr) return;
    for (const auto& [name, motion] : also) curves[name] = curveOf(motion, *coordinate);
  }

  /// RMS differences from the reference [rad]; NaN without a reference.
  std::map<std::string, double> rms(const bio::MusculoskeletalSystem& system,
                                    const bio::ConvergedReference& reference) const {
    std::map<std::string, double> differences;
    for (const auto& [name, curve] : curves) {
      differences[name] =
          reference.completed()
              ? bio::rmsDifference(system, curve, reference.motion, coordinate->name)
              : std::numeric_limits<double>::quiet_NaN();
    }
    return differences;
  }
};

/// Ends a comparison early; interruptible() drops it.
struct Stopped : std::exception {};

/// A progress callback that ends the work after Ctrl-C.
auto stoppable(const std::atomic<bool>& goOn) {
  return [&goOn](double) {
    if (!goOn) throw Stopped();
  };
}

/// The system and what a trial makes of it.
struct PreparedTrial {
  bio::MusculoskeletalSystem system;
  bio::RecordedTrial recorded;
  bio::StartPoint start;
};

PreparedTrial prepared(const bio::Model& model, const bio::Trial& trial, const SystemChoice& choice,
                       const std::map<std::string, double>& initial) {
  if (choice.coordinates.empty()) {
    throw std::invalid_argument("no coordinate is free to be compared: all are prescribed");
  }
  mustBeOfTheModelAsItIs(trial);
  bio::requireLoadsCover(model.externalLoads, trial.times[0], trial.times[0] + trial.duration());
  bio::MusculoskeletalSystem system(model, choice.systemOptions());
  bio::RecordedTrial recorded =
      bio::recordedTrial(trial, system, during(trial, choice.simulation()));
  bio::StartPoint start = bio::beginningOf(trial, model, system, initial).point;
  return {std::move(system), std::move(recorded), std::move(start)};
}

py::array_t<double> arrayOf(const std::vector<double>& values) {
  return py::array_t<double>(py::cast(values));
}

py::object referenceOf(const bio::ConvergedReference& reference) {
  const char* status = !reference.completed()  ? "failed"
                       : reference.confirmed() ? "confirmed"
                                               : "disputed";
  return results("status"_a = status,
                 "why"_a = reference.completed() ? reference.whyDisputed : reference.motion.why,
                 "time"_a = arrayOf(reference.motion.time),
                 "q"_a = reference.motion.q.transpose().eval(),
                 "relative_tolerance"_a = reference.relativeTolerance,
                 "looser_tolerance"_a = reference.looserTolerance,
                 "disagreement_rms"_a = reference.problem.rms,
                 "disagreement_max"_a = reference.problem.largest,
                 "interpolation_rms"_a = reference.interpolationError,
                 "second_step"_a = reference.secondStep, "second_rms"_a = reference.second.rms);
}

py::object cellOf(const bio::CompareCell& cell) {
  return results("integrator"_a = bio::name(cell.integrator), "step"_a = cell.step,
                 "outcome"_a = bio::name(cell.outcome), "why"_a = cell.why,
                 "failed_at"_a = cell.failedAt, "rms_error"_a = cell.error.rms,
                 "max_error"_a = cell.error.largest, "max_error_at"_a = cell.error.largestAt,
                 "wall"_a = cell.wallSeconds, "newton_per_step"_a = cell.newtonPerStep,
                 "halved_steps"_a = cell.halvedSteps, "energy_error"_a = cell.energyError,
                 "time"_a = arrayOf(cell.time), "q"_a = cell.q.transpose().eval());
}

py::object comparisonOf(const bio::Comparison& comparison, const bio::MusculoskeletalSystem& system,
                        const bio::CompareOptions& options, const OtherCurves& others) {
  py::list cells;
  for (const bio::CompareCell& cell : comparison.cells) cells.append(cellOf(cell));
  py::dict limits, orders;
  for (const bio::StepLimit& limit : comparison.limits) {
    limits[bio::name(limit.integrator)] =
        results("stable"_a = limit.stable, "failing"_a = limit.failing, "why"_a = limit.why);
  }
  for (const bio::ObservedOrder& order : comparison.orders) {
    orders[bio::name(order.integrator)] =
        results("order"_a = order.order, "steps"_a = arrayOf(order.steps),
                "errors"_a = arrayOf(order.errors));
  }
  std::vector<std::string> coordinates, warnings = system.warnings();
  for (const auto& coordinate : system.skeleton().coordinates())
    coordinates.push_back(coordinate.name);
  if (const auto left = bio::leftRange(system, comparison.reference.motion)) {
    warnings.push_back(left->what);
  }
  return tableResult("CompareResult", "coordinates"_a = coordinates,
                     "reference"_a = referenceOf(comparison.reference), "runs"_a = cells,
                     "largest_stable_step"_a = limits, "observed_order"_a = orders,
                     "also"_a = others.rms(system, comparison.reference),
                     "stable_means_rms_below"_a = options.usefulError, "warnings"_a = warnings);
}

py::object compare(const bio::Model& model, const bio::Trial& trial,
                   const std::vector<std::string>& integrators, const std::vector<double>& steps,
                   int timings, const std::map<std::string, OtherMotion>& also,
                   const std::map<std::string, double>& initial, const Names& coordinate,
                   const std::map<std::string, double>& lock) {
  const SystemChoice choice = systemChoice(model, {trial}, coordinate, lock, "vi", {});
  bio::CompareOptions options;
  options.integrators.clear();
  for (const std::string& name : integrators) {
    const auto found = bio::integratorNamed(name);
    if (!found) {
      throw std::invalid_argument(
          fmt::format("integrators: '{}', must be rk4, vi, vi-left, vi-adaptive or cvode", name));
    }
    options.integrators.push_back(*found);
  }
  options.steps = steps;
  options.timings = timings;
  std::optional<PreparedTrial> at;
  std::optional<OtherCurves> others;
  bio::Comparison comparison;
  const std::map<std::string, KnownMotion> motions = motionsOf(also);
  interruptible([&](const std::atomic<bool>& goOn) {
    at.emplace(prepared(model, trial, choice, initial));
    others.emplace(motions, at->system);
    const bio::SimulationOptions& recorded = at->recorded.simulation;
    options.startTime = recorded.startTime;
    options.duration = recorded.duration;
    options.externalForce = recorded.externalForce;
    options.prescribed = recorded.prescribed;
    options.progress = stoppable(goOn);
    comparison = bio::compareIntegrators(at->system, at->recorded.excitation,
                                         at->recorded.startAt(at->system, at->start), options);
  });
  return comparisonOf(comparison, at->system, options, *others);
}

py::object classOf(const bio::MuscleClassMotion& motion) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const bool isThere = motion.motion.outcome == bio::Outcome::completed;
  py::dict bounds;
  for (std::size_t i = 0; i < motion.information.parameters.size(); ++i) {
    const info::Parameter& p = motion.information.parameters[i];
    bounds[p.name.c_str()] =
        results("value"_a = p.start, "unit"_a = p.unit,
                "sd"_a = motion.information.boundJoint[static_cast<Eigen::Index>(i)]);
  }
  return results("name"_a = motion.name, "outcome"_a = bio::name(motion.motion.outcome),
                 "why"_a = motion.motion.why, "lost"_a = motion.lost,
                 "rms"_a = isThere ? motion.difference.rms : nan,
                 "max"_a = isThere ? motion.difference.largest : nan,
                 "max_at"_a = isThere ? motion.difference.largestAt : nan,
                 "measured_rms"_a = isThere ? motion.measured : nan,
                 "unexplained_rms"_a = isThere ? motion.unexplained : nan,
                 "determined_combinations"_a = motion.information.determinedCombinations,
                 "bounds"_a = bounds, "wall"_a = isThere ? motion.motion.wallSeconds : nan,
                 "energy_error"_a = isThere ? motion.energyError : nan,
                 "time"_a = arrayOf(motion.motion.time),
                 "q"_a = motion.motion.q.transpose().eval());
}

py::object compareMuscles(const bio::Model& model, const bio::Trial& trial,
                          const std::vector<std::string>& classes, double noise,
                          const std::map<std::string, double>& initial, const Names& coordinate,
                          const std::map<std::string, double>& lock, const std::string& integrator,
                          std::optional<double> step) {
  const SystemChoice choice = systemChoice(model, {trial}, coordinate, lock, integrator, step);
  const auto known = bio::integratorNamed(integrator);
  if (!known || !bio::isVariational(*known)) {
    throw std::invalid_argument(
        fmt::format("integrator '{}', must be vi-adaptive, vi or vi-left, which have sensitivities",
                    integrator));
  }
  std::vector<bio::MuscleClassMotion> found;
  interruptible([&](const std::atomic<bool>& goOn) {
    const PreparedTrial at = prepared(model, trial, choice, initial);
    const std::string& measured = choice.coordinates.front();
    found = bio::compareMuscleClasses(
        model, choice.systemOptions(), classes,
        {.recorded = at.recorded,
         .start = at.start,
         .coordinate = measured,
         .times = bio::observedTimes(trial, measured, at.recorded.simulation.step),
         .noise = noise,
         .progress = stoppable(goOn)});
  });
  py::list list;
  for (const bio::MuscleClassMotion& motion : found) list.append(classOf(motion));
  return tableOfRows(list);
}

}  // namespace

void defineComparisons(py::module_& module) {
  module.def("compare", &compare, docstrings::compare, "model"_a, "trial"_a, py::kw_only(),
             "integrators"_a = std::vector<std::string>{"rk4", "vi", "vi-left", "cvode"},
             "steps"_a = bio::CompareOptions().steps, "timings"_a = 5,
             "also"_a = std::map<std::string, OtherMotion>(),
             "initial"_a = std::map<std::string, double>(),
             "coordinate"_a = std::vector<std::string>(),
             "lock"_a = std::map<std::string, double>());
  defineWithChoice(
      module, "compare_muscles", &compareMuscles, docstrings::compare_muscles, "model"_a, "trial"_a,
      py::kw_only(),
      "classes"_a = std::vector<std::string>{"Schutte1993", "Thelen2003", "Millard2012",
                                             "DeGrooteFregly2016", "RigidTendon"},
      "noise"_a = bio::radiansPerDegree, "initial"_a = std::map<std::string, double>());
}

}  // namespace python
