#include "generator/open_loop_trial.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "generator/stiff_solver.h"

namespace hidden {
namespace {

constexpr std::size_t numExtensors = 4;  // the first of the eight

// Bumps sin² of random height and width at random times.
class Pulses {
 public:
  Pulses(double until, double highest, RandomNumbers& random) {
    double t = random.between(-0.2, 0.6);
    while (t < until) {
      const double width = random.between(0.5, 1.4);
      bumps_.push_back({t, std::min(width, until - t), random.between(0.2, 1) * highest});
      t += width * random.between(0.6, 1.4);
    }
  }
  double at(double t) const {
    double sum = 0;
    for (const Bump& b : bumps_) {
      const double x = (t - b.start) / b.width;
      if (x > 0 && x < 1) sum += b.height * std::pow(std::sin(std::numbers::pi * x), 2);
    }
    return sum;
  }

 private:
  struct Bump {
    double start, width, height;
  };
  std::vector<Bump> bumps_;
};

}  // namespace

Trial makeOpenLoopTrial(const Truth& truth, const TrialPlan& plan, RandomNumbers& random) {
  const TrueElbow elbow(truth.numbers, truth.chain, truth.extras);
  const double until = random.between(0, 1) < 0.25 ? plan.duration - 1.5 : plan.duration + 1;
  const Pulses flexing(until, random.between(0.03, 0.12), random);
  const Pulses extending(until, random.between(0.01, 0.05), random);
  std::array<double, 8> tone{}, share{};
  const double flexorTone = random.between(0.025, 0.06);
  for (std::size_t i = 0; i < 8; ++i) {
    tone[i] =
        i < numExtensors ? random.between(0.005, 0.012) : flexorTone * random.between(0.85, 1.15);
    share[i] = random.between(0.8, 1.2);
  }
  const double q0 = random.between(5, 120) * degree;

  const auto rows = static_cast<std::size_t>(std::lround(plan.duration * plan.rate)) + 1;
  Trial trial;
  Recording& made = trial.truth;
  for (std::size_t k = 0; k < rows; ++k) {
    const double t = static_cast<double>(k) / plan.rate;
    std::array<double, 8> u{};
    for (std::size_t i = 0; i < 8; ++i) {
      const double pulse = (i < numExtensors ? extending : flexing).at(t);
      u[i] = std::clamp(tone[i] + share[i] * pulse, 0.003, 0.9);
    }
    made.times.push_back(t);
    made.emg.push_back(recordedAs(truth.chain, u));
  }

  StiffSolver solver(elbow, made, elbow.start(made, q0));
  trial.angle.push_back(q0);
  for (std::size_t k = 1; k < rows; ++k) {
    trial.angle.push_back(solver.advanceTo(made.times[k])[0]);
    const double reached = trial.angle.back() / degree;
    if (!(reached > -12 && reached < 140)) throw std::runtime_error("the arm leaves its range");
  }
  trial.recorded = made.emg;
  loseRecords(truth, trial);
  measure(truth, plan, trial, random);
  return trial;
}

}  // namespace hidden
