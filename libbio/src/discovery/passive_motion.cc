#include "bio/discovery/passive_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bio/analysis/replay.h"
#include "bio/discovery/end_of_limb.h"
#include "bio/simulation/simulate.h"

namespace bio::discover {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr double relaxed = 0.01;  // excitation, at most

struct Point {
  double q, qDot, qDotDot;
};

// Minimum jerk from `low` to `high` and back; a moment's rest before, between and after.
Point sweepAt(double share, double duration, double low, double high) {
  constexpr double rest = 0.04, half = 0.5;
  const bool back = share > half;
  const double time = (half - 1.5 * rest) * duration;
  const double x =
      std::clamp((share - (back ? half + rest / 2 : rest)) * duration / time, 0.0, 1.0);
  const double from = back ? high : low, d = back ? low - high : high - low;
  return {from + d * x * x * x * (10 - 15 * x + 6 * x * x),
          d / time * 30 * x * x * (1 - x) * (1 - x),
          d / (time * time) * 60 * x * (1 - x) * (1 - 2 * x)};
}

// What the muscles do to the coordinate at rest, over its range; nothing where one has no rest.
class RestingMuscles {
 public:
  RestingMuscles(const MusculoskeletalSystem& arm, const Trial& trial, double low, double high) {
    const ExcitationSignal excitation = excitationOf(trial, arm);
    constexpr Index angles = 31;
    q_ = VectorXd::LinSpaced(angles, low, high);
    moment_ = VectorXd::Zero(angles);
    for (Index i = 0; i < angles; ++i) {
      try {
        const SystemState state =
            initialState(arm, q_.segment(i, 1), excitation, excitation.times().front());
        Trajectory rest;
        rest.time = {0};
        rest.q = state.q;
        rest.qDot = state.qDot;
        rest.activation = state.activation;
        rest.fibreLength = state.fibreLength;
        const MuscleReport report = reportMuscles(arm, rest);
        moment_[i] = report.tendonForce.cwiseProduct(report.momentArm).sum();
      } catch (const NoStaticEquilibrium&) {
        // a slack muscle, say: it does nothing
      }
    }
  }
  double momentAt(double q) const {
    const double last = static_cast<double>(q_.size() - 1);
    const double x = std::clamp((q - q_[0]) / (q_[q_.size() - 1] - q_[0]) * last, 0.0, last);
    const auto k = std::min(static_cast<Index>(x), q_.size() - 2);
    const double w = x - static_cast<double>(k);
    return (1 - w) * moment_[k] + w * moment_[k + 1];
  }

 private:
  VectorXd q_, moment_;
};

// What moves the arm so, the mass in the hand among it. Gravity of an arm that is turned is that of
// q + turn.
double torqueOf(const EncompassingModel& model, SystemConfiguration<1>& bodies,
                const RestingMuscles& muscles, const ExperimentalConditions& known,
                const Point& p) {
  using Vector = SystemConfiguration<1>::Vector;
  const double mass = known.massInHand;
  const Eigen::Vector3d& gravity = model.arm().skeleton().gravity();
  const std::string hand = mass != 0 ? model.movedBodies().back() : "";
  bodies.moveSkeletonTo(Vector(p.q + known.armTurn));
  double torque = bodies.inertia().dV[0];
  if (mass != 0) torque -= mass * gravity.dot(model.velocityOf(hand, p.q + known.armTurn));
  bodies.moveSkeletonTo(Vector(p.q));
  torque += bodies.inertia().massMatrix(0, 0) * p.qDotDot +
            bodies.inertia().dM[0](0, 0) / 2 * p.qDot * p.qDot;
  if (mass != 0) torque += mass * model.velocityOf(hand, p.q).squaredNorm() * p.qDotDot;
  Vector passive = Vector::Zero(), slope = Vector::Zero(), rate = Vector::Zero();
  model.arm().coordinateForces().add<1>(Vector(p.q), Vector(p.qDot), passive, slope, rate);
  return torque - passive[0] - muscles.momentAt(p.q);
}

// The trial with the arm relaxed and moved from `low` to `high` and back by a torque that is known.
Trial movedPassively(Trial trial, const EncompassingModel& model, double low, double high) {
  const std::string& coordinate = model.coordinate().name;
  trial.excitations.rowwise() = trial.excitations.colwise().minCoeff().cwiseMin(relaxed).eval();
  const RestingMuscles muscles(model.arm(), trial, low, high);
  SystemConfiguration<1> bodies(model.arm());
  const auto at = [&](double t) {
    return sweepAt((t - trial.times[0]) / trial.duration(), trial.duration(), low, high);
  };
  VectorXd torque(trial.times.size());
  for (Index i = 0; i < torque.size(); ++i)
    torque[i] = torqueOf(model, bodies, muscles, trial.known, at(trial.times[i]));
  std::erase_if(trial.applied, [&](const auto& one) { return one.coordinate == coordinate; });
  trial.applied.push_back({coordinate, torque});
  for (MeasuredChannel& measured : trial.measured) {
    if (measured.what != ofCoordinate(coordinate)) continue;
    for (Index i = 0; i < measured.times.size(); ++i) measured.values[i] = at(measured.times[i]).q;
  }
  return trial;
}

std::string sentenceOf(const Trial& moved, const EncompassingModel& model, double low,
                       double high) {
  const Coordinate& coordinate = model.coordinate();
  const bool turns = coordinate.isRotation;
  const double unit = turns ? std::numbers::pi / 180 : 1;
  std::string changed, header;
  if (moved.known.massInHand != 0)
    changed = fmt::format(", with {} kg {}", moved.known.massInHand, placeOfMass(model));
  if (moved.known.armTurn != 0)
    changed += ", " + inWords({0, moved.known.armTurn}) +
               " (as a whole, about the joint, positive as the coordinate rises)";
  for (const auto& [line, value] : headerOf(moved.known))
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
  if (model.arm().skeleton().numCoordinates() != 1) return planned;
  const Coordinate& coordinate = model.coordinate();
  const double span = coordinate.rangeMax - coordinate.rangeMin;
  if (!std::isfinite(span) || !(span > 0)) return planned;
  const auto can = [&](const char* change) {
    return std::any_of(model.quantities().begin(), model.quantities().end(),
                       [&](const auto& one) { return one.name == change; });
  };
  for (const double turn : {0.0, -45.0}) {
    if (turn != 0 && !can("known.turn")) continue;
    for (const double mass : {0.0, 1.0}) {
      if (mass != 0 && !can("known.mass")) continue;
      const double low = coordinate.rangeMin + 0.1 * span,
                   high = coordinate.rangeMin + (turn == 0 ? 0.65 : 0.85) * span;
      Trial changed = trial;
      changed.known.massInHand += mass;
      changed.known.armTurn += turn * std::numbers::pi / 180;
      Trial moved = movedPassively(std::move(changed), model, low, high);
      planned.push_back({sentenceOf(moved, model, low, high), std::move(moved)});
    }
  }
  return planned;
}

}  // namespace bio::discover
