// Chapter 6 over twenty seeds: how often nine trials of six seconds learn the length, and what each
// kind of noise and the clipping of the sensor do. Status 1 if fewer than 95 % are within 0.015 m.
#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "robots/active_estimation.h"
#include "robots/box_task.h"

namespace {

struct Study {
  int trials = 0, within = 0, landed = 0;
  double worst = 0, sum = 0, squares = 0;
};

Study study(int seeds, const std::function<void(info::ActiveEstimationTask&)>& change) {
  Study out;
  for (int seed = 1; seed <= seeds; ++seed) {
    std::uint64_t stream = 0;
    for (double length : info::initialLengths()) {
      info::ActiveEstimationTask task;
      task.initialLength = length;
      task.seed = static_cast<std::uint64_t>(seed);
      task.stream = stream++;
      change(task);
      const double estimate = info::runActiveEstimation(task).length();
      const double error = std::abs(estimate - task.trueLength);
      ++out.trials;
      out.within += error < 0.015;
      out.worst = std::max(out.worst, error);
      out.sum += estimate;
      out.squares += estimate * estimate;
      if (estimate > 0.3)
        out.landed += info::executeSwing(info::planSwing(estimate), task.trueLength).success;
    }
  }
  return out;
}

void print(const char* what, const Study& s) {
  const double n = s.trials, mean = s.sum / n;
  fmt::print(
      "{:<44} within 0.015 m: {:3} of {}, in the box: {:3}, mean {:.4f}, deviation {:.4f}, "
      "largest error {:.4f} m\n",
      what, s.within, s.trials, s.landed, mean, std::sqrt((s.squares - n * mean * mean) / (n - 1)),
      s.worst);
}

}  // namespace

int main() {
  constexpr int seeds = 20;
  const Study usual = study(seeds, [](info::ActiveEstimationTask&) {});
  print("0.1 N and 0.5 m/s²", usual);
  print("0.05 N alone", study(seeds, [](info::ActiveEstimationTask& task) {
          task.cell.sd = 0.05;
          task.disturbance.acceleration = 0;
        }));
  print("0.24 kg, clipping modelled",
        study(seeds, [](info::ActiveEstimationTask& task) { task.trueMass = 0.24; }));
  print("0.24 kg, clipping ignored", study(seeds, [](info::ActiveEstimationTask& task) {
          task.trueMass = 0.24;
          task.modelClipping = false;
        }));
  return usual.within >= 0.95 * usual.trials ? 0 : 1;
}
