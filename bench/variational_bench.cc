// The variational step of the cart double pendulum and its derivatives, one thread.
#include <benchmark/benchmark.h>

#include <cmath>

#include "info/dynamics/sensitivity.h"
#include "info/dynamics/variational.h"
#include "robots/cart_double_pendulum.h"
#include "support/dual_variational_map.h"

namespace {

using namespace info;
using Integrator = VariationalIntegrator<CartDoublePendulum<>>;

constexpr double dt = 0.02;
constexpr int steps = 250;
const Vector<double, 2> theta{0.085, 0.5};

double cart(int k) {
  return 0.1 * std::sin(2.0 * M_PI * dt * k / 2.0);
}

/// Steps along a moving trajectory, each started from the extrapolated configuration, so that
/// neither the branch predictor nor the caches see one and the same point.
template <class Work>
void alongTrajectory(benchmark::State& state, const Work& work) {
  const Integrator integrator({}, dt);
  Integrator::Arguments z{{0.6, -0.3}, {0.0, 0.0}, {}, {}, {}, theta};
  Vector<double, 2> previous = z.q;
  int k = 0;
  double iterations = 0.0;
  for (auto _ : state) {
    if (k % steps == 0) {
      z.q << 0.6, -0.3;
      z.p.setZero();
      previous = z.q;
      k = 0;
    }
    z.rho0[0] = cart(k);
    z.rho1[0] = cart(++k);
    const auto taken = integrator.step(z, 2.0 * z.q - previous);
    if (!taken.converged) state.SkipWithError("no solution");
    work(integrator, z, taken);
    iterations += taken.iterations;
    previous = z.q;
    z.q = taken.q1;
    z.p = taken.p1;
  }
  state.counters["newton"] = iterations / double(state.iterations());
}

void Step(benchmark::State& state) {
  alongTrajectory(state, [](const auto&, const auto&, const auto& taken) {
    benchmark::DoNotOptimize(taken.p1.data());
  });
}
BENCHMARK(Step);

void StepWithFirstDerivatives(benchmark::State& state) {
  alongTrajectory(state, [](const auto& integrator, const auto& z, const auto& taken) {
    auto d = integrator.firstDerivatives(z, taken);
    benchmark::DoNotOptimize(d.data());
    benchmark::ClobberMemory();
  });
}
BENCHMARK(StepWithFirstDerivatives);

void StepWithSecondDerivatives(benchmark::State& state) {
  alongTrajectory(state, [](const auto& integrator, const auto& z, const auto& taken) {
    auto d = integrator.secondDerivatives(z, taken);
    benchmark::DoNotOptimize(d.second[3].data());
    benchmark::ClobberMemory();
  });
}
BENCHMARK(StepWithSecondDerivatives);

void StepWithContractedSecondDerivatives(benchmark::State& state) {
  alongTrajectory(state, [](const auto& integrator, const auto& z, const auto& taken) {
    auto d =
        integrator.contractedSecondDerivatives(z, taken, Vector<double, 4>(1.0, 2.0, 3.0, 4.0));
    benchmark::DoNotOptimize(d.data());
    benchmark::ClobberMemory();
  });
}
BENCHMARK(StepWithContractedSecondDerivatives);

void FiveSecondsWithTwoSensitivities(benchmark::State& state) {
  const Integrator integrator({}, dt);
  std::vector<Integrator::Input> inputs;
  for (int k = 0; k <= steps; ++k) inputs.emplace_back(cart(k));
  const Integrator::State x0{0.6, -0.3, 0.0, 0.0};
  for (auto _ : state) {
    auto run =
        simulateWithSensitivity(integrator, x0, Matrix<double, 4, 2>::Zero().eval(), inputs, theta);
    if (!run.complete) state.SkipWithError("no solution");
    benchmark::DoNotOptimize(run.psi.back().data());
  }
}
BENCHMARK(FiveSecondsWithTwoSensitivities)->Unit(benchmark::kMillisecond);

/// The same step and first derivatives by nested dual numbers, for comparison.
void StepWithFirstDerivativesByDualNumbers(benchmark::State& state) {
  const DualVariationalMap<CartDoublePendulum<>> map{{}, dt};
  const Integrator::State x{0.6, -0.3, 0.001, 0.0005};
  for (auto _ : state) {
    auto d = linearise(map, x, Integrator::Input(0.0), Integrator::Input(0.006), theta);
    benchmark::DoNotOptimize(d);
  }
}
BENCHMARK(StepWithFirstDerivativesByDualNumbers);

}  // namespace
