#include "bio/forces/coordinate_force.h"

#include <gtest/gtest.h>

#include "support/arm_models.h"

namespace bio {
namespace {

CoordinateLimitForce limits() {
  CoordinateLimitForce law;
  law.coordinate = "flex";
  law.upperLimit = 1.5;
  law.upperStiffness = 17;
  law.lowerLimit = 0.2;
  law.lowerStiffness = 40;
  law.damping = 0.3;
  law.transition = 0.5;
  return law;
}

template <class Law>
void derivativesMatchDifferences(const Law& law) {
  const double h = 1e-6;
  for (double q = -0.6; q < 2.4; q += 0.0371) {
    for (const double w : {-2.0, 0.0, 1.5}) {
      const auto value = evaluate(law, q, w);
      EXPECT_NEAR((evaluate(law, q + h, w).force - evaluate(law, q - h, w).force) / (2 * h),
                  value.dForce_dq, 1e-6);
      EXPECT_NEAR((evaluate(law, q, w + h).force - evaluate(law, q, w - h).force) / (2 * h),
                  value.dForce_dqDot, 1e-8);
    }
  }
}

TEST(CoordinateForce, DerivativesMatchCentralDifferences) {
  derivativesMatchDifferences(limits());
  derivativesMatchDifferences(SpringGeneralizedForce{"s", "flex", 12, 0.4, 0.7, true});
}

TEST(CoordinateForce, LimitsAreFreeInsideAndStiffBeyondTheTransition) {
  const auto law = limits();
  EXPECT_EQ(evaluate(law, 1.0, 3.0).force, 0);
  EXPECT_DOUBLE_EQ(evaluate(law, 2.1, 0.0).force, -17 * 0.6);
  EXPECT_DOUBLE_EQ(evaluate(law, -0.4, 0.0).force, 40 * 0.6);
  EXPECT_DOUBLE_EQ(evaluate(law, 2.1, 2.0).force, -17 * 0.6 - 0.6);
  EXPECT_DOUBLE_EQ(evaluate(law, 1.75, 0.0).force, -17 * 0.5 * 0.25);  // half way: half stiffness
}

TEST(CoordinateForce, ALimitBelowTheWholeRangeIsAPlainDamper) {
  CoordinateLimitForce law = limits();  // how MoBL-ARMS writes joint damping
  law.upperLimit = law.lowerLimit = 3.3;
  law.upperStiffness = law.lowerStiffness = 1e-8;
  law.transition = 0.01;
  EXPECT_NEAR(evaluate(law, 1.0, 2.0).force, -0.6, 1e-7);
}

TEST(Expression, EvaluatesTheUsualFormulas) {
  const auto value = [](const std::string& text, double q, double qDot) {
    const double x[] = {q, qDot};
    return Expression(text, {"q", "qdot"}).evaluate(x);
  };
  EXPECT_DOUBLE_EQ(value("-10*q-5*qdot", 0.3, 2), -13);
  EXPECT_DOUBLE_EQ(value("-(q^2) + 2*q^-1", 2, 0), -3);
  EXPECT_DOUBLE_EQ(value("-q^2", 3, 0), -9);
  EXPECT_DOUBLE_EQ(value("2-3-4", 0, 0), -5);
  EXPECT_DOUBLE_EQ(value("8/4/2", 0, 0), 1);
  EXPECT_DOUBLE_EQ(value("1.5e1*min(q,qdot)+max(q, qdot)", 2, 3), 33);
  EXPECT_DOUBLE_EQ(value("step(q)*abs(qdot)", -1, -3), 0);
  EXPECT_DOUBLE_EQ(value("abs(qdot)*step(q)", 0, -3), 3);
  EXPECT_NEAR(value("tanh(q)+sinh(q)-cosh(qdot)+atan(q)", 0.7, -0.2),
              std::tanh(0.7) + std::sinh(0.7) - std::cosh(0.2) + std::atan(0.7), 1e-15);
  EXPECT_NEAR(
      value("exp(-3*(q-0.2))*sqrt(4)+log(qdot)*sin(q)*cos(q)*tan(q)*asin(q)*acos(q)", 0.4, 2),
      std::exp(-0.6) * 2 + std::log(2) * std::sin(0.4) * std::cos(0.4) * std::tan(0.4) *
                               std::asin(0.4) * std::acos(0.4),
      1e-14);
}

TEST(Expression, ErrorsSayWhereAndWhat) {
  for (const char* bad :
       {"", "q+", "2*(q", "foo*q", "q q", "sin q", "min(q)", "q^x", "3..2", "*q", ")"}) {
    EXPECT_THROW(Expression(bad, {"q", "qdot"}), std::invalid_argument) << bad;
  }
  EXPECT_THROW(Expression(std::string(5000, '('), {"q"}), std::invalid_argument);
}

TEST(Expression, KnowsWhenItVanishes) {
  const auto vanishes = [](const std::string& text, std::optional<double> c) {
    return Expression(text, {"q", "qdot", "c"}).vanishes({{}, {}, c});
  };
  for (const char* text : {"-c*qdot", "c*tanh(qdot/0.1)", "(2*c)*q + abs(c)*q*qdot", "q*(c-c)",
                           "-c*exp(-(q/0.3)^2)*qdot", "min(c, 1)*q", "sqrt(c)"}) {
    EXPECT_TRUE(vanishes(text, 0)) << text;
    EXPECT_EQ(vanishes(text, 0.5), std::string(text) == "q*(c-c)") << text;
    EXPECT_FALSE(vanishes(text, {})) << text;
  }
  for (const char* text : {"q", "c+q", "c*qdot - q", "exp(c)*q", "q/c", "c/q", "q-q"})
    EXPECT_FALSE(vanishes(text, 0)) << text;
}

TEST(CoordinateForces, AddUpOnlyWhatActsOnFreeCoordinates) {
  Model model = fixtures::threeLinkArm();
  model.limitForces = {limits()};
  model.springForces = {{"spring", "turn", 12, 0.4, 0.7, true}, {"off", "flex", 1, 0, 0, false}};
  model.expressionForces = {{"bushing", "flex", "-2*q^3-0.1*qdot*abs(qdot)", true}};
  const Skeleton skeleton(model, {{"flex"}, {}});
  const CoordinateForces forces(model, skeleton);
  EXPECT_EQ(forces.names().size(), 2u);
  Eigen::Matrix<double, 1, 1> q(1.8), w(-1.5), tau, tau_q, tau_w;
  tau.setZero();
  tau_q.setZero();
  tau_w.setZero();
  forces.add<1>(q, w, tau, tau_q, tau_w);
  const auto limit = evaluate(limits(), 1.8, -1.5);
  EXPECT_NEAR(tau[0], limit.force - 2 * 1.8 * 1.8 * 1.8 + 0.1 * 2.25, 1e-13);
  EXPECT_NEAR(tau_q(0, 0), limit.dForce_dq - 6 * 1.8 * 1.8, 1e-12);
  EXPECT_NEAR(tau_w(0, 0), limit.dForce_dqDot - 0.2 * 1.5, 1e-12);
}

}  // namespace
}  // namespace bio
