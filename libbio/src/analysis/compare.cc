#include "bio/analysis/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "analysis/compare_runs.h"
#include "bio/model/units.h"

namespace bio {
namespace {

/// Rows of the reference: cubics between them are right to far below a microdegree.
constexpr double referenceInterval = 5e-4;  ///< [s]

std::vector<Eigen::Index> rotationsOf(const MusculoskeletalSystem& system) {
  std::vector<Eigen::Index> rotations;
  const auto& coordinates = system.skeleton().coordinates();
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    if (coordinates[i].isRotation) rotations.push_back(static_cast<Eigen::Index>(i));
  }
  if (rotations.empty())
    throw std::invalid_argument("no free coordinate is a rotation, must have one");
  return rotations;
}

/// Value at time t between columns k and k + 1: cubic through values and speeds.
double between(const Trajectory& motion, Eigen::Index row, std::size_t k, double t) {
  const auto c = static_cast<Eigen::Index>(k);
  const double h = motion.time[k + 1] - motion.time[k];
  const double s = (t - motion.time[k]) / h;
  const double a = motion.q(row, c);
  const double b = motion.q(row, c + 1);
  const double da = h * motion.qDot(row, c);
  const double db = h * motion.qDot(row, c + 1);
  return a + s * (da + s * (3 * (b - a) - 2 * da - db + s * (2 * (a - b) + da + db)));
}

/// Time of the first row that is further than `limit` [rad] from the reference.
double firstBeyond(const MusculoskeletalSystem& system, const Trajectory& motion,
                   const Trajectory& reference, double limit) {
  Trajectory row;
  for (std::size_t k = 0; k < motion.time.size(); ++k) {
    row.time = {motion.time[k]};
    row.q = motion.q.col(static_cast<Eigen::Index>(k));
    if (sd(system, row, reference).largest > limit) return motion.time[k];
  }
  return motion.time.back();
}

/// Every second row.
Trajectory thinned(const Trajectory& full) {
  Trajectory half;
  const Eigen::Index K = (full.q.cols() + 1) / 2;
  half.q.resize(full.q.rows(), K);
  half.qDot.resize(full.q.rows(), K);
  for (Eigen::Index k = 0; k < K; ++k) {
    half.time.push_back(full.time[static_cast<std::size_t>(2 * k)]);
    half.q.col(k) = full.q.col(2 * k);
    half.qDot.col(k) = full.qDot.col(2 * k);
  }
  return half;
}

void mustBeUsable(const CompareOptions& options) {
  const auto require = [](bool holds, const std::string& message) {
    if (!holds) throw std::invalid_argument(message);
  };
  require(!options.integrators.empty(), "integrators: the list is empty, must have at least one");
  for (auto it = options.integrators.begin(); it != options.integrators.end(); ++it) {
    require(std::find(options.integrators.begin(), it, *it) == it,
            "integrators: one is listed twice, must be listed once");
  }
  require(!options.steps.empty(), "steps: the list is empty, must have at least one");
  double before = 0;
  for (const double step : options.steps) {
    require(step > 0 && std::isfinite(step), fmt::format("steps: {} s, must be > 0", step));
    require(step > before, fmt::format("steps: {} s after {} s, must rise", step, before));
    require(step <= options.duration,
            fmt::format("steps: {} s, must not exceed the duration, {} s", step, options.duration));
    before = step;
  }
  require(options.timings >= 1, fmt::format("timings = {}, must be at least 1", options.timings));
  require(options.usefulError > 0 && std::isfinite(options.usefulError),
          fmt::format("useful error = {} rad, must be > 0", options.usefulError));
  require(options.stepResolution > 1 && std::isfinite(options.stepResolution),
          fmt::format("step resolution = {}, must be > 1", options.stepResolution));
}

}  // namespace

Deviation sd(const MusculoskeletalSystem& system, const Trajectory& motion,
             const Trajectory& reference) {
  const std::vector<Eigen::Index> rotations = rotationsOf(system);
  constexpr double sameTime = 1e-9;  // [s]
  Deviation result;
  double sum = 0;
  long count = 0;
  std::size_t k = 0;
  for (std::size_t i = 0; i < motion.time.size(); ++i) {
    const double t = motion.time[i];
    if (reference.time.size() < 2 || t < reference.time.front() - sameTime ||
        t > reference.time.back() + sameTime) {
      continue;
    }
    while (k + 2 < reference.time.size() && reference.time[k + 1] <= t) ++k;
    for (const Eigen::Index row : rotations) {
      const double difference =
          motion.q(row, static_cast<Eigen::Index>(i)) - between(reference, row, k, t);
      sum += difference * difference;
      ++count;
      if (std::abs(difference) > result.largest) {
        result.largest = std::abs(difference);
        result.largestAt = t;
      }
    }
  }
  if (count == 0) throw std::invalid_argument("the reference covers no row of the motion");
  result.rms = std::sqrt(sum / static_cast<double>(count));
  return result;
}

