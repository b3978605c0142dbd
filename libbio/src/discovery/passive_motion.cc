#include "bio/discovery/passive_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "bio/analysis/inverse_dynamics.h"
#include "bio/analysis/replay.h"
#include "bio/discovery/end_of_limb.h"
#include "bio/discovery/with_experimental_conditions.h"
#include "bio/model/units.h"

namespace bio::discover {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr double relaxed = 0.01;  // excitation, at most

// Minimum jerk from `low` to `high` and back; a moment's rest before, between and after.
double sweepAt(double share, double low, double high) {
  constexpr double rest = 0.04, half = 0.5;
  const bool back = share > half;
  const double x =
      std::clamp((share - (back ? half + rest / 2 : rest)) / (half - 1.5 * rest), 0.0, 1.0);
  const double from = back ? high : low, d = back ? low - high : high - low;
  return from + d * x * x * x * (10 - 15 * x + 6 * x * x);
}

// The force that moves the model of the trial along the sweep; none where that cannot be simulated.
ExternalForce sweepingForce(const Trial& trial, const EncompassingModel& model, double low,
                            double high) {
  const ParameterCatalogue::Setting setting =
      model.settingAt(model.nominal() + experimentalConditionsOf(trial, model), {});
  MusculoskeletalSystem system = model.systemOf(setting);
  const ExcitationSignal excitation = excitationOf(trial, system);
  // a course much finer than the steps, since its third derivative jumps
  const auto steps = std::max<Index>(trial.times.size() - 1,
                                     static_cast<Index>(std::ceil(trial.duration() / 0.01)));
  const VectorXd shares = VectorXd::LinSpaced(10 * steps + 1, 0, 1);
  const VectorXd times = (trial.times[0] + trial.duration() * shares.array()).matrix();
  const VectorXd q = shares.unaryExpr([&](double share) { return sweepAt(share, low, high); });
  SimulationOptions simulation;
  simulation.step = trial.duration() / static_cast<double>(steps);
  const Trajectory moved = inverseDynamics(std::move(system), excitation,
                                           {times.begin(), times.end()}, q.transpose(), simulation);
  if (moved.outcome != Outcome::completed) return {};
  return {moved.time, moved.reaction.transpose()};
}

// The trial with the limb relaxed and moved from `low` to `high` and back by a force that is known;
// nothing where the model cannot be moved so.
std::optional<Trial> movedPassively(Trial trial, const EncompassingModel& model, double low,
                                    double high) {
  const std::string& coordinate = model.coordinate().name;
  trial.excitations.rowwise() = trial.excitations.colwise().minCoeff().cwiseMin(relaxed).eval();
  std::erase_if(trial.applied, [&](const auto& one) { return one.coordinate == coordinate; });
  ExternalForce force;
  try {
    force = sweepingForce(trial, model, low, high);
  } catch (const std::exception&) {
    // outside the model's domain
  }
  if (force.empty()) return {};
  const double first = trial.times[0];
  const auto sweep = [&](double t) { return sweepAt((t - first) / trial.duration(), low, high); };
  trial.applied.push_back({coordinate, trial.times.unaryExpr([&](double t) {
                             return force.at(std::min(t, force.times().back())).value[0];
                           })});
  for (MeasuredChannel& measured : trial.measured) {
    if (measured.what == ofCoordinate(coordinate))
      measured.values = measured.times.unaryExpr(sweep);
  }
  return trial;
}

std::string sentenceOf(const Trial& moved, const EncompassingModel& model, double low,
                       double high) {
  const Coordinate& coordinate = model.coordinate();
  const bool turns = coordinate.isRotation;
  const double unit = turns ? radiansPerDegree : 1;
  std::string changed, header;
  if (moved.conditions.massInHand != 0)
    changed = fmt::format(", with {} kg {}", moved.conditions.massInHand, placeOfMass(model));
  if (moved.conditions.armTurn != 0)
    changed += ", " + inWords({0, moved.conditions.armTurn}) +
               " (as a whole, about the joint, positive as the coordinate rises)";
  for (const auto& [line, value] : headerOf(moved.conditions))
    header += fmt::format("{}{}={}", header.empty() ? ", header " : " and ", line, value);
  return fmt::format(
      "relax the muscles, have the limb moved slowly from {:.4g} to {:.4g} {} and back within "
      "{:.3g} s{}, and record the load that moves it (column {}.{}{})",
      low / unit, high / unit, turns ? "deg" : "m", moved.duration(), changed, coordinate.name,
      turns ? "torque" : "force", header);
}

}  // namespace

std::vector<PlannedExperiment> passiveMotions(const Trial& trial, const EncompassingModel& model) {
  std::vector<PlannedExperiment> planned;
  if (model.system().skeleton().numCoordinates() != 1) return planned;
  const Coordinate& coordinate = model.coordinate();
  const double span = coordinate.rangeMax - coordinate.rangeMin;
  if (!std::isfinite(span) || !(span > 0)) return planned;
  for (const double turn : {0.0, -45.0}) {
    if (turn != 0 && !model.conditions().armTurn) continue;
    for (const double mass : {0.0, 1.0}) {
      if (mass != 0 && !model.conditions().massInHand) continue;
      const double low = coordinate.rangeMin + 0.1 * span,
                   high = coordinate.rangeMin + (turn == 0 ? 0.65 : 0.85) * span;
      Trial changed = trial;
      changed.conditions.massInHand += mass;
      changed.conditions.armTurn += turn * radiansPerDegree;
      if (auto moved = movedPassively(std::move(changed), model, low, high))
        planned.push_back({sentenceOf(*moved, model, low, high), std::move(*moved), false});
    }
  }
  return planned;
}

}  // namespace bio::discover
