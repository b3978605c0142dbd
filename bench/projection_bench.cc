// One iteration of the discrete projection on the cart double pendulum: 250 steps of 0.02 s, ψ for
// two parameters, exact information; and the whole optimisation to λ_min × 100 and beyond.
#include <benchmark/benchmark.h>

#include "info/design/discrete_projection.h"
#include "info/design/projection.h"
#include "robots/robot_designs.h"

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

// The same robot in continuous time, 250 nodes; the argument says how Riccati is integrated.
void ContinuousDirection(benchmark::State& state) {
  FlowTask task = doublePendulumFlowTask(0.02);
  task.design.riccati =
      state.range(0) == 0 ? RiccatiIntegration::rungeKutta : RiccatiIntegration::adaptive;
  FlowProjection projection(task.system, task.design);
  for (auto _ : state) benchmark::DoNotOptimize(projection.findDirection(1e-9));
}
BENCHMARK(ContinuousDirection)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

// One direction for five candidates of θ at once.
void RobustDirection(benchmark::State& state) {
  const StepTask task = doublePendulumStepTask();
  std::vector<ExtendedStepMap> all;
  for (double m1 : {0.06, 0.07, 0.085, 0.1, 0.12})
    all.push_back(doublePendulumSteps(0.02, 1e-2, {m1, 0.05}));
  StepProjection projection(stack(all), task.design);
  for (auto _ : state) benchmark::DoNotOptimize(projection.findDirection(1e-9));
}
BENCHMARK(RobustDirection)->Unit(benchmark::kMillisecond);

}  // namespace
