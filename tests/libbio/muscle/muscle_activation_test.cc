// Activation laws: rates from a prototype, steps against a fine Runge–Kutta integration of the
// rate, derivatives of the step against differences of the step.
#include <gtest/gtest.h>

#include <random>
#include <tuple>

#include "bio/muscle/first_order_activation.h"
#include "bio/muscle/smooth_activation.h"
#include "support/finite_difference.h"
#include "support/numbers.h"

namespace bio::muscles {
namespace {

/// a by many fourth-order steps.
template <class Law>
double integrated(const Law& law, double u0, double u1, double a, double h, int steps) {
  const double d = h / steps;
  for (int i = 0; i < steps; ++i) {
    const auto u = [&](double share) { return u0 + (u1 - u0) * (i + share) / steps; };
    const double k1 = law.rate(u(0), a), k2 = law.rate(u(0.5), a + d / 2 * k1);
    const double k3 = law.rate(u(0.5), a + d / 2 * k2), k4 = law.rate(u(1), a + d * k3);
    a += d / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return a;
}

struct ActivationCase {
  double u0, u1, a0, h;
};
std::ostream& operator<<(std::ostream& out, const ActivationCase& c) {
  return out << c.u0 << " to " << c.u1 << " from " << c.a0 << " in " << c.h << " s";
}

// What each derivative of a step is taken in.
template <class Law>
std::array<double, 7> argumentsOf(const Law& law, const ActivationCase& c) {
  const auto& [x, y, z] = law;
  return {c.u0, c.u1, c.a0, c.h, x, y, z};
}
template <class Law>
double stepAt(const std::array<double, 7>& x) {
  return Law{x[4], x[5], x[6]}.step(x[0], x[1], x[2], x[3]);
}

template <class Law>
double worstDerivative(const Law& law, const ActivationCase& c, double step) {
  const auto x = argumentsOf(law, c);
  const auto d = law.stepWithDerivatives(c.u0, c.u1, c.a0, c.h);
  EXPECT_NEAR(d.value, law.step(c.u0, c.u1, c.a0, c.h), 1e-14) << c;
  double worst = 0;
  for (std::size_t i = 0; i < 7; ++i) {
    const double slope = support::centralDifference(
        [&](double value) {
          auto y = x;
          y[i] = value;
          return stepAt<Law>(y);
        },
        x[i], step * (std::abs(x[i]) + 1e-3));
    const double error = std::abs(d.d[i] - slope) / (1 + std::abs(slope));
    EXPECT_LT(error, 1e-6) << c << " in argument " << i << ": " << d.d[i] << " " << slope;
    worst = std::max(worst, error);
  }
  return worst;
}

TEST(FirstOrderActivation, HasTheRatesOfThePrototype) {
  const double rows[][4] = {
      {0.05, 1, 110.144927536232, 165.217391304348}, {0.5, 0.8, 16, 24}, {0.5, 0.2, -7.5, -9.375}};
  const FirstOrderActivation<double> thelen{0.015, 0.05, 0.01}, millard{0.01, 0.04, 0.01};
  for (const auto& row : rows) {
    EXPECT_NEAR(thelen.rate(row[1], row[0]), row[2], 1e-12 * std::abs(row[2]) * 10);
    EXPECT_NEAR(millard.rate(row[1], row[0]), row[3], 1e-12 * std::abs(row[3]) * 10);
  }
}

TEST(FirstOrderActivation, AnswersAStepOfExcitationAsThePrototype) {
  const FirstOrderActivation<double> thelen{0.015, 0.05, 0.01}, millard{0.01, 0.04, 0.01};
  EXPECT_NEAR(millard.step(1, 1, 0.05, 0.02), 0.801021714959, 1e-12);
  EXPECT_NEAR(thelen.step(1, 1, 0.05, 0.02), 0.700574961736, 1e-12);
  EXPECT_NEAR(millard.step(0.1, 0.1, 0.8, 0.05), 0.263609674539, 1e-12);
}

// Away from changes of branch a step is exact, however long and however steep the excitation.
TEST(FirstOrderActivation, SolvesItsEquationExactly) {
  const FirstOrderActivation<double> law;
  double worst = 0;
  for (const ActivationCase& c : {ActivationCase{1, 1, 0.05, 0.02},
                                  {0.1, 0.1, 0.8, 0.05},
                                  {0.3, 0.5, 0.2, 0.01},
                                  {0.5, 0.45, 0.2, 0.01},
                                  {0.1, 1, 0.1, 0.001},
                                  {0.4, 0.4 - 1e-9, 0.1, 0.005},
                                  {0.9, 0.7, 0.02, 0.004},
                                  {0.2, 0.25, 0.6, 0.01},
                                  {0.9, 0.1, 0.95, 0.02},
                                  {0.05, 0.9, 0.04, 0.3},
                                  {0.9, 0.02, 0.95, 0.5}}) {
    const double error =
        std::abs(law.step(c.u0, c.u1, c.a0, c.h) - integrated(law, c.u0, c.u1, c.a0, c.h, 20000));
    EXPECT_LT(error, 1e-10) << c;  // 1.7e-11 for the fall from 0.9 to 0.1, else below 1e-13
    worst = std::max(worst, error);
  }
  std::printf("first order: %.1e\n", worst);
}

// Rising may turn to falling and falling to rising within a step; Runge–Kutta loses order there.
TEST(FirstOrderActivation, PlacesAChangeOfBranchWithinAStep) {
  const FirstOrderActivation<double> law;
  for (const ActivationCase& c : {ActivationCase{0.5, 0.1, 0.3, 0.01},
                                  {0.2, 0.6, 0.4, 0.01},
                                  {0.9, 0, 0.2, 0.01},
                                  {0.05, 0.95, 0.9, 0.1}}) {
    EXPECT_NEAR(law.step(c.u0, c.u1, c.a0, c.h), integrated(law, c.u0, c.u1, c.a0, c.h, 40000),
                1e-9)
        << c;
  }
}

TEST(FirstOrderActivation, TakesTheSameWayInOneStepAsInTwo) {
  const FirstOrderActivation<double> law;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  double worst = 0;
  for (int i = 0; i < 3000; ++i) {
    const double u0 = unit(random), u1 = unit(random), a0 = 0.01 + 0.99 * unit(random);
    const double h = 0.03 * unit(random), share = unit(random);
    const double middle = u0 + share * (u1 - u0);
    const double inTwo = law.step(middle, u1, law.step(u0, middle, a0, share * h), (1 - share) * h);
    worst = std::max(worst, std::abs(law.step(u0, u1, a0, h) - inTwo));
  }
  EXPECT_LT(worst, 1e-10);
  std::printf("first order in two: %.1e\n", worst);
}

// OpenSim's state goes on falling below the least activation, for ever; ours waits there.
TEST(FirstOrderActivation, StaysAtTheLeastActivationAndRisesFromItAtOnce) {
  const FirstOrderActivation<double> law;
  EXPECT_EQ(law.step(0, 0, 0.8, 1.0), law.minimum);
  EXPECT_EQ(law.step(0, 0, law.minimum, 0.01), law.minimum);
  EXPECT_EQ(law.rate(0, law.minimum), 0);
  // u passes the least at 1/30 of the step
  const double late = law.step(law.minimum, 0.3, law.minimum, 0.01 * 29 / 30);
  EXPECT_NEAR(law.step(0, 0.3, 0.004, 0.01), late, 1e-14);
  // it falls as OpenSim's does until it gets there
  EXPECT_NEAR(law.step(0, 0, 0.05, 0.02), integrated(law, 0, 0, 0.05, 0.02, 20000), 1e-12);
}

TEST(FirstOrderActivation, StaysAtOneForExcitationsAboveOne) {
  const FirstOrderActivation<double> law;
  EXPECT_EQ(law.step(1.2, 1.2, 0.9, 0.05), 1);
  EXPECT_EQ(law.rate(1.2, 1), 0);
  EXPECT_LT(law.step(1.2, 0.5, 0.9, 0.05), 1);
}

TEST(FirstOrderActivation, HasTheDerivativesOfItsStep) {
  const FirstOrderActivation<double> law;
  double worst = 0;
  for (const ActivationCase& c : {ActivationCase{1, 1, 0.05, 0.02},
                                  {0.1, 0.1, 0.8, 0.05},
                                  {0.3, 0.5, 0.2, 0.01},
                                  {0.5, 0.45, 0.2, 0.01},
                                  {0.9, 0.7, 0.02, 0.004},
                                  {0.2, 0.25, 0.6, 0.01},
                                  {0.05, 0.9, 0.04, 0.3},
                                  {0.9, 0.02, 0.95, 0.5},
                                  {0.5, 0.1, 0.3, 0.01},
                                  {0.2, 0.6, 0.4, 0.01},
                                  {0.9, 0, 0.2, 0.01},
                                  {0.001, 0.002, 0.3, 1.0},
                                  {0.001, 0.3, 0.05, 0.2},
                                  {0.001, 0.3, 0.011, 0.02}}) {
    worst = std::max(worst, worstDerivative(law, c, 1e-4));
  }
  std::printf("first order, derivatives: %.1e\n", worst);
}

// The derivatives written out against those of dual numbers carried through the pieces: a step that
// is cut where nothing happens takes the second way.
TEST(FirstOrderActivation, HasTheSameDerivativesWrittenOutAsChained) {
  const FirstOrderActivation<double> law;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  double worst = 0;
  for (int i = 0; i < 500; ++i) {
    const double u0 = 0.02 + 0.9 * unit(random), u1 = u0 + 0.1 * (unit(random) - 0.5);
    const double a0 = 0.02 + 0.9 * unit(random), h = 0.02 * unit(random) + 1e-3;
    const auto whole = law.stepWithDerivatives(u0, u1, a0, h);
    const double m = 0.5 * (u0 + u1);
    const auto first = law.stepWithDerivatives(u0, m, a0, h / 2);
    const auto second = law.stepWithDerivatives(m, u1, first.value, h / 2);
    const auto chained = [&](std::size_t k) { return second.d[2] * first.d[k]; };
    const double by[7] = {chained(0) + 0.5 * chained(1) + 0.5 * second.d[0],
                          0.5 * chained(1) + 0.5 * second.d[0] + second.d[1],
                          chained(2),
                          0.5 * chained(3) + 0.5 * second.d[3],
                          chained(4) + second.d[4],
                          chained(5) + second.d[5],
                          chained(6) + second.d[6]};
    for (std::size_t k = 0; k < 7; ++k) {
      worst = std::max(worst, std::abs(whole.d[k] - by[k]) / (1 + std::abs(by[k])));
    }
  }
  EXPECT_LT(worst, 1e-9);
  std::printf("first order, chained: %.1e\n", worst);
}

TEST(FirstOrderActivation, TakesNotANumberToNotANumber) {
  const FirstOrderActivation<double> law;
  EXPECT_TRUE(std::isnan(law.step(support::nan, 0.5, 0.3, 0.01)));
  EXPECT_TRUE(std::isnan(law.step(0.2, 0.5, support::nan, 0.01)));
}

TEST(SmoothActivation, HasTheRatesOfThePrototype) {
  const SmoothActivation<double> usual, sharp{0.015, 0.06, 10};
  const double rows[][4] = {{0.05, 1, 64.4095968715973, 110.144926970121},
                            {0.5, 0.8, 11.2712061407893, 15.9758919242228},
                            {0.5, 0.2, -10.9787938592108, -6.27410807577719},
                            {0.01, 0, -0.68956152528235, -0.629933246824366}};
  for (const auto& row : rows) {
    EXPECT_NEAR(usual.rate(row[1], row[0]), row[2], 1e-11 * std::abs(row[2]));
    EXPECT_NEAR(sharp.rate(row[1], row[0]), row[3], 1e-11 * std::abs(row[3]));
  }
  EXPECT_NEAR(usual.step(1, 1, 0.05, 0.02), 0.598456213814, 1e-5);
  EXPECT_NEAR(sharp.step(1, 1, 0.05, 0.02), 0.700528423015, 1e-5);
}

TEST(SmoothActivation, IsOfSixthOrder) {
  const SmoothActivation<double> law{0.015, 0.06, 0.1};
  // steps just below a whole number of stretches, so that halving the step halves the stretches
  const auto error = [&](int parts) {
    double a = 0.1;
    const double h = 0.012;
    for (int i = 0; i < parts; ++i) {
      const double u0 = 0.2 + 0.4 * i / parts, u1 = 0.2 + 0.4 * (i + 1) / parts;
      a = law.step(u0, u1, a, h / parts);
    }
    return std::abs(a - integrated(law, 0.2, 0.6, 0.1, h, 20000));
  };
  const double order = std::log2(error(1) / error(2));
  std::printf("smooth: errors %.1e %.1e, order %.2f\n", error(1), error(2), order);
  EXPECT_GT(order, 5.2);
  EXPECT_LT(order, 6.8);
}

TEST(SmoothActivation, HasTheDerivativesOfItsStep) {
  double worst = 0;
  for (double b : {0.1, 1.0, 10.0}) {
    const SmoothActivation<double> law{0.0151, 0.0603, b};
    for (const ActivationCase& c : {ActivationCase{1, 1, 0.05, 0.02},
                                    {0.1, 0.1, 0.8, 0.05},
                                    {0.3, 0.5, 0.2, 0.01},
                                    {0.5, 0.1, 0.3, 0.01},
                                    {0.2, 0.6, 0.4, 0.011}}) {
      worst = std::max(worst, worstDerivative(law, c, 1e-5));
    }
  }
  std::printf("smooth, derivatives: %.1e\n", worst);
}

TEST(DirectActivation, IsTheExcitationWithinItsLimits) {
  const DirectActivation law{0.01, 1};
  EXPECT_EQ(law.step(0.2, 0.6, 0.1, 0.01), 0.6);
  EXPECT_EQ(law.step(0.2, 0, 0.1, 0.01), 0.01);
  EXPECT_EQ(law.stepWithDerivatives(0.2, 0.6, 0.1, 0.01).d[1], 1);
  EXPECT_EQ(law.stepWithDerivatives(0.2, 1.6, 0.1, 0.01).d[1], 0);
}

}  // namespace
}  // namespace bio::muscles
