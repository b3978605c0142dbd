#include "info/dynamics/sensitivity.h"

#include <gtest/gtest.h>

#include "info/dynamics/integrate.h"
#include "robots/suspended_mass.h"
#include "support/damped_oscillator.h"
#include "support/pendulum.h"

namespace {

using namespace info;

static_assert(SmoothSystem<DampedOscillator>);
static_assert(SmoothSystem<Pendulum>);
static_assert(SmoothSystem<SuspendedMass>);
static_assert(ExplicitStepMap<Rk4<Pendulum>>);
static_assert(ImplicitStepMap<ImplicitMidpoint<Pendulum>> &&
              !ExplicitStepMap<ImplicitMidpoint<Pendulum>>);

const Vector<double, 2> start{0.9, -0.4}, pendulumTheta{0.7, 0.12};

std::vector<Vector<double, 1>> torque(std::size_t steps) {
  std::vector<Vector<double, 1>> u;
  for (std::size_t k = 0; k <= steps; ++k) u.emplace_back(0.8 * std::sin(0.3 * double(k)));
  return u;
}

template <class Map>
class SensitivityOfMap : public testing::Test {
 public:
  Map map{Pendulum{}, 0.02};
  std::vector<Vector<double, 1>> u = torque(60);
};
using Maps = testing::Types<Rk4<Pendulum>, ImplicitMidpoint<Pendulum>>;
TYPED_TEST_SUITE(SensitivityOfMap, Maps);

TYPED_TEST(SensitivityOfMap, FirstIsTheDerivativeOfTheStepsTaken) {
  const auto run = simulateWithSensitivity(this->map, start, Matrix<double, 2, 2>::Zero().eval(),
                                           this->u, pendulumTheta);
  ASSERT_TRUE(run.complete);
  const auto last = [&](const Vector<double, 2>& t) {
    return simulate(this->map, start, this->u, t).x.back();
  };
  const Matrix<double, 2, 2> difference = finiteDifferenceJacobian(last, pendulumTheta);
  EXPECT_LT((run.psi.back() - difference).norm(), 1e-8 * difference.norm());
  EXPECT_EQ(run.x.back(), last(pendulumTheta));
}

TYPED_TEST(SensitivityOfMap, AdjointSweepIsTheDerivativeOfTheWeightedFirst) {
  const Matrix<double, 2, 2> zero = Matrix<double, 2, 2>::Zero();
  const auto run = simulateWithSensitivity(this->map, start, zero, this->u, pendulumTheta);
  std::vector<Vector<double, 2>> weights;
  for (std::size_t k = 0; k < run.x.size(); ++k)
    weights.emplace_back(std::cos(double(k)), 0.1 * double(k));
  const auto weighted = [&](const Vector<double, 2>& t) {
    const auto moved = simulateWithSensitivity(this->map, start, zero, this->u, t);
    Vector<double, 2> sum = Vector<double, 2>::Zero();
    for (std::size_t k = 0; k < weights.size(); ++k) sum += moved.psi[k].transpose() * weights[k];
    return sum;
  };
  const Matrix<double, 2, 2> difference = finiteDifferenceJacobian(weighted, pendulumTheta);
  const auto swept = contractSecondSensitivity(this->map, run, this->u, pendulumTheta, weights);
  EXPECT_LT((swept - difference).norm(), 1e-7 * difference.norm());
}

TEST(Simulate, RefusesAnEmptyInput) {
  EXPECT_THROW(simulate(Rk4<Pendulum>{{}, 0.01}, start, {}, pendulumTheta), DimensionError);
}

TEST(ContractSecondSensitivity, RefusesATrajectoryWithoutPsiAndWeightsOfAnotherLength) {
  const Rk4<Pendulum> map{{}, 0.01};
  const auto u = torque(3);
  EXPECT_THROW(contractSecondSensitivity(map, simulate(map, start, u, pendulumTheta), u,
                                         pendulumTheta, {start}),
               DimensionError);
  const auto run =
      simulateWithSensitivity(map, start, Matrix<double, 2, 2>::Zero().eval(), u, pendulumTheta);
  EXPECT_THROW(contractSecondSensitivity(map, run, u, pendulumTheta, {start}), DimensionError);
}

}  // namespace
