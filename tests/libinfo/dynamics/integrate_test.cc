#include "info/dynamics/integrate.h"

#include <gtest/gtest.h>

#include "info/dynamics/sensitivity.h"
#include "libinfo/dynamics/continuous_motion.h"
#include "libinfo/dynamics/legendre.h"
#include "robots/instances.h"
#include "support/damped_oscillator.h"

namespace {

using namespace info;

/// log₂ of the errors at h and h/2.
double order(double coarse, double fine) {
  return std::log2(coarse / fine);
}

struct Errors {
  double state, sensitivity;
};

template <class Map>
Errors oscillatorErrors(int steps) {
  const double duration = 2.0;
  const Vector<double, 2> theta{0.4, 7.0};
  const DampedOscillator oscillator{1.3};
  const Map map{oscillator, duration / steps};
  const std::vector<Vector<double, 1>> none(std::size_t(steps + 1), Vector<double, 1>(0.0));
  const auto run =
      simulateWithSensitivity(map, {0.8, -0.5}, Matrix<double, 2, 2>::Zero().eval(), none, theta);
  const auto motion = [&]<class T>(const Vector<T, 2>& t) {
    Vector<T, 1> q;
    q << oscillator.freeMotion(T(0.8), T(-0.5), t, duration);
    return q;
  };
  const auto exact = differentiate(motion, theta);
  return {std::abs(run.x.back()[0] - exact.value[0]),
          (run.psi.back().row(0) - exact.jacobian).norm()};
}

TEST(Rk4, IsOfOrderFourInStateAndSensitivity) {
  const Errors coarse = oscillatorErrors<Rk4<DampedOscillator>>(80);
  const Errors fine = oscillatorErrors<Rk4<DampedOscillator>>(160);
  EXPECT_NEAR(order(coarse.state, fine.state), 4.0, 0.1);
  EXPECT_NEAR(order(coarse.sensitivity, fine.sensitivity), 4.0, 0.1);
}

TEST(ImplicitMidpoint, IsOfOrderTwoInStateAndSensitivity) {
  const Errors coarse = oscillatorErrors<ImplicitMidpoint<DampedOscillator>>(80);
  const Errors fine = oscillatorErrors<ImplicitMidpoint<DampedOscillator>>(160);
  EXPECT_NEAR(order(coarse.state, fine.state), 2.0, 0.1);
  EXPECT_NEAR(order(coarse.sensitivity, fine.sensitivity), 2.0, 0.1);
}

/// The damped double pendulum on a moving cart, against CVODES on the equations of state and
/// sensitivity.
Errors pendulumErrors(int steps, Forcing forcing) {
  using Robot = CartDoublePendulum<>;
  const double duration = 1.5, omega = 3.0;
  Robot robot;
  robot.dampingUnit = 20e-3;  // enough damping for the forcing to matter
  const Vector<double, 2> theta{0.085, 0.5};
  const Vector<double, 6> start{0.0, 0.5, -0.3, 0.0, 0.0, 0.0};
  const auto u = [&](double t) {
    return Vector<double, 1>(0.05 * omega * omega * std::cos(omega * t));
  };
  const auto exact = integrateWithSensitivity(
      robot, start, u, theta, duration, {.relativeTolerance = 1e-12, .absoluteTolerance = 1e-13});
  const VariationalIntegrator<Robot> integrator(robot, duration / steps, forcing);
  std::vector<Vector<double, 1>> inputs;
  for (int k = 0; k <= steps; ++k)
    inputs.emplace_back(0.05 * (1.0 - std::cos(omega * duration * k / steps)));
  const auto run = simulateWithSensitivity(integrator, {0.5, -0.3, 0.0, 0.0},
                                           Matrix<double, 4, 2>::Zero().eval(), inputs, theta);
  return {(run.x.back().head<2>() - exact.x.segment<2>(1)).norm(),
          (run.psi.back().topRows<2>() - exact.psi.middleRows<2>(1)).norm()};
}

TEST(VariationalIntegrator, IsOfOrderTwoInStateAndSensitivityWithSymmetricForcing) {
  const Errors coarse = pendulumErrors(400, Forcing::symmetric);
  const Errors fine = pendulumErrors(800, Forcing::symmetric);
  EXPECT_NEAR(order(coarse.state, fine.state), 2.0, 0.1);
  EXPECT_NEAR(order(coarse.sensitivity, fine.sensitivity), 2.0, 0.1);
}

TEST(VariationalIntegrator, IsOfOrderOneInStateAndSensitivityWithLeftForcing) {
  const Errors coarse = pendulumErrors(800, Forcing::left);
  const Errors fine = pendulumErrors(1600, Forcing::left);
  EXPECT_NEAR(order(coarse.state, fine.state), 1.0, 0.1);
  EXPECT_NEAR(order(coarse.sensitivity, fine.sensitivity), 1.0, 0.1);
}

// Undamped and with the cart at rest the energy oscillates within a band and drifts nowhere.
TEST(VariationalIntegrator, KeepsTheEnergyOfTheDoublePendulumOverAHundredThousandSteps) {
  using Robot = CartDoublePendulum<DoublePendulumUnknowns::bothMasses>;
  const Robot robot;
  const Vector<double, 2> theta{0.085, 0.0847};
  const VariationalIntegrator<Robot> integrator(robot, 0.02);
  VariationalIntegrator<Robot>::Arguments z;
  z.q << 1.0, -0.6;
  z.p.setZero();
  z.rho0[0] = z.rho1[0] = 0.0;
  z.theta = theta;
  const Vector<double, 1> still(0.0);
  const auto energy = [&] { return legendre(robot, z.q, z.p, still, still, theta).energy; };
  const double first = energy();
  Vector<double, 2> previous = z.q;
  constexpr int blocks = 100, blockSteps = 1000;
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(blocks);
  double farthest = 0.0;
  for (int b = 0; b < blocks; ++b)
    for (int k = 0; k < blockSteps; ++k) {
      const auto taken = integrator.step(z, 2.0 * z.q - previous);
      ASSERT_TRUE(taken.converged);
      previous = z.q;
      z.q = taken.q1;
      z.p = taken.p1;
      const double E = energy();
      farthest = std::max(farthest, std::abs(E - first));
      mean[b] += E / blockSteps;
    }
  // height of the energy above that of hanging at rest sets the scale
  const double scale =
      first + robot.lagrangian(Vector<double, 2>::Zero().eval(), Vector<double, 2>::Zero().eval(),
                               still, still, theta);
  EXPECT_LT(farthest, 0.004 * scale);  // measured 0.0019
  // slope of the block means by least squares, against its own standard error
  const Eigen::VectorXd t = Eigen::VectorXd::LinSpaced(blocks, -1.0, 1.0);
  const double slope = t.dot(mean) / t.squaredNorm();
  const Eigen::VectorXd rest = (mean.array() - mean.mean()).matrix() - slope * t;
  const double error = std::sqrt(rest.squaredNorm() / (blocks - 2) / t.squaredNorm());
  EXPECT_LT(std::abs(slope), 3.0 * error);
  EXPECT_LT(std::abs(slope), 2e-5 * scale);  // measured 5e-6 over half the run
  RecordProperty("band", std::to_string(farthest / scale));
  RecordProperty("slope", std::to_string(slope / scale));
}

}  // namespace
