#include "generator/true_elbow.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace hidden {
namespace {

// A path's conditional points stay this far beyond their range, as in OpenSim [rad].
constexpr double conditionMargin = 1e-5;

// Straight lines between rows, constant outside: rows `before` and `after`, the latter by its
// share.
struct Place {
  std::size_t before, after;
  double share;
};
Place placeOf(const std::vector<double>& times, double t) {
  const auto above = std::upper_bound(times.begin(), times.end(), t);
  if (above == times.begin()) return {0, 0, 0};
  if (above == times.end()) return {times.size() - 1, times.size() - 1, 0};
  const auto k = static_cast<std::size_t>(above - times.begin());
  return {k - 1, k, (t - times[k - 1]) / (times[k] - times[k - 1])};
}

double smootherStep(double x) {
  const double s = std::clamp(x, 0.0, 1.0);
  return s * s * s * (10 - 15 * s + 6 * s * s);
}

}  // namespace

TrueElbow::TrueElbow(const ElbowNumbers& numbers, const InputChain& chain, const Extras& extras,
                     bool countWork)
    : numbers_(numbers), chain_(chain), extras_(extras), size_(2 + 2 * muscles) {
  if (numbers.muscles.size() != muscles) throw std::invalid_argument("the elbow has 8 muscles");
  if (extras.fatigue != 0) fatigueAt_ = size_, size_ += muscles;
  if (extras.hysteresis != 0) hysteresisAt_ = size_, size_ += 1;
  if (countWork) workAt_ = size_, size_ += 2;
  for (const Body& body : numbers.forearm) {
    const Vec r = body.centre - numbers.hinge;
    inertia_ += numbers.axis.dot(body.inertia * numbers.axis) +
                body.mass * numbers.axis.cross(r).squaredNorm();
    firstMoment_ += body.mass * r;
  }
  for (const Path& path : numbers.paths) {
    variants_.push_back({variantOf(path, false), variantOf(path, true)});
  }
}

TrueElbow::Variant TrueElbow::variantOf(const Path& path, bool withConditional) const {
  Variant v;
  const PathPoint* last = nullptr;
  int crossings = 0;
  for (const PathPoint& point : path.points) {
    if (point.conditional && !withConditional) continue;
    if (last && last->onForearm == point.onForearm) {
      v.fixedLength += (point.place - last->place).norm();
    } else if (last) {
      v.P = last->onForearm ? point.place : last->place;
      v.Q = last->onForearm ? last->place : point.place;
      ++crossings;
    }
    last = &point;
  }
  if (crossings != 1) throw std::invalid_argument("a path must cross the elbow once");
  if (path.cylinder >= 0) {
    // the side of the posture in which the arm is straight
    v.side = sideOf(numbers_.cylinders.shapes[static_cast<std::size_t>(path.cylinder)], v.P, v.Q);
  }
  return v;
}

TrueElbow::MusculoskeletalSystem TrueElbow::arm(Eigen::Index muscle, double q) const {
  const auto i = static_cast<std::size_t>(muscle);
  const Path& path = numbers_.paths[i];
  bool active = true;
  for (const PathPoint& point : path.points) {
    if (!point.conditional) continue;
    active = q >= point.from - conditionMargin && q <= point.to + conditionMargin;
  }
  const Variant& v = variants_[i][active ? 1 : 0];
  const Vec arm = turned(v.Q - numbers_.hinge, numbers_.axis, q);
  const Vec Q = numbers_.hinge + arm;
  const SpanLength span =
      path.cylinder < 0 ? straight(v.P, Q)
                        : around(numbers_.cylinders.shapes[static_cast<std::size_t>(path.cylinder)],
                                 v.side, v.P, Q);
  return {v.fixedLength + span.length, span.tangent.dot(numbers_.axis.cross(arm)), span.wraps};
}

double TrueElbow::gravityMoment(double q) const {
  return numbers_.axis.dot(turned(firstMoment_, numbers_.axis, q).cross(numbers_.gravity));
}

