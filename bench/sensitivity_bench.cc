// What all sensitivities of the main job cost, beside the job itself.
#include <benchmark/benchmark.h>

#include <algorithm>

#include "bio/observation/least_squares_cost.h"
#include "bio/sensitivity/cost_gradient.h"
#include "kept_memory.h"
#include "support/shipped_elbow.h"

namespace {

using bio::fixtures::ShippedElbow;

bio::SimulationOptions options() {
  bio::SimulationOptions o;
  o.duration = 4.5;
  return o;
}

void simulation(benchmark::State& state) {
  const ShippedElbow elbow;
  const auto setting = elbow.catalogue.nominal();
  for (auto _ : state) {
    const bio::Trajectory motion =
        bio::simulateSetting(elbow.system, setting, elbow.excitation, options());
    benchmark::DoNotOptimize(motion.q.data());
  }
}
BENCHMARK(simulation)->Unit(benchmark::kMillisecond);

/// The motion again, and its derivatives in the parameters that match the patterns.
void sensitivities(benchmark::State& state, const std::vector<std::string>& patterns,
                   bool muscles) {
  const ShippedElbow elbow;
  const auto setting = elbow.catalogue.nominal();
  const auto wanted = elbow.catalogue.select(patterns);
  for (auto _ : state) {
    const bio::SensitivityTrajectory s = bio::simulateWithSensitivities(
        elbow.system, elbow.catalogue, setting, wanted, elbow.excitation, {options(), muscles});
    benchmark::DoNotOptimize(s.q[0].data());
  }
  state.counters["parameters"] = static_cast<double>(wanted.size());
}
BENCHMARK_CAPTURE(sensitivities, of_the_motion_to_all, {"all"}, false)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(sensitivities, of_everything_to_all, {"all"}, true)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(sensitivities, of_the_motion_to_muscles,
                  {"*.max_isometric_force", "*.optimal_fiber_length", "*.tendon_slack_length",
                   "*.pennation_angle", "*.damping", "*.time_scale", "*.activation1",
                   "*.activation2"},
                  false)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(sensitivities, of_the_motion_to_one, {"TRI.radius"}, false)
    ->Unit(benchmark::kMillisecond);

/// A least-squares cost of the angle at every row and its gradient in the parameters that match.
void gradient(benchmark::State& state, const std::vector<std::string>& patterns) {
  const ShippedElbow elbow;
  const auto setting = elbow.catalogue.nominal();
  const auto wanted = elbow.catalogue.select(patterns);
  const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(451, 0, 4.5);
  const bio::MotionCost cost = bio::leastSquaresCost(
      elbow.system, {{{bio::Observable::Kind::coordinate, "elbow_flexion", 0}, times}},
      Eigen::VectorXd::Constant(times.size(), 1), Eigen::VectorXd::Constant(times.size(), 0.02));
  for (auto _ : state) {
    const bio::CostGradient g = bio::simulateWithGradient(
        elbow.system, elbow.catalogue, setting, wanted, elbow.excitation, options(), cost);
    benchmark::DoNotOptimize(g.gradient.data());
  }
  state.counters["parameters"] = static_cast<double>(wanted.size());
}
BENCHMARK_CAPTURE(gradient, of_a_cost_in_all, {"all"})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(gradient, of_a_cost_in_one, {"TRI.radius"})->Unit(benchmark::kMillisecond);

/// What central differences of the motion take: two simulations of a changed model for each
/// parameter that matches.
void centralDifferences(benchmark::State& state, const std::vector<std::string>& patterns) {
  const ShippedElbow elbow;
  const auto wanted = elbow.catalogue.select(patterns);
  for (auto _ : state) {
    for (const std::size_t index : wanted) {
      const bio::ModelParameter& parameter = elbow.catalogue.parameters()[index];
      for (const double share : {-1e-4, 1e-4}) {
        const double value =
            std::clamp(parameter.value + share * parameter.sd, parameter.lower, parameter.upper);
        const auto setting = elbow.catalogue.at({index}, Eigen::VectorXd::Constant(1, value));
        const bio::MusculoskeletalSystem system(setting.model, ShippedElbow::options());
        const bio::Trajectory motion =
            bio::simulateSetting(system, setting, elbow.excitation, options());
        benchmark::DoNotOptimize(motion.q.data());
      }
    }
  }
  state.counters["parameters"] = static_cast<double>(wanted.size());
}
BENCHMARK_CAPTURE(centralDifferences, of_the_motion_to_all, {"all"})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(centralDifferences, of_the_motion_to_one, {"TRI.radius"})
    ->Unit(benchmark::kMillisecond);

void compileArm(benchmark::State& state) {
  const ShippedElbow elbow;
  for (auto _ : state) {
    const bio::MusculoskeletalSystem system(elbow.model, ShippedElbow::options());
    benchmark::DoNotOptimize(system.numMuscles());
  }
}
BENCHMARK(compileArm)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
