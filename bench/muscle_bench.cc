// Cost of one muscle of each class: rate and balance with state derivatives, derivatives in its
// numbers, rest, and a step of its activation.
#include <benchmark/benchmark.h>

#include <cmath>
#include <random>
#include <vector>

#include "bio/muscle/fibre_rest.h"
#include "bio/muscle/muscle_sensitivity.h"
#include "bio/muscle/muscle_variant.h"

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

template <class Shape>
void inNumbers(benchmark::State& state) {
  overStates<Shape>(state, [](const auto& m, const State& s) {
    return fibreRateInNumbers(m, s.activation, s.fibreLength, s.pathLength);
  });
}

template <class Shape>
void rest(benchmark::State& state) {
  overStates<Shape>(state, [](const auto& m, const State& s) {
    return restingFibre(m, s.activation, s.pathLength);
  });
}

template <class Shape>
void make(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(muscleOf<Shape>());
}

// An excitation that rises and falls like an EMG envelope, 10 ms a step.
template <class Law, bool withDerivatives>
void activation(benchmark::State& state) {
  const Law law;
  std::vector<double> u(1024);
  for (std::size_t i = 0; i < u.size(); ++i) {
    const auto t = 0.01 * static_cast<double>(i);
    u[i] = 0.3 + 0.2 * std::sin(7 * t) + 0.08 * std::sin(31 * t);
  }
  double a = u[0];
  std::size_t i = 0;
  for (auto _ : state) {
    const double next = u[(i + 1) & 1023];
    if constexpr (withDerivatives) {
      const auto step = law.stepWithDerivatives(u[i & 1023], next, a, 0.01);
      a = step.value;
      benchmark::DoNotOptimize(step);
    } else {
      a = law.step(u[i & 1023], next, a, 0.01);
    }
    ++i;
    benchmark::DoNotOptimize(a);
  }
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
BENCHMARK(inNumbers<Thelen>);
BENCHMARK(inNumbers<Millard>);
BENCHMARK(inNumbers<DeGroote>);
BENCHMARK(rest<Thelen>);
BENCHMARK(rest<Millard>);
BENCHMARK(rest<DeGroote>);
BENCHMARK(make<Millard>);
BENCHMARK(activation<FirstOrderActivation<double>, false>);
BENCHMARK(activation<FirstOrderActivation<double>, true>);
BENCHMARK(activation<SmoothActivation<double>, false>);
BENCHMARK(activation<SmoothActivation<double>, true>);

}  // namespace

BENCHMARK_MAIN();
