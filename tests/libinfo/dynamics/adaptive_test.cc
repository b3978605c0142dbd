#include "info/dynamics/adaptive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "info/dynamics/integrate.h"
#include "libinfo/dynamics/continuous_motion.h"
#include "robots/cart_double_pendulum.h"
#include "support/damped_oscillator.h"
#include "support/pendulum.h"

namespace {

using namespace info;

const std::vector<double> times{0.0, 0.3, 1.0, 2.2, 5.0};
const AdaptiveOptions tight{.relativeTolerance = 1e-11, .absoluteTolerance = 1e-13};

TEST(Integrate, FollowsTheClosedFormOfTheOscillator) {
  const DampedOscillator oscillator{1.3};
  const Vector<double, 2> theta{0.4, 7.0};
  const auto run = integrate(
      oscillator, {0.8, -0.5}, [](double) { return Vector<double, 1>(0.0); }, theta, times, tight);
  ASSERT_TRUE(run.complete);
  ASSERT_EQ(run.times, times);
  for (std::size_t k = 0; k < times.size(); ++k)
    EXPECT_NEAR(run.x[k][0], oscillator.freeMotion(0.8, -0.5, theta, times[k]), 1e-9);
}

TEST(Integrate, ErrorFollowsTheTolerance) {
  const DampedOscillator oscillator;
  const Vector<double, 2> theta{0.4, 7.0};
  const auto error = [&](double tolerance) {
    const auto run =
        integrate(oscillator, {0.8, -0.5}, [](double) { return Vector<double, 1>(0.0); }, theta,
                  times, {.relativeTolerance = tolerance, .absoluteTolerance = tolerance * 1e-2});
    return std::abs(run.x.back()[0] - oscillator.freeMotion(0.8, -0.5, theta, 5.0));
  };
  EXPECT_LT(error(1e-5), 1e-3);
  EXPECT_LT(error(1e-9), 1e-7);
  EXPECT_LT(error(1e-9), 0.01 * error(1e-5));
}

TEST(ContinuousSensitivity, EqualsTheDerivativeOfTheClosedForm) {
  const DampedOscillator oscillator{1.3};
  const Vector<double, 2> theta{0.4, 7.0};
  for (const double time : {0.3, 1.0, 2.2, 5.0}) {
    const auto run = integrateWithSensitivity(
        oscillator, {0.8, -0.5}, [](double) { return Vector<double, 1>(0.0); }, theta, time, tight);
    const auto motion = [&]<class T>(const Vector<T, 2>& t) {
      Vector<T, 1> q;
      q << oscillator.freeMotion(T(0.8), T(-0.5), t, time);
      return q;
    };
    const auto expected = jacobian(motion, theta);
    EXPECT_LT((run.psi.row(0) - expected).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(ContinuousSensitivity, OfTheDoublePendulumAgreesWithFineRungeKuttaSteps) {
  const CartDoublePendulum<> robot;
  const Vector<double, 2> theta{0.085, 0.5};
  const Vector<double, 6> start = Vector<double, 6>::Unit(1) * 0.5;
  const auto u = [](double t) { return Vector<double, 1>(0.3 * std::cos(2.0 * t)); };
  const auto run = integrateWithSensitivity(robot, start, u, theta, 3.0, tight);
  // u is linear inside a step, which costs O(h²): the fine step keeps that below the bound
  const int steps = 30000;
  std::vector<Vector<double, 1>> inputs;
  for (int k = 0; k <= steps; ++k) inputs.push_back(u(3.0 * k / steps));
  const auto fine = simulateWithSensitivity(Rk4<CartDoublePendulum<>>{robot, 3.0 / steps}, start,
                                            Matrix<double, 6, 2>::Zero().eval(), inputs, theta);
  EXPECT_LT((run.x - fine.x.back()).norm(), 1e-6 * fine.x.back().norm());
  EXPECT_LT((run.psi - fine.psi.back()).norm(), 1e-6 * fine.psi.back().norm());
}

/// ẋ = x² reaches infinity at t = 1/x₀.
struct Explosion {
  static constexpr int stateSize = 1, inputSize = 0, parameterSize = 0, outputSize = 1;
  std::vector<std::string> parameterNames() const { return {}; }
  template <class T>
  Vector<T, 1> f(const Vector<T, 1>& x, const Vector<T, 0>&, const Vector<T, 0>&) const {
    Vector<T, 1> xDot;
    xDot << x[0] * x[0];
    return xDot;
  }
  template <class T>
  Vector<T, 1> g(const Vector<T, 1>& x, const Vector<T, 0>&, const Vector<T, 0>&) const {
    return x;
  }
};

TEST(Integrate, ReportsWhereAndWhyItStops) {
  const auto run = integrate(Explosion{}, Vector<double, 1>(1.0),
                             [](double) { return Vector<double, 0>(); }, {}, {0.0, 0.5, 2.0});
  EXPECT_FALSE(run.complete);
  EXPECT_EQ(run.times.size(), 2u);
  EXPECT_NEAR(run.x[1][0], 2.0, 1e-5);
  EXPECT_NEAR(run.reachedTime, 1.0, 1e-3);
  EXPECT_THAT(run.why, testing::HasSubstr("stopped at"));
}

TEST(Integrate, PassesOnWhatTheInputThrows) {
  const auto broken = [](double t) -> Vector<double, 1> {
    if (t > 0.1) throw std::out_of_range("no input there");
    return Vector<double, 1>(0.0);
  };
  EXPECT_THROW(integrate(Pendulum{}, {0.1, 0.0}, broken, {1.0, 0.1}, times), std::out_of_range);
}

TEST(Integrate, NamesEachBrokenRule) {
  const auto none = [](double) { return Vector<double, 1>(0.0); };
  const auto run = [&](std::vector<double> t, AdaptiveOptions o, double start) {
    return integrate(Pendulum{}, {start, 0.0}, none, {1.0, 0.1}, t, o);
  };
  const double nan = std::nan("");
  EXPECT_THROW(run({}, {}, 0.1), std::domain_error);
  EXPECT_THROW(run({0.0, 0.0}, {}, 0.1), std::domain_error);
  EXPECT_THROW(run({0.0, nan}, {}, 0.1), std::domain_error);
  EXPECT_THROW(run({nan}, {}, 0.1), std::domain_error);
  EXPECT_THROW(run({0.0, 1.0}, {.relativeTolerance = nan}, 0.1), std::domain_error);
  EXPECT_THROW(run({0.0, 1.0}, {.absoluteTolerance = 0.0}, 0.1), std::domain_error);
  EXPECT_THROW(run({0.0, 1.0}, {.largestTimeStep = -1.0}, 0.1), std::domain_error);
  EXPECT_THROW(run({0.0, 1.0}, {.maxSteps = 0}, 0.1), std::domain_error);
  EXPECT_THROW(run({0.0, 1.0}, {}, nan), std::domain_error);
}

}  // namespace
