#include "info/dynamics/lagrangian.h"

#include <gtest/gtest.h>

#include "libinfo/dynamics/legendre.h"
#include "robots/cart_double_pendulum.h"

namespace {

using namespace info;

const CartDoublePendulum<> robot;
const Vector<double, 2> q{0.7, -0.4}, qDot{1.3, -2.1}, robotTheta{0.085, 0.5};
const Vector<double, 1> rho(0.2), rhoDot(0.9);

TEST(Momentum, IsTheRateOfTheLagrangianInTheVelocities) {
  const auto p = momentum(robot, q, qDot, rho, rhoDot, robotTheta);
  for (int i = 0; i < 2; ++i) {
    const Vector<double, 2> e = Vector<double, 2>::Unit(i) * 1e-4;
    const double rate =
        (robot.lagrangian(q, Vector<double, 2>(qDot + e), rho, rhoDot, robotTheta) -
         robot.lagrangian(q, Vector<double, 2>(qDot - e), rho, rhoDot, robotTheta)) /
        2e-4;
    EXPECT_NEAR(p[i], rate, 1e-11);
  }
}

TEST(Legendre, UndoesTheMomentum) {
  const auto p = momentum(robot, q, qDot, rho, rhoDot, robotTheta);
  EXPECT_LT((legendre(robot, q, p, rho, rhoDot, robotTheta).qDot - qDot).norm(), 1e-12);
}

TEST(Legendre, EnergyIsKineticPlusPotentialWhereTheCartRests) {
  const Vector<double, 1> still(0.0);
  const auto p = momentum(robot, q, qDot, rho, still, robotTheta);
  // L(q̇) = T − V and L(0) = −V, so T + V = L(q̇) − 2 L(0)
  const double expected =
      robot.lagrangian(q, qDot, rho, still, robotTheta) -
      2.0 * robot.lagrangian(q, Vector<double, 2>(0.0, 0.0), rho, still, robotTheta);
  EXPECT_NEAR(legendre(robot, q, p, rho, still, robotTheta).energy, expected, 1e-14);
}

}  // namespace
