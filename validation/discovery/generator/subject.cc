#include "generator/subject.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "generator/stiff_solver.h"

namespace hidden {
namespace {

using Channels = std::array<double, 8>;

double rounded(double value, double unit) {
  return std::round(value / unit) * unit;
}

// A few slow sines of unit variance together.
class Wander {
 public:
  explicit Wander(RandomNumbers& random) {
    for (auto& s : sines_) {
      s = {2 * std::numbers::pi * random.between(0.1, 0.9),
           2 * std::numbers::pi * random.between(0, 1)};
    }
  }
  double at(double t) const {
    double sum = 0;
    for (const auto& s : sines_) sum += std::sin(s[0] * t + s[1]);
    return sum * std::sqrt(2.0 / 4.0);
  }

 private:
  std::array<std::array<double, 2>, 4> sines_{};
};

// Rests and minimum-jerk reaches between random angles.
class Target {
 public:
  Target(double duration, RandomNumbers& random) {
    double t = random.between(0.2, 0.4), q = random.between(40, 100) * degree;
    first_ = q;
    while (t < duration + 1) {
      double next = random.between(25, 115) * degree;
      while (std::abs(next - q) < 20 * degree) next = random.between(25, 115) * degree;
      const double speed = random.between(50, 130) * degree;
      const double time = std::max(0.4, std::abs(next - q) / speed);
      reaches_.push_back({t, time, q, next});
      t += time + random.between(0, 0.35);
      q = next;
    }
  }
  struct Point {
    double q, w, acceleration;
  };
  Point at(double t) const {
    Point p{first_, 0, 0};
    for (const Reach& r : reaches_) {
      if (t < r.start) break;
      const double x = std::min(1.0, (t - r.start) / r.time), d = r.to - r.from;
      p.q = r.from + d * x * x * x * (10 - 15 * x + 6 * x * x);
      p.w = d / r.time * 30 * x * x * (1 - x) * (1 - x);
      p.acceleration = d / (r.time * r.time) * 60 * x * (1 - x) * (1 - 2 * x);
    }
    return p;
  }