namespace compare {

ConvergedReference Runs::makeReference() const {
  ConvergedReference reference;
  reference.relativeTolerance = 1e-11;
  reference.looserTolerance = 1e-10;
  const auto run = [&](double tolerance) {
    SimulationOptions simulation = simulationOptions(Integrator::cvode, referenceInterval);
    simulation.relativeTolerance = tolerance;
    simulation.absoluteTolerance = tolerance / 100;
    return simulate(*system_, *excitation_, *start_, simulation);
  };
  const Trajectory looser = run(reference.looserTolerance);
  reference.motion =
      looser.outcome == Outcome::completed ? run(reference.relativeTolerance) : looser;
  if (!reference.completed()) return reference;
  reference.problem = sd(*system_, looser, reference.motion);
  if (reference.motion.time.size() >= 5) {
    // a cubic's error falls with the fourth power; it is 0 at the rows that were kept
    reference.interpolationError =
        sd(*system_, reference.motion, thinned(reference.motion)).rms * std::numbers::sqrt2 / 16;
  }
  confirm(reference);
  return reference;
}

void Runs::confirm(ConvergedReference& reference) const {
  const double limit = options_->usefulError / 20;
  // a step that is fine enough for most motions, then what only long or unstable ones need
  for (const double step : {1e-3, 2.5e-4, 1e-4}) {
    if (step > options_->duration) continue;
    const Trajectory motion = run(Integrator::variational, step);
    reference.secondStep = step;
    reference.whyDisputed.clear();
    if (motion.outcome != Outcome::completed) {
      constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
      reference.second = {unknown, unknown, unknown};
      reference.whyDisputed = fmt::format("vi at {:g} s: {}", step, motion.why);
      continue;
    }
    reference.second = sd(*system_, motion, reference.motion);
    if (reference.second.rms < limit) return;
    reference.whyDisputed = fmt::format(
        "cvode and vi at {:g} s differ by {:.3g} deg RMS, and by more than {:.2g} deg from {:.4g} "
        "s on",
        step, reference.second.rms / radiansPerDegree, limit / radiansPerDegree,
        firstBeyond(*system_, motion, reference.motion, limit));
  }
}

SimulationOptions Runs::simulationOptions(Integrator integrator, double step) const {
  SimulationOptions simulation;
  simulation.externalForce = options_->externalForce;
  simulation.prescribed = options_->prescribed;
  simulation.integrator = integrator;
  simulation.step = step;
  simulation.startTime = options_->startTime;
  simulation.duration = options_->duration;
  return simulation;
}

Trajectory Runs::run(Integrator integrator, double step) const {
  return simulate(*system_, *excitation_, *start_, simulationOptions(integrator, step));
}

CompareCell Runs::cell(Integrator integrator, double step) const {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  CompareCell cell;
  cell.integrator = integrator;
  cell.step = step;
  Trajectory motion = run(integrator, step);
  cell.outcome = motion.outcome;
  cell.why = motion.why;
  cell.halvedSteps = motion.halvedSteps;
  if (motion.steps > 0) {
    cell.newtonPerStep =
        static_cast<double>(motion.newtonIterations) / static_cast<double>(motion.steps);
  } else {
    cell.newtonPerStep = integrator == Integrator::rungeKutta4 ? 0 : unknown;
  }
  if (motion.outcome == Outcome::completed) {
    cell.failedAt = unknown;
    cell.error = sd(*system_, motion, reference_->motion);
    cell.energyError = energyError(*system_, motion);
    if (integrator == Integrator::rungeKutta4 && !(cell.error.rms < options_->usefulError)) {
      cell.outcome = Outcome::unstable;
      cell.failedAt = firstBeyond(*system_, motion, reference_->motion, options_->usefulError);
      cell.why = fmt::format(
          "unstable at t = {:.6g} s: bounded, but the error exceeds {:.3g} deg for the first time; "
          "{:.3g} deg RMS",
          cell.failedAt, options_->usefulError / radiansPerDegree,
          cell.error.rms / radiansPerDegree);
    }
    // short runs are repeated more often: a single interruption would outweigh them
    constexpr double enough = 0.1;  // [s]
    constexpr std::size_t atMost = 51;
    std::vector<double> times = {motion.wallSeconds};
    double total = motion.wallSeconds;
    while (times.size() < static_cast<std::size_t>(options_->timings) ||
           (options_->timings > 1 && total < enough && times.size() < atMost)) {
      times.push_back(run(integrator, step).wallSeconds);
      total += times.back();
    }
    std::sort(times.begin(), times.end());
    const std::size_t half = times.size() / 2;
    cell.wallSeconds = times.size() % 2 == 1 ? times[half] : (times[half - 1] + times[half]) / 2;
  } else {
    cell.failedAt = motion.failedAt;
    cell.error = {unknown, unknown, unknown};
    cell.energyError = unknown;
    cell.wallSeconds = unknown;
  }
  cell.time = std::move(motion.time);
  cell.q = std::move(motion.q);
  return cell;
}

}  // namespace compare

Comparison compareIntegrators(const MusculoskeletalSystem& system,
                              const ExcitationSignal& excitation, const SystemState& start,
                              const CompareOptions& options) {
  mustBeUsable(options);
  rotationsOf(system);
  const auto fixedStep = static_cast<std::size_t>(
      std::count_if(options.integrators.begin(), options.integrators.end(),
                    [](Integrator integrator) { return compare::hasFixedStep(integrator); }));
  const std::size_t cells = options.integrators.size() * options.steps.size();
  // a limit and an order are worth about three timed cells each
  const auto work = static_cast<double>(2 + cells + 6 * fixedStep);
  double done = 0;
  const auto advance = [&](double units) {
    done += units;
    if (options.progress) options.progress(std::min(1.0, done / work));
  };

  advance(0);
  Comparison comparison;
  const compare::Runs runs(system, excitation, start, options, comparison.reference);
  comparison.reference = runs.makeReference();
  advance(2);
  if (!comparison.reference.completed()) return comparison;
  for (const Integrator integrator : options.integrators) {
    for (const double step : options.steps) {
      comparison.cells.push_back(runs.cell(integrator, step));
      advance(1);
    }
    if (!compare::hasFixedStep(integrator)) continue;
    comparison.limits.push_back(runs.limit(integrator));
    advance(3);
    comparison.orders.push_back(runs.order(integrator));
    advance(3);
  }
  return comparison;
}

}  // namespace bio
