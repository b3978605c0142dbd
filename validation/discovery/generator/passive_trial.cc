#include "generator/passive_trial.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "generator/stiff_solver.h"

namespace hidden {
namespace {

// Minimum jerk up in the first half of the trial and down in the second.
struct Sweep {
  double low = 13 * degree, high = 110 * degree, duration = 4.5, rest = 0.2;
  struct Point {
    double q, w, acceleration;
  };
  Point at(double t) const {
    const double half = duration / 2, time = half - 2 * rest;
    const bool down = t > half;
    const double x = std::clamp((t - rest - (down ? half : 0)) / time, 0.0, 1.0);
    const double from = down ? high : low, d = down ? low - high : high - low;
    return {from + d * x * x * x * (10 - 15 * x + 6 * x * x),
            d / time * 30 * x * x * (1 - x) * (1 - x),
            d / (time * time) * 60 * x * (1 - x) * (1 - 2 * x)};
  }
};

}  // namespace

Trial makePassiveTrial(const Truth& truth, const TrialPlan& plan, RandomNumbers& random) {
  const TrueElbow elbow(truth.numbers, truth.chain, truth.extras);
  Sweep sweep;
  sweep.duration = plan.duration;
  const auto rows = static_cast<std::size_t>(std::lround(plan.duration * plan.rate)) + 1;
  std::array<double, 8> rest{};
  for (double& u : rest) u = 0.004 * std::exp(0.3 * random.normal());
  Trial trial;
  Recording& made = trial.truth;
  const auto add = [&](double t, double torque) {
    made.times.push_back(t);
    made.emg.push_back(recordedAs(truth.chain, rest));
    made.torque.push_back(torque);
  };

  const double q0 = sweep.low;
  add(0, 0);
  made.torque.back() = -elbow.startTorque(made, q0);
  const auto wanted = [&](const Sweep::Point& p) {
    return elbow.inertia() * p.acceleration - elbow.gravityMoment(p.q + truth.extras.turn);
  };
  constexpr double stiffness = 40, unsteady = 0.15;  // N m/rad, N m
  const double damping = 1.4 * std::sqrt(stiffness * elbow.inertia());
  const double stays = std::exp(-1 / (plan.rate * 0.2)), renewed = std::sqrt(1 - stays * stays);
  // what the first torque lacks of what is wanted there is what else the arm needs at rest
  const double offset = made.torque.back() - wanted(sweep.at(0));
  double hand = 0, square = 0;
  StiffSolver solver(elbow, made, elbow.start(made, q0));
  trial.angle.push_back(q0);
  for (std::size_t k = 1; k < rows; ++k) {
    const double q = solver.state()[0], w = solver.state()[1];
    const Sweep::Point now = sweep.at(made.times.back());
    hand = stays * hand + renewed * unsteady * random.normal();
    add(static_cast<double>(k) / plan.rate,
        offset + wanted(now) + stiffness * (now.q - q) + damping * (now.w - w) + hand);
    trial.angle.push_back(solver.advanceTo(made.times.back())[0]);
    const double reached = trial.angle.back() / degree;
    if (!(reached > 2 && reached < 128)) throw std::runtime_error("the arm leaves its range");
    square += std::pow(reached - sweep.at(made.times.back()).q / degree, 2);
  }
  trial.tracking_deg = std::sqrt(square / static_cast<double>(rows - 1));
  trial.recorded = made.emg;
  for (const double y : throughSensor(truth.sensor, made, trial.angle)) {
    const double shown = y / degree + plan.angleNoise * random.normal();
    trial.measured_deg.push_back(std::round(100 * shown) / 100);
  }
  return trial;
}

}  // namespace hidden