 private:
  struct Reach {
    double start, time, from, to;
  };
  double first_ = 0;
  std::vector<Reach> reaches_;
};

double smoothStep(double x) {
  const double s = std::clamp(x, 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

// From drive to the eight muscles' excitations: d > 0 flexes, both sides co-contract – little
// between 45 and 80°, where co-contraction makes this elbow statically unstable (its stiffness
// turns negative), so that open-loop replays would drift apart for no interesting reason.
class Synergy {
 public:
  explicit Synergy(RandomNumbers& random) : level_(random.between(0.03, 0.08)), together_(random) {
    for (int i = 0; i < 8; ++i) shares_.emplace_back(random);
  }
  Channels at(double t, double angle, double drive) const {
    Channels v{};
    const double safe = 0.1 + smoothStep((angle - 80 * degree) / (20 * degree)) +
                        0.3 * smoothStep((45 * degree - angle) / (15 * degree));
    const double both = level_ * safe * std::exp(0.4 * together_.at(t));
    for (std::size_t i = 0; i < 8; ++i) {
      const double side = i < 4 ? std::max(0.0, -1.6 * drive) : std::max(0.0, drive);
      v[i] = std::clamp((both + side) * std::exp(0.3 * shares_[i].at(t)), 0.003, 0.9);
    }
    return v;
  }

 private:
  double level_;
  Wander together_;
  std::vector<Wander> shares_;
};

// The EMG that gives these excitations through the chain, as a file can hold it.
Channels recordingOf(const InputChain& chain, const Channels& v, const Channels* error) {
  Channels u = v;
  for (std::size_t i = 0; i < 8; ++i) {
    if (error) u[i] /= 1 + (*error)[i];
    if (chain.shape != 0) u[i] = std::log1p(u[i] * std::expm1(chain.shape)) / chain.shape;
    if (!chain.gain.empty()) u[i] /= chain.gain[i];
  }
  for (std::size_t i = 0; i < 3; ++i) u[i] += chain.crosstalk * (u[4] + u[5]) / 2;
  for (double& x : u) x = std::clamp(rounded(x - chain.offset, 1e-5), 0.0, 1.0);
  return u;
}

}  // namespace

std::array<double, 8> recordedAs(const InputChain& chain,
                                 const std::array<double, 8>& excitations) {
  return recordingOf(chain, excitations, nullptr);
}

std::vector<double> throughSensor(const Sensor& sensor, const Recording& recording,
                                  const std::vector<double>& angle) {
  std::vector<double> seen;
  const auto& times = recording.times;
  for (const double now : times) {
    const double t = now - sensor.clock;
    const auto above = std::upper_bound(times.begin(), times.end(), t);
    const auto k = static_cast<std::size_t>(above - times.begin());
    double q = angle.front();
    if (k == times.size()) {
      q = angle.back();
    } else if (k > 0) {
      // cubic through four rows: the error at 100 Hz is far below the noise
      const std::size_t i = std::clamp<std::size_t>(k - 1, 1, times.size() - 3) - 1;
      q = 0;
      for (std::size_t a = i; a < i + 4; ++a) {
        double weight = angle[a];
        for (std::size_t b = i; b < i + 4; ++b) {
          if (b != a) weight *= (t - times[b]) / (times[a] - times[b]);
        }
        q += weight;
      }
    }
    seen.push_back((1 + sensor.gain) * q + sensor.bias);
  }
  return seen;
}

void loseRecords(const Truth& truth, Trial& trial) {
  const auto& times = trial.truth.times;
  for (std::size_t k = 0; truth.dropout.present && k < times.size(); ++k) {
    if (times[k] < truth.dropout.from || times[k] > truth.dropout.to) continue;
    for (const std::size_t i : {std::size_t{4}, std::size_t{5}}) {
      trial.recorded[k][i] = rounded(truth.dropout.level * trial.recorded[k][i], 1e-5);
    }
  }
}

void measure(const Truth& truth, const TrialPlan& plan, Trial& trial, RandomNumbers& random) {
  trial.measured_deg.clear();
  for (const double y : throughSensor(truth.sensor, trial.truth, trial.angle)) {
    trial.measured_deg.push_back(rounded(y / degree + plan.angleNoise * random.normal(), 0.01));
  }
}

std::vector<double> replayed(const Truth& truth, const Recording& recording, double q0,
                             double tolerance) {
  const TrueElbow elbow(truth.numbers, truth.chain, truth.extras);
  StiffSolver solver(elbow, recording, elbow.start(recording, q0), tolerance);
  std::vector<double> angle;
  for (const double t : recording.times) angle.push_back(solver.advanceTo(t)[0]);
  return angle;
}

Trial makeTrial(const Truth& truth, const TrialPlan& plan, RandomNumbers& random) {
  const TrueElbow elbow(truth.numbers, truth.chain, truth.extras);
  const Target target(plan.duration, random);
  const Synergy synergy(random);
  const auto rows = static_cast<std::size_t>(std::lround(plan.duration * plan.rate)) + 1;
  Trial trial;
  Recording& made = trial.truth;

  // what the EMG does not say of the muscle, and pushes from outside
  Channels error{};
  const double stays = std::exp(-1 / (plan.rate * 0.08));
  const double renewed = std::sqrt(1 - stays * stays);
  for (double& e : error) e = random.normal();
  const auto drawError = [&] {
    for (double& e : error) e = stays * e + renewed * random.normal();
    Channels scaled{};
    for (std::size_t i = 0; i < 8; ++i) {
      scaled[i] = std::clamp(plan.emgNoise * error[i], -0.5, 0.5);
    }
    return scaled;
  };
  std::vector<double> pulses;
  for (double t = 0.6; plan.torquePulses && t < plan.duration; t += random.between(0.5, 0.9)) {
    pulses.push_back(t);
  }
  const auto add = [&](double t, double drive) {
    made.times.push_back(t);
    const Channels unfaith = drawError();
    if (plan.emgNoise > 0) made.unfaith.push_back(unfaith);
    made.emg.push_back(recordingOf(truth.chain, synergy.at(t, target.at(t).q, drive),
                                   plan.emgNoise > 0 ? &unfaith : nullptr));
    if (!plan.torquePulses) return;
    double torque = 0;
    for (std::size_t k = 0; k < pulses.size(); ++k) {
      if (t >= pulses[k] && t < pulses[k] + 0.055) torque = k % 2 == 0 ? 3.0 : -3.0;
    }
    made.torque.push_back(torque);
  };
  const auto replaceLast = [&](double drive) {
    made.emg.back() = recordingOf(truth.chain, synergy.at(made.times.back(), target.at(0).q, drive),
                                  plan.emgNoise > 0 ? &made.unfaith.back() : nullptr);
  };

  // the drive that balances the start
  const double q0 = target.at(0).q;
  double low = -0.2, high = 0.5;
  add(0, low);
  for (int halving = 0; halving < 40; ++halving) {
    replaceLast((low + high) / 2);
    (elbow.startTorque(made, q0) > 0 ? high : low) = (low + high) / 2;
  }
  replaceLast(low);
  if (std::abs(elbow.startTorque(made, q0)) > 0.05) throw std::runtime_error("no balance");

  // feedback, in units of drive; 60 N m is about what the flexors can
  constexpr double strength = 60, lead = 0.06, Kp = 5, Kd = 0.5, Ki = 8;
  const double inertia = elbow.inertia();
  const auto wanted = [&](double t) {
    const Target::Point p = target.at(t + lead);
    return inertia * p.acceleration - elbow.gravityMoment(p.q);
  };
  double integral = low - wanted(0) / strength;
  StiffSolver solver(elbow, made, elbow.start(made, q0));
  double square = 0;
  trial.angle.push_back(q0);
  for (std::size_t k = 1; k < rows; ++k) {
    const double now = made.times.back();
    const Target::Point p = target.at(now);
    const double q = solver.state()[0], w = solver.state()[1];
    integral += Ki * (p.q - q) / strength / plan.rate;
    const double torque = wanted(now) + Kp * (p.q - q) + Kd * (p.w - w);
    add(static_cast<double>(k) / plan.rate, integral + torque / strength);
    trial.angle.push_back(solver.advanceTo(made.times.back())[0]);
    const double reached = trial.angle.back() / degree;
    if (!(reached > 8 && reached < 128)) throw std::runtime_error("the arm leaves its range");
    square += std::pow(reached - target.at(made.times.back()).q / degree, 2);
  }
  trial.tracking_deg = std::sqrt(square / static_cast<double>(rows - 1));

  trial.recorded = made.emg;
  loseRecords(truth, trial);
  measure(truth, plan, trial, random);
  return trial;
}

}  // namespace hidden
