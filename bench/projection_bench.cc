// One iteration of the discrete projection on the cart double pendulum: 250 steps of 0.02 s, ψ for
// two parameters, exact information; and the whole optimisation to λ_min × 100 and beyond.
#include <benchmark/benchmark.h>

#include "info/systems/robot_designs.h"

namespace {

using namespace info;

void WholeOptimisation(benchmark::State& state) {
  const StepTask task = doublePendulumStepTask();
  SearchOptions options;
  options.slopeTolerance = 0.01;
  double iterations = 0, trials = 0;
  for (auto _ : state) {
    StepProjection projection(task.system, task.design);
    const SearchResult result = search(projection, options);
    if (!result.converged) state.SkipWithError("no minimum");
    iterations += result.iterations;
    trials += result.trials;
  }
  const double runs = double(state.iterations());
  state.counters["iterations"] = iterations / runs;
  state.counters["trials"] = trials / runs;
  state.counters["per_iteration"] =
      benchmark::Counter(iterations, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(WholeOptimisation)->Unit(benchmark::kMillisecond);

void Direction(benchmark::State& state) {
  const StepTask task = doublePendulumStepTask();
  StepProjection projection(task.system, task.design);
  for (auto _ : state) benchmark::DoNotOptimize(projection.findDirection(1e-9));
}
BENCHMARK(Direction)->Unit(benchmark::kMillisecond);

void Trial(benchmark::State& state) {
  const StepTask task = doublePendulumStepTask();
  StepProjection projection(task.system, task.design);
  const double step = 1e-3 / projection.findDirection(1e-9).largestMove;
  for (auto _ : state) benchmark::DoNotOptimize(projection.trial(step));
}
BENCHMARK(Trial)->Unit(benchmark::kMillisecond);

}  // namespace
