#include "info/design/sequential_action_control.h"

#include <gmock/gmock.h>

#include "robots/instances.h"

namespace {

using namespace info;
using testing::HasSubstr;

using Length = LengthUnknown;
using Both = MassAndLengthUnknown;

InformationRateCost<Length> lengthCost() {
  InformationRateCost<Length> cost;
  cost.inverseCovariance(0, 0) = 40;
  cost.epsilon = 0.5;
  cost.stateWeight = Vector<double, 4>(20, 1, 2, 0.3).asDiagonal();
  cost.desired << 0.1, 0.2, -0.1, 0.3;
  return cost;
}

SequentialActionControl<Length> lengthControl(const ActionOptions& options = {},
                                              InformationRateCost<Length> cost = lengthCost()) {
  return {Length{{}, {0.2, 0.45}},    cost,   Vector<double, 1>(-6), Vector<double, 1>(6),
          Matrix<double, 1, 1>(0.01), options};
}

const Vector<double, 4> kState(-0.25, 0.4, 0.3, -1.1);
const Vector<double, 4> kPsi(0, 0.2, 0, -0.7);
const Vector<double, 1> kLength(0.42);

// dJ/dΔt of an action at t from the costs of ever shorter ones: Richardson on one-sided
// differences.
template <class C, class X, class P, class T, class U>
double needleSlope(const C& control, const X& x, const P& psi, const T& theta, const U& u,
                   double t) {
  const auto slope = [&](double d) {
    return (control.predictedCost(x, psi, theta, u, t, d) -
            control.predictedCost(x, psi, theta, U(U::Zero()), t, d)) /
           d;
  };
  return (8 * slope(2.5e-4) - 6 * slope(5e-4) + slope(1e-3)) / 3;
}

TEST(SequentialActionControl, HasTheInsertionGradientOfANeedleVariation) {
  auto control = lengthControl({.step = 0.001});
  const auto action = control.decide(kState, kPsi, kLength);
  ASSERT_EQ(action.why, ActionEnd::acts);
  for (std::size_t k : {0ul, 200ul, 600ul, 1000ul})
    for (double u : {-6.0, -0.5, 2.0, 6.0}) {
      const Vector<double, 1> value(u);
      const double expected =
          needleSlope(control, kState, kPsi, kLength, value, control.nodeTime(k));
      EXPECT_NEAR(control.insertionGradient(k, value), expected, 2e-4 * std::abs(expected) + 1e-4)
          << "node " << k << ", u " << u;
    }
  EXPECT_EQ(action.slope, control.insertionGradient(0, action.value));
}

TEST(SequentialActionControl, HasTheInsertionGradientForMassAndLength) {
  InformationRateCost<Both> cost;
  cost.inverseCovariance(0, 0) = 40;
  cost.epsilon = 0.5;
  cost.scale << 0.05, 0.1;
  cost.stateWeight(0, 0) = 3;
  SequentialActionControl<Both> control({{}, {0.2, 0.45}}, cost, Vector<double, 1>(-6),
                                        Vector<double, 1>(6), Matrix<double, 1, 1>(0.01),
                                        {.step = 0.001});
  Matrix<double, 4, 2> psi;
  psi << 0, 0, 0.1, 0.2, 0, 0, 0.4, -0.7;
  const Vector<double, 2> theta(0.21, 0.4);
  control.decide(kState, psi, theta);
  for (std::size_t k : {0ul, 500ul}) {
    const Vector<double, 1> value(3);
    const double expected = needleSlope(control, kState, psi, theta, value, control.nodeTime(k));
    EXPECT_NEAR(control.insertionGradient(k, value), expected, 2e-4 * std::abs(expected) + 1e-4);
  }
}

TEST(SequentialActionControl, HasTheInputSlopeAsDerivativeOfTheInsertionGradient) {
  auto control = lengthControl();
  control.decide(kState, kPsi, kLength);
  for (std::size_t k : {0ul, 10ul, 30ul, 60ul}) {
    const double h = 1e-4;
    const double difference = (control.insertionGradient(k, Vector<double, 1>(h)) -
                               control.insertionGradient(k, Vector<double, 1>(-h))) /
                              (2 * h);
    EXPECT_NEAR(control.inputSlope(k)[0], difference, 1e-6 * (1 + std::abs(difference)));
  }
}

// The costate by Runge–Kutta on cubics: order 4, from both sides.
TEST(SequentialActionControl, ConvergesWithFourthOrderInItsStep) {
  const auto slope = [](double step) {
    auto control = lengthControl({.step = step});
    control.decide(kState, kPsi, kLength);
    return control.inputSlope(0)[0];
  };
  const double exact = slope(0.00125);
  const double order = std::log2(std::abs(slope(0.04) - exact) / std::abs(slope(0.02) - exact));
  EXPECT_GT(order, 3.5);  // measured 4.0
  EXPECT_LT(order, 5.0);
}

// Of a double integrator with l = x², J and the action are known in closed form.
struct Cart {
  static constexpr int stateSize = 2, inputSize = 1, parameterSize = 1, outputSize = 1;
  std::vector<std::string> parameterNames() const { return {"gain"}; }
  template <class T>
  Vector<T, 2> f(const Vector<T, 2>& x, const Vector<T, 1>& u, const Vector<T, 1>&) const {
    Vector<T, 2> xDot;
    xDot << x[1], u[0];
    return xDot;
  }
  template <class T>
  Vector<T, 1> g(const Vector<T, 2>&, const Vector<T, 1>&, const Vector<T, 1>& theta) const {
    return theta;
  }
};

SequentialActionControl<Cart> cartControl(double limit, const ActionOptions& options = {}) {
  InformationRateCost<Cart> cost;
  cost.inverseCovariance(0, 0) = 1;
  cost.epsilon = 1;  // Γ = 1: l = 1/2 + x²
  cost.stateWeight(0, 0) = 1;
  return {
      {},     cost, Vector<double, 1>(-limit), Vector<double, 1>(limit), Matrix<double, 1, 1>(0.5),
      options};
}

TEST(SequentialActionControl, KnowsTheCartInClosedForm) {
  const ActionOptions options{.horizon = 2, .step = 0.1, .descentRate = -3};
  auto control = cartControl(1e6, options);
  const auto action = control.decide({1, 0}, Vector<double, 2>::Zero(), Vector<double, 1>(1));
  // J0 = ∫ (1 + 1/2) dt = 3, ρ_x = 2(T − t), ρ_v = (T − t)²; b(0) = 4
  EXPECT_NEAR(action.nominalCost, 3, 1e-12);
  EXPECT_NEAR(control.inputSlope(0)[0], 4, 1e-12);
  EXPECT_NEAR(control.inputSlope(10)[0], 1, 1e-12);
  EXPECT_NEAR(action.value[0], 4 * -9 / (16 + 0.5), 1e-12);
  EXPECT_NEAR(action.slope, 4 * action.value[0], 1e-12);
  // 0.2 s of u: x = 1 + u t²/2, then 1 + u(0.02 + 0.2(t − 0.2))
  const double u = action.value[0], d = 0.2;
  const auto cubed = [](double x) { return x * x * x; };
  double expected = 1 + d + u * cubed(d) / 3 + u * u * std::pow(d, 5) / 20;
  const double v = u * d, x1 = 1 + u * d * d / 2;
  expected += (cubed(x1 + v * (2 - d)) - cubed(x1)) / (3 * v);
  EXPECT_EQ(action.why, ActionEnd::acts);
  EXPECT_EQ(action.duration, 0.2);
  EXPECT_NEAR(action.cost, expected, 1e-5);  // measured 1.2e-6: the integrand is of order 4
}

TEST(SequentialActionControl, SaturatesTheActionAndStillDescends) {
  auto control = cartControl(0.25, {.horizon = 2, .step = 0.1});
  const auto left = control.decide({1, 0}, Vector<double, 2>::Zero(), Vector<double, 1>(1));
  EXPECT_EQ(left.value[0], -0.25);
  EXPECT_LT(left.cost, left.nominalCost);
  EXPECT_EQ(control.decide({-1, 0}, Vector<double, 2>::Zero(), Vector<double, 1>(1)).value[0],
            0.25);
}

TEST(SequentialActionControl, HalvesTheDurationUntilTheCostFalls) {
  // a hard push for long overshoots; for short it helps
  auto control = cartControl(
      1e6, {.horizon = 2, .step = 0.1, .descentRate = -30, .firstDuration = 1.6, .maxHalvings = 6});
  const Vector<double, 1> theta(1);
  const auto action = control.decide({1, 0}, Vector<double, 2>::Zero(), theta);
  ASSERT_EQ(action.why, ActionEnd::acts);
  EXPECT_GT(action.trials, 1);
  EXPECT_DOUBLE_EQ(action.duration, 1.6 / std::pow(2, action.trials - 1));
  EXPECT_GE(control.predictedCost({1, 0}, Vector<double, 2>::Zero(), theta, action.value, 0,
                                  2 * action.duration),
            action.nominalCost);
  auto impatient = cartControl(
      1e6, {.horizon = 2, .step = 0.1, .descentRate = -30, .firstDuration = 1.6, .maxHalvings = 0});
  const auto none = impatient.decide({1, 0}, Vector<double, 2>::Zero(), theta);
  EXPECT_EQ(none.why, ActionEnd::noImprovement);
  EXPECT_EQ(none.value[0], 0);
}

TEST(SequentialActionControl, WaitsForABetterTimeWhenItMay) {
  const ActionOptions now{.step = 0.02}, search{.step = 0.02, .searchTime = true};
  auto atOnce = lengthControl(now), patient = lengthControl(search);
  const auto first = atOnce.decide(kState, kPsi, kLength);
  const auto best = patient.decide(kState, kPsi, kLength);
  EXPECT_EQ(first.start, 0);
  const auto waiting = [&](const Action<1>& action) {
    return action.value.norm() + action.slope + std::pow(action.start, 1.6);
  };
  EXPECT_LE(waiting(best), waiting(first));
  EXPECT_LT(best.cost, best.nominalCost);
  // no node is better
  for (std::size_t k = 0; k + 1 < patient.nodes(); ++k)
    for (double u : {-6.0, 6.0}) {
      const Vector<double, 1> value(u);
      if (patient.inputSlope(k)[0] * u < -1) {
        EXPECT_GE(6 + patient.insertionGradient(k, value) + std::pow(patient.nodeTime(k), 1.6),
                  waiting(best) - 1e-9);
      }
    }
}

TEST(SequentialActionControl, DoesNothingAtRestWithoutATrackingBias) {
  InformationRateCost<Length> cost;
  cost.inverseCovariance(0, 0) = 400;
  const Vector<double, 4> rest(-0.25, 0, 0, 0), psi = Vector<double, 4>::Zero();
  auto idle = lengthControl({}, cost);
  const auto none = idle.decide(rest, psi, kLength);
  EXPECT_EQ(none.why, ActionEnd::noGradient);
  EXPECT_EQ(none.value[0], 0);
  EXPECT_THAT(describe(none.why), HasSubstr("no input would change the cost"));
  cost.stateWeight(0, 0) = 20;
  auto biased = lengthControl({}, cost);
  const auto moves = biased.decide(rest, psi, kLength);
  EXPECT_EQ(moves.why, ActionEnd::acts);
  EXPECT_GT(moves.value[0], 0);
}

TEST(SequentialActionControl, ReportsAMotionThatDoesNotStayFinite) {
  auto control = lengthControl();
  const auto action = control.decide(kState, kPsi, Vector<double, 1>(0.0));
  EXPECT_EQ(action.why, ActionEnd::notFinite);
  EXPECT_EQ(action.value[0], 0);
}

TEST(SequentialActionControl, NamesTheRuleThatIsBroken) {
  const auto message = [](const ActionOptions& options) {
    try {
      lengthControl(options);
      return std::string();
    } catch (const std::domain_error& e) {
      return std::string(e.what());
    }
  };
  EXPECT_THAT(message({.horizon = 0}), HasSubstr("horizon [s]: 0, must be > 0"));
  EXPECT_THAT(message({.horizon = std::nan("")}), HasSubstr("horizon"));
  EXPECT_THAT(message({.step = 2}), HasSubstr("step [s]: 2, must be > 0, ≤ horizon"));
  EXPECT_THAT(message({.descentRate = 1}), HasSubstr("descent rate [1/s]: 1, must be < 0"));
  EXPECT_THAT(message({.firstDuration = 3}), HasSubstr("first duration [s]: 3"));
  EXPECT_THAT(message({.maxHalvings = -1}), HasSubstr("halvings: -1"));
  EXPECT_THAT(message({.improvement = 1}), HasSubstr("improvement: 1"));
  EXPECT_THAT(message({.waitingExponent = 0}), HasSubstr("waiting exponent: 0"));
  const auto thrown = [](auto&& make) {
    try {
      make();
      return std::string();
    } catch (const std::domain_error& e) {
      return std::string(e.what());
    }
  };
  const Length system{{}, {0.2, 0.45}};
  const auto with = [&](double lower, double upper, double R, InformationRateCost<Length> cost) {
    return thrown([&] {
      SequentialActionControl<Length>(system, cost, Vector<double, 1>(lower),
                                      Vector<double, 1>(upper), Matrix<double, 1, 1>(R));
    });
  };
  EXPECT_THAT(with(0, 6, 1, lengthCost()), HasSubstr("0 to 6, must satisfy lower < 0 < upper"));
  EXPECT_THAT(with(-6, std::nan(""), 1, lengthCost()), HasSubstr("must satisfy lower < 0 < upper"));
  EXPECT_THAT(with(-6, 6, 0, lengthCost()), HasSubstr("input weight R"));
  auto cost = lengthCost();
  cost.epsilon = 0;
  EXPECT_THAT(with(-6, 6, 1, cost), HasSubstr("epsilon: 0, must be > 0"));
  cost = lengthCost();
  cost.stateWeight(1, 1) = -1;
  EXPECT_THAT(with(-6, 6, 1, cost), HasSubstr("state weight Q"));
  cost = lengthCost();
  cost.scale[0] = 0;
  EXPECT_THAT(with(-6, 6, 1, cost), HasSubstr("scale of a parameter: 0"));
}

}  // namespace