double TrueElbow::extraTorque(double t, double q, double w, double z) const {
  const Extras& e = extras_;
  const double dry = std::tanh(w / 0.05);
  double torque = -e.viscous * w - e.coulomb * dry -
                  e.stribeck * (1 + std::exp(-(w / 0.3) * (w / 0.3))) * dry -
                  e.drag * w * std::abs(w) - e.powerDamping * w * std::pow(w * w + 1e-4, -0.25) -
                  e.stiffness * (q - e.stiffnessRest) + e.constant;
  const double above = q - e.limitUpper, below = e.limitLower - q;
  torque += e.limit * (smootherStep(below / e.limitTransition) * below -
                       smootherStep(above / e.limitTransition) * above);
  if (e.tilt != 0 || e.turn != 0) torque += gravityMoment(q + e.tilt + e.turn) - gravityMoment(q);
  if (e.handForce != 0) {
    const Vec r = turned(numbers_.hand - numbers_.hinge, numbers_.axis, q + e.turn);
    torque += numbers_.axis.dot(r.cross(Vec(e.handForce, 0, 0)));
  }
  if (e.band != 0) {
    const Vec r = turned(numbers_.hand - numbers_.hinge, numbers_.axis, q);
    const Vec toShoulder = numbers_.shoulder - numbers_.hinge - r;
    const double length = toShoulder.norm();
    const double tension = e.band * std::max(0.0, length - e.bandRest);
    torque += tension / length * numbers_.axis.dot(r.cross(toShoulder));
  }
  const double off = q - 1.2;
  torque -= e.cubic * off * off * off + e.hysteresis * z + e.angleDamping * q * q / 1.44 * w;
  torque += e.tremor * std::sin(2 * std::numbers::pi * e.tremorFrequency * t + e.tremorPhase);
  if (t >= e.contactFrom && t < e.contactTo)
    torque += e.contact * std::max(0.0, e.contactAngle - q);
  return torque;
}

Eigen::Array<double, 8, 1> TrueElbow::excitation(const Recording& recording, double t) const {
  using Channels = Eigen::Array<double, 8, 1>;
  const auto between = [&](const std::vector<std::array<double, 8>>& rows, double at) -> Channels {
    const Place place = placeOf(recording.times, at);
    const auto row = [&](std::size_t k) { return Eigen::Map<const Channels>(rows[k].data()); };
    return row(place.before) + place.share * (row(place.after) - row(place.before));
  };
  Channels u = between(recording.emg, t - chain_.delay);
  if (chain_.commonDrive) u[7] = u.segment<3>(4).mean();
  u += chain_.offset;
  if (chain_.crosstalk != 0) u.head<3>() -= chain_.crosstalk * (u[4] + u[5]) / 2;
  for (std::size_t i = 0; i < chain_.gain.size(); ++i)
    u[static_cast<Eigen::Index>(i)] *= chain_.gain[i];
  u = u.max(0.0).min(1.0);
  if (chain_.shape != 0) u = ((chain_.shape * u).exp() - 1) / (std::exp(chain_.shape) - 1);
  if (!recording.unfaith.empty()) u = (u * (1 + between(recording.unfaith, t))).max(0.0).min(1.0);
  return u;
}

Eigen::VectorXd TrueElbow::start(const Recording& recording, double q) const {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(size_);
  const auto u = excitation(recording, 0);
  y[0] = q;
  for (Eigen::Index i = 0; i < muscles; ++i) {
    y[2 + i] = u[i];
    const HillMuscle& m = numbers_.muscles[static_cast<std::size_t>(i)];
    y[2 + muscles + i] = m.restingFibre(u[i], arm(i, q).length);
  }
  return y;
}

double TrueElbow::startTorque(const Recording& recording, double q) const {
  const Eigen::VectorXd y = start(recording, q);
  Eigen::VectorXd yDot(size_);
  rate(recording, 0, y.data(), yDot.data());
  return yDot[1] * inertia_;
}

void TrueElbow::rate(const Recording& recording, double t, const double* y, double* yDot) const {
  const double q = y[0], w = y[1];
  const auto u = excitation(recording, t);
  double muscleTorque = 0;
  for (Eigen::Index i = 0; i < muscles; ++i) {
    const HillMuscle& m = numbers_.muscles[static_cast<std::size_t>(i)];
    const double activation = y[2 + i], fibre = y[2 + muscles + i];
    double strength = 1;
    if (fatigueAt_ >= 0) {
      strength -= extras_.fatigue * (1 - std::exp(-y[fatigueAt_ + i] / extras_.fatigueTime));
      yDot[fatigueAt_ + i] = activation;
    }
    const MusculoskeletalSystem a = arm(i, q);
    muscleTorque -= m.tendonForce(fibre, a.length) * a.slope;
    yDot[2 + i] = m.activationRate(u[i], activation);
    yDot[2 + muscles + i] = m.fibreVelocity(activation, fibre, a.length, strength);
  }
  double z = 0;
  if (hysteresisAt_ >= 0) {
    z = y[hysteresisAt_];
    yDot[hysteresisAt_] = (w - std::abs(w) * z) / 0.15;
  }
  double outside = 0;
  if (!recording.torque.empty()) {
    const Place place = placeOf(recording.times, t);
    const auto& torque = recording.torque;
    outside = torque[place.before] + place.share * (torque[place.after] - torque[place.before]);
  }
  const double extra = extraTorque(t, q, w, z) + outside;
  yDot[0] = w;
  yDot[1] = (muscleTorque + gravityMoment(q) + extra) / inertia_;
  if (workAt_ >= 0) {
    yDot[workAt_] = muscleTorque * w;
    yDot[workAt_ + 1] = extra * w;
  }
}

}  // namespace hidden
