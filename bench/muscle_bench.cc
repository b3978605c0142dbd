// Cost of one muscle of each class: state derivatives, force balance, parameters, activation.
#include <benchmark/benchmark.h>

#include <random>
#include <vector>

#include "bio/muscle/degroote_fregly2016.h"
#include "bio/muscle/hill_muscle.h"
#include "bio/muscle/millard2012.h"
#include "bio/muscle/thelen2003.h"

namespace {

using namespace bio::muscles;

struct State {
  double activation, fibreLength, pathLength, fibreVelocity, pathSpeed;
};

// States as a simulation visits them: spread over the curves, so that no branch is learnt by heart.
template <class Muscle>
std::vector<State> states(const Muscle& muscle) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto& p = muscle.parameters();
  std::vector<State> states(1024);
  for (State& s : states) {
    s.activation = 0.02 + 0.98 * unit(random);
    s.fibreLength = p.optimalFibreLength * (0.6 + 0.8 * unit(random));
    s.pathLength = s.fibreLength * 0.98 + p.tendonSlackLength * (1 + 0.03 * unit(random));
    s.fibreVelocity = p.optimalFibreLength * (2 * unit(random) - 1);
    s.pathSpeed = 0.2 * unit(random) - 0.1;
  }
  return states;
}

template <class Shape>
HillMuscle<Shape> muscleOf() {
  typename Shape::Parameters p;
  p.pennation = 0.2;
  return HillMuscle<Shape>(p);
}

template <class Shape, class Evaluate>
void overStates(benchmark::State& state, const Evaluate& evaluate) {
  const HillMuscle<Shape> muscle = muscleOf<Shape>();
  const std::vector<State> all = states(muscle);
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(evaluate(muscle, all[i++ & 1023]));
}

template <class Shape>
void rate(benchmark::State& state) {
  overStates<Shape>(state, [](const auto& m, const State& s) {
    return m.fibreRate(s.activation, s.fibreLength, s.pathLength);
  });
}

template <class Shape>
void balance(benchmark::State& state) {
  overStates<Shape>(state, [](const auto& m, const State& s) {
    return m.fibreBalance(s.activation, s.fibreLength, s.pathLength, s.fibreVelocity);
  });
}

template <class Shape>
void rigid(benchmark::State& state) {
  overStates<Shape>(state, [](const auto& m, const State& s) {
    return m.rigidRate(s.activation, s.pathLength, s.pathSpeed);
  });
}

using Thelen = Thelen2003<double>;
using Millard = Millard2012<double>;
using DeGroote = DeGrooteFregly2016<double>;
BENCHMARK(rate<Thelen>);
BENCHMARK(rate<Millard>);
BENCHMARK(rate<DeGroote>);
BENCHMARK(balance<Thelen>);
BENCHMARK(balance<Millard>);
BENCHMARK(balance<DeGroote>);
BENCHMARK(rigid<Millard>);
BENCHMARK(rigid<DeGroote>);

}  // namespace

BENCHMARK_MAIN();
