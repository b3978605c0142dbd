#include "bio/muscle/activation/activation.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "support/finite_difference.h"

namespace bio {
namespace {

const SchutteActivation<double> schutte{0.1, 7.667, 1.459854};
const FirstOrderActivation<double> firstOrder{0.015, 0.05};

// The classical Runge–Kutta method with tiny steps under u0 + (u1 − u0)t/h.
template <class Dynamics>
double reference(const Dynamics& dynamics, double u0, double u1, double a, double h) {
  const int steps = 20000;
  const double d = h / steps;
  const auto rate = [&](double t, double x) {
    return activationRate(dynamics, u0 + (u1 - u0) * t / h, x);
  };
  for (int i = 0; i < steps; ++i) {
    const double t = i * d;
    const double k1 = rate(t, a), k2 = rate(t + d / 2, a + d / 2 * k1);
    const double k3 = rate(t + d / 2, a + d / 2 * k2), k4 = rate(t + d, a + d * k3);
    a += d / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return a;
}

TEST(ActivationRate, KnownValues) {
  EXPECT_NEAR(activationRate(firstOrder, 0.8, 0.2), 0.6 / 0.015, 1e-12);
  EXPECT_NEAR(activationRate(firstOrder, 0.2, 0.8), -0.6 / 0.05, 1e-12);
  EXPECT_NEAR(activationRate(schutte, 0.8, 0.2), 0.6 * (7.667 * 0.8 + 1.459854) / 0.1, 1e-12);
  EXPECT_NEAR(activationRate(schutte, 0.2, 0.8), -0.6 * 1.459854 / 0.1, 1e-12);
  EXPECT_EQ(activationRate(schutte, 0.5, 0.5), 0);
}

TEST(ActivationRate, IsContinuousWhereRisingTurnsToFalling) {
  for (const double tiny : {1e-6, 1e-12}) {
    EXPECT_NEAR(activationRate(schutte, 0.5 + tiny, 0.5), 0, 100 * tiny);
    EXPECT_NEAR(activationRate(schutte, 0.5 - tiny, 0.5), 0, 100 * tiny);
  }
}

TEST(ActivationRate, DerivativesFlowThroughTheScalarType) {
  using Dual2 = info::Dual<2>;
  const SchutteActivation<Dual2> dynamics{Dual2(0.1), Dual2(7.667), Dual2(1.459854)};
  for (const auto& [u, a] : {std::array{0.7, 0.3}, std::array{0.3, 0.7}}) {
    const Dual2 rate = activationRate(dynamics, Dual2(u, 2, 0), Dual2(a, 2, 1));
    const auto overU = [&, a = a](double x) { return activationRate(schutte, x, a); };
    const auto overA = [&, u = u](double x) { return activationRate(schutte, u, x); };
    EXPECT_NEAR(rate.derivatives()[0], support::centralDifference(overU, u, 1e-4), 1e-8);
    EXPECT_NEAR(rate.derivatives()[1], support::centralDifference(overA, a, 1e-4), 1e-8);
  }
}

struct Step {
  double u0, u1, a0;
};
// rising, falling, constant, crossing in both directions, starting on the excitation
const std::vector<Step> steps = {{0.2, 0.8, 0.1}, {0.8, 0.2, 0.9}, {0.5, 0.5, 0.1},
                                 {0.5, 0.5, 0.9}, {0.9, 0.1, 0.6}, {0.1, 0.9, 0.4},
                                 {0.3, 0.6, 0.3}, {0.6, 0.3, 0.6}, {0.4, 0.4, 0.4}};

TEST(StepActivation, IsExactForFirstOrderDynamics) {
  for (const Step& s : steps) {
    for (const double h : {0.001, 0.01, 0.1}) {
      EXPECT_NEAR(stepActivation(firstOrder, s.u0, s.u1, s.a0, h),
                  reference(firstOrder, s.u0, s.u1, s.a0, h), 1e-7)  // measured 2e-8, by the kink
          << s.u0 << ' ' << s.u1 << ' ' << s.a0 << ' ' << h;
    }
  }
}

TEST(StepActivation, IsExactForConstantExcitation) {
  for (const double a0 : {0.0, 0.1, 0.7, 1.0}) {
    const double k = a0 <= 0.5 ? (7.667 * 0.5 + 1.459854) / 0.1 : 1.459854 / 0.1;
    EXPECT_NEAR(stepActivation(schutte, 0.5, 0.5, a0, 0.05), 0.5 + (a0 - 0.5) * std::exp(-k * 0.05),
                1e-15);
  }
}

// Twice the steps, a sixteenth of the error, measured over excitation ramps; where rising turns to
// falling inside a step the error is smaller than that.
TEST(StepActivation, IsFourthOrderForSchuttesDynamics) {
  for (const Step& s : {Step{0.1, 0.9, 0.05}, Step{0.1, 0.9, 0.4}, Step{0.9, 0.1, 0.2}}) {
    const double h = 0.1;
    const double exact = reference(schutte, s.u0, s.u1, s.a0, h);
    const auto error = [&](int pieces) {
      double a = s.a0;
      for (int i = 0; i < pieces; ++i) {
        const auto u = [&](int j) { return s.u0 + (s.u1 - s.u0) * j / pieces; };
        a = stepActivation(schutte, u(i), u(i + 1), a, h / pieces);
      }
      return std::abs(a - exact);
    };
    const double order = std::log2(error(20) / error(40));
    EXPECT_GT(order, 3.8) << s.u0 << ' ' << s.a0;
    EXPECT_LT(order, 4.2) << s.u0 << ' ' << s.a0;
    EXPECT_LT(error(10), 1e-5);  // steps of 0.01 s
  }
}

TEST(StepActivation, StaysBetweenExcitationAndStartForAnyStep) {
  for (const Step& s : steps) {
    for (const double h : {1e-4, 0.01, 1.0, 100.0}) {
      const double a = stepActivation(schutte, s.u0, s.u1, s.a0, h);
      EXPECT_GE(a, std::min({s.u0, s.u1, s.a0}) - 1e-14);
      EXPECT_LE(a, std::max({s.u0, s.u1, s.a0}) + 1e-14);
    }
  }
}

TEST(StepActivation, OfNoLengthChangesNothing) {
  EXPECT_EQ(stepActivation(schutte, 0.2, 0.8, 0.37, 0.0), 0.37);
}

TEST(StepActivation, DerivativesFlowThroughTheScalarType) {
  using Dual3 = info::Dual<3>;
  const SchutteActivation<Dual3> dynamics{Dual3(0.1), Dual3(7.667), Dual3(1.459854)};
  for (const Step& s : {Step{0.2, 0.8, 0.1}, Step{0.8, 0.2, 0.9}, Step{0.9, 0.1, 0.6}}) {
    const Dual3 a = stepActivation(dynamics, Dual3(s.u0, 3, 0), Dual3(s.u1, 3, 1),
                                   Dual3(s.a0, 3, 2), Dual3(0.05));
    const auto at = [&](double u0, double u1, double a0) {
      return stepActivation(schutte, u0, u1, a0, 0.05);
    };
    EXPECT_NEAR(a.value(), at(s.u0, s.u1, s.a0), 1e-15);
    const double d0 =
        support::centralDifference([&](double x) { return at(x, s.u1, s.a0); }, s.u0, 1e-4);
    const double d1 =
        support::centralDifference([&](double x) { return at(s.u0, x, s.a0); }, s.u1, 1e-4);
    const double d2 =
        support::centralDifference([&](double x) { return at(s.u0, s.u1, x); }, s.a0, 1e-4);
    EXPECT_NEAR(a.derivatives()[0], d0, 1e-8);
    EXPECT_NEAR(a.derivatives()[1], d1, 1e-8);
    EXPECT_NEAR(a.derivatives()[2], d2, 1e-8);
  }
}

// Written out, against the scalar type: in u₀, u₁, a₀, h, t_s, c₁ and c₂.
TEST(StepActivation, HasTheDerivativesOfTheScalarType) {
  using D = info::Dual<7>;
  for (const double c1 : {7.667, 0.0}) {
    for (const Step& s : steps) {
      for (const double h : {0.001, 0.01, 0.2}) {
        const SchutteActivation<D> dynamics{D(0.1, 7, 4), D(c1, 7, 5), D(1.459854, 7, 6)};
        const D expected =
            stepActivation(dynamics, D(s.u0, 7, 0), D(s.u1, 7, 1), D(s.a0, 7, 2), D(h, 7, 3));
        const ActivationStep step =
            stepActivationWithDerivatives({0.1, c1, 1.459854}, s.u0, s.u1, s.a0, h);
        EXPECT_NEAR(step.value, expected.value(), 1e-15);
        for (int i = 0; i < 7; ++i) {
          EXPECT_NEAR(step.d[i], expected.derivatives()[i], 1e-10)  // measured 5e-12, in h
              << i << " at " << s.u0 << ' ' << s.u1 << ' ' << s.a0 << ' ' << h;
        }
      }
    }
  }
}

}  // namespace
}  // namespace bio
