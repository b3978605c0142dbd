#include <gtest/gtest.h>

#include "info/autodiff/derivatives.h"
#include "robots/cart_double_pendulum.h"
#include "robots/suspended_mass.h"
#include "support/damped_oscillator.h"
#include "support/pendulum.h"

namespace {

using namespace info;

template <class Robot>
void expectEulerLagrange(const Robot& robot, const Vector<double, 2>& theta) {
  const Vector<double, 6> x{0.2, 0.7, -1.1, 0.4, 2.1, -3.3};
  const Vector<double, 1> u(1.7);
  // L of (q, q̇, ρ, ρ̇) and its Hessian give d/dt ∂L/∂q̇ = ∂L/∂q + f, solved for q̈
  const auto lagrangian = [&]<class T>(const Vector<T, 6>& y) {
    Vector<T, 1> L;
    L << robot.lagrangian(Vector<T, 2>(y.template head<2>()),
                          Vector<T, 2>(y.template segment<2>(2)), Vector<T, 1>(y[4]),
                          Vector<T, 1>(y[5]), Vector<T, 2>(theta.template cast<T>()));
    return L;
  };
  Vector<double, 6> y;
  y << x.segment<2>(1), x.tail<2>(), x[0], x[3];
  const auto gradient = jacobian(lagrangian, y);
  const auto H = contractedHessian(lagrangian, y, Vector<double, 1>(1.0));
  const Vector<double, 2> v = x.tail<2>();
  const Vector<double, 2> f =
      robot.force(Vector<double, 2>(y.head<2>()), v, Vector<double, 1>(x[0]),
                  Vector<double, 1>(x[3]), Vector<double, 0>(), theta);
  const Vector<double, 2> moment =
      gradient.template head<2>().transpose() + f - H.template block<2, 2>(2, 0) * v -
      H.template block<2, 1>(2, 4) * x[3] - H.template block<2, 1>(2, 5) * u[0];
  const Vector<double, 2> expected = H.template block<2, 2>(2, 2).inverse() * moment;
  const Vector<double, 6> xDot = robot.f(x, u, theta);
  EXPECT_LT((xDot.tail<2>() - expected).norm(), 1e-12 * expected.norm());
  EXPECT_EQ(xDot[3], u[0]);
  EXPECT_EQ((xDot.head<3>()), (x.tail<3>()));
}

TEST(CartDoublePendulum, EquationsOfMotionAreThoseOfTheLagrangian) {
  expectEulerLagrange(CartDoublePendulum<>{}, {0.085, 0.5});
  CartDoublePendulum<DoublePendulumUnknowns::bothMasses> both;
  both.damping = 2e-3;
  expectEulerLagrange(both, {0.11, 0.07});
}

// The values that a ruler and a scale give: one link still, small swing of the compound pendulum.
TEST(CartDoublePendulum, HasThePotentialAndInertiaOfTheThesisRobot) {
  const CartDoublePendulum<> robot;
  const Vector<double, 2> rest = Vector<double, 2>::Zero(), theta{0.085, 0.5};
  const Vector<double, 1> still(0.0);
  const auto L = [&](Vector<double, 2> q, Vector<double, 2> v, double w) {
    return robot.lagrangian(q, v, still, Vector<double, 1>(w), theta);
  };
  // raised from hanging to horizontal: link 1 by s1, link 2 by the pivot distance and s2
  const double fall = L(rest, rest, 0.0) - L({M_PI / 2, 0.0}, rest, 0.0);
  EXPECT_NEAR(fall, 9.81 * (0.085 * 0.146 + 0.0847 * (0.2796 + 0.125)), 1e-15);
  // the whole translates with the cart
  EXPECT_NEAR(L(rest, rest, 2.0) - L(rest, rest, 0.0), 0.5 * (0.085 + 0.0847) * 4.0, 1e-15);
  // link 1 turns about the cart while link 2, kept upright, is carried along on a circle
  const double inertia1 = 0.085 * (0.146 * 0.146 + (0.305 * 0.305 + 0.0445 * 0.0445) / 12.0);
  EXPECT_NEAR(L(rest, {3.0, -3.0}, 0.0) - L(rest, rest, 0.0),
              0.5 * (inertia1 + 0.0847 * 0.2796 * 0.2796) * 9.0, 1e-15);
  // link 2 alone turns about its pivot
  const double inertia2 = 0.0847 * (0.125 * 0.125 + (0.305 * 0.305 + 0.0381 * 0.0381) / 12.0);
  EXPECT_NEAR(L(rest, {0.0, 3.0}, 0.0) - L(rest, rest, 0.0), 0.5 * inertia2 * 9.0, 1e-15);
}

TEST(CartDoublePendulum, DampingTakesPowerAtBothJoints) {
  const CartDoublePendulum<> robot;
  const Vector<double, 2> v{1.2, -0.7};
  const Vector<double, 1> still(0.0);
  const auto f = robot.force(v, v, still, still, Vector<double, 0>(), Vector<double, 2>(0.1, 0.5));
  EXPECT_DOUBLE_EQ(f.dot(v), -0.5e-3 * v.squaredNorm());
}

TEST(CartDoublePendulum, MeasuresAbsoluteAngles) {
  const CartDoublePendulum<> robot;
  const Vector<double, 6> x{0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
  EXPECT_EQ(robot.g(x, Vector<double, 1>(0.0), Vector<double, 2>(0.1, 0.5)),
            (Vector<double, 2>(0.2, 0.5)));
  EXPECT_EQ(robot.measure(Vector<double, 2>(0.2, 0.3), Vector<double, 1>(0.0),
                          Vector<double, 2>(0.1, 0.5)),
            (Vector<double, 2>(0.2, 0.5)));
}

// Newton's law for the bob at (x − ℓ sin φ, −ℓ cos φ): string and weight are its only forces.
TEST(SuspendedMass, TensionIsWhatNewtonsLawLeavesToTheString) {
  const SuspendedMass robot;
  const Vector<double, 2> theta{0.12, 0.5};
  const Vector<double, 4> x{0.3, 0.8, -0.6, 2.4};
  const Vector<double, 1> u(1.9);
  const auto velocity = [&]<class T>(const Vector<T, 4>& at) {
    using std::cos, std::sin;
    const T speed = theta[1] * at[3];
    Vector<T, 2> v;
    v << at[2] - speed * cos(at[1]), speed * sin(at[1]);
    return v;
  };
  const Vector<double, 2> a = jacobian(velocity, x) * robot.f(x, u, theta);
  const Vector<double, 2> alongString{std::sin(x[1]), std::cos(x[1])};
  const Vector<double, 2> across{std::cos(x[1]), -std::sin(x[1])};
  const Vector<double, 2> stringForce = theta[0] * (a + Vector<double, 2>(0.0, 9.81));
  EXPECT_NEAR(robot.g(x, u, theta)[0], stringForce.dot(alongString), 1e-14);
  EXPECT_NEAR(stringForce.dot(across), 0.0, 1e-14);
}

TEST(SuspendedMass, HangsWithItsWeight) {
  EXPECT_DOUBLE_EQ(SuspendedMass{}.g(Vector<double, 4>::Zero().eval(), Vector<double, 1>(0.0),
                                     Vector<double, 2>(0.12, 0.5))[0],
                   0.12 * 9.81);
}

TEST(Pendulum, GainsTheEnergyOfItsTorqueLessThatOfItsDamping) {
  const Pendulum pendulum{.mass = 0.7};
  const Vector<double, 2> x{0.9, -1.4}, theta{0.6, 0.2};
  const Vector<double, 1> u(0.3);
  const auto energy = [&]<class T>(const Vector<T, 2>& at) {
    Vector<T, 1> E;
    E << pendulum.energy(at, Vector<T, 2>(theta.template cast<T>()));
    return E;
  };
  const double power = jacobian(energy, x) * pendulum.f(x, u, theta);
  EXPECT_NEAR(power, u[0] * x[1] - theta[1] * x[1] * x[1], 1e-14);
}

TEST(Pendulum, SwingsAtTheFrequencyOfItsLength) {
  const Pendulum pendulum;
  const auto f = [&]<class T>(const Vector<T, 2>& x) {
    return pendulum.f(x, Vector<T, 1>(T(0.0)), Vector<T, 2>(T(0.6), T(0.0)));
  };
  const auto A = jacobian(f, Vector<double, 2>(0.0, 0.0));
  EXPECT_NEAR(A(1, 0), -9.81 / 0.6, 1e-12);
}

TEST(DampedOscillator, ClosedFormObeysTheEquationOfMotion) {
  const DampedOscillator oscillator{1.3};
  const Vector<double, 2> theta{0.4, 7.0};
  const double h = 1e-3, t = 0.7;
  const auto q = [&](double at) { return oscillator.freeMotion(0.8, -0.5, theta, at); };
  const double velocity = (q(t + h) - q(t - h)) / (2 * h),
               acceleration = (q(t + h) - 2 * q(t) + q(t - h)) / (h * h);
  const auto xDot = oscillator.f(Vector<double, 2>(q(t), velocity), Vector<double, 1>(0.0), theta);
  EXPECT_NEAR(xDot[1], acceleration, 1e-5);
  EXPECT_DOUBLE_EQ(q(0.0), 0.8);
  EXPECT_NEAR((q(h) - q(-h)) / (2 * h), -0.5, 1e-5);
}

TEST(DampedOscillator, RefusesAClosedFormBeyondCriticalDamping) {
  const DampedOscillator oscillator;
  EXPECT_THROW(oscillator.freeMotion(1.0, 0.0, Vector<double, 2>(2.0, 1.0), 1.0),
               std::domain_error);
  EXPECT_THROW(oscillator.freeMotion(1.0, 0.0, Vector<double, 2>(std::nan(""), 1.0), 1.0),
               std::domain_error);
}

}  // namespace
