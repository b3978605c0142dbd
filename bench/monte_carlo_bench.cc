#include <benchmark/benchmark.h>

#include "info/estimation/monte_carlo.h"
#include "robots/robot_experiments.h"

namespace {

// 300 estimates of the double pendulum's mass and damping from fresh noise, starts drawn within 0
// to 2 times the truth, on all cores; x(t) = 0.05(1 − cos 2πt/T) with the period T [ds] as
// argument.
void monteCarloDoublePendulum(benchmark::State& state) {
  const auto plan = info::doublePendulumExperiment(
      info::cosineMotion(0.05, 0.1 * static_cast<double>(state.range(0)), 5, 30, 2));
  info::MonteCarloOptions options;
  options.startSpread = 1;
  int converged = 0;
  double iterations = 0;
  for (auto _ : state) {
    const auto result =
        info::monteCarlo(plan.predictor, plan.truth, plan.covariance, plan.parameters, options);
    converged = result.converged;
    iterations = 0;
    for (const auto& trial : result.trials) iterations += trial.iterations;
  }
  state.counters["converged"] = converged;
  state.counters["iterations"] = iterations / 300;
}
BENCHMARK(monteCarloDoublePendulum)->Arg(50)->Arg(20)->Unit(benchmark::kMillisecond)->UseRealTime();

// One prediction with Γ: what an iteration costs.
void predictionWithSensitivities(benchmark::State& state) {
  const auto plan = info::doublePendulumExperiment(info::doublePendulumStart());
  for (auto _ : state) benchmark::DoNotOptimize(plan.predictor.withSensitivities(plan.truth));
}
BENCHMARK(predictionWithSensitivities)->Unit(benchmark::kMicrosecond);

}  // namespace
