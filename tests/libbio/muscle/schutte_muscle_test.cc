#include "bio/muscle/schutte_muscle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "libbio/muscle/elbow_muscles.h"
#include "support/elbow_curves.h"
#include "support/finite_difference.h"

namespace bio {
namespace {

using elbow_muscles::Compiled;
using elbow_muscles::elbowMuscles;
using elbow_muscles::randomState;
using elbow_muscles::State;

TEST(SchutteMuscle, VelocityAndResidualAreInverses) {
  std::mt19937 random(2);
  for (const SchutteParameters& p : elbowMuscles()) {
    const Compiled c(p, {.clampForce = false});
    for (int i = 0; i < 500; ++i) {
      const State s = randomState(random, p);
      const auto rate = c.muscle.fibreVelocity(s.activation, s.fibreLength, s.muscleTendonLength);
      const double residual = c.muscle.equilibriumResidual(
          s.activation, s.fibreLength, s.muscleTendonLength, rate.fibreVelocity);
      EXPECT_NEAR(residual / p.maxIsometricForce, 0, 1e-12);
      EXPECT_EQ(rate.tendonForce, c.muscle.tendonForce(s.fibreLength, s.muscleTendonLength));
    }
  }
}

// By hand, no spline in between: a fibre of optimal length in the middle of a slack tendon.
TEST(SchutteMuscle, KnownValues) {
  SchutteParameters p = support::tricepsLongHead();
  p.activeForceLength = {{0, 1, 2}, {1, 1, 1}};
  p.passiveForceLength = SplineFunction{{0, 2}, {0, 0}};
  p.tendonForceLength = {{0, 1}, {0, 30}};
  const Compiled c(p);
  const double fibre = 0.134 / 0.9, cosine = std::sqrt(1 - std::pow(0.9 * std::sin(0.20943951), 2));
  const double length = fibre * cosine + 0.143 * 1.01;  // strain 0.01, F_T/F0 = 0.3
  const auto rate = c.muscle.fibreVelocity(0.6, fibre, length);
  EXPECT_NEAR(rate.tendonForce, 0.3 * 771.8, 1e-9);
  // shortening: v from 0.6·0.15(1+v)/(0.15−v) + 0.017v = 0.3/cos α
  const double v = rate.fibreVelocity * 0.1 / 0.134;
  EXPECT_LT(v, 0);
  EXPECT_NEAR(0.6 * 0.15 * (1 + v) / (0.15 - v) + 0.017 * v, 0.3 / cosine, 1e-12);
  // lengthening at low activation
  const double u = c.muscle.fibreVelocity(0.1, fibre, length).fibreVelocity * 0.1 / 0.134;
  const double sigma = 0.13 * 0.15 / 1.15;
  EXPECT_GT(u, 0);
  EXPECT_NEAR(0.1 * (1.4 * u + sigma) / (u + sigma) + 0.017 * u, 0.3 / cosine, 1e-12);
}

TEST(SchutteMuscle, ForceVelocityIsContinuousAcrossIsometric) {
  const SchutteParameters p = support::tricepsLongHead();
  const Compiled c(p);
  const StaticEquilibrium rest = staticEquilibrium(c.muscle, 0.4, 0.28);
  ASSERT_EQ(rest.why, StaticEquilibrium::Why::found);
  const double left = c.muscle.fibreVelocity(0.4, rest.fibreLength + 1e-10, 0.28).fibreVelocity;
  const double right = c.muscle.fibreVelocity(0.4, rest.fibreLength - 1e-10, 0.28).fibreVelocity;
  EXPECT_LT(left, 0);
  EXPECT_GT(right, 0);
  EXPECT_NEAR(left, right, 1e-6);
}

TEST(SchutteMuscle, ClampHoldsASlackMuscleAtTheSpeedOfZeroForce) {
  const SchutteParameters p = support::tricepsLongHead();
  const Compiled clamped(p), free(p, {.clampForce = false});
  // passive force at 1.5 ℓ0 with a slack tendon: P = −f_PE
  const double fibre = 1.5 * 0.134;
  const double P = -clamped.curves.passiveForce->value(1.5);
  ASSERT_LT(P, -0.1);
  const double vFree = free.muscle.fibreVelocity(0.5, fibre, 0.1).fibreVelocity * 0.1 / 0.134;
  EXPECT_NEAR(vFree, P / 0.017, 1e-12);
  const double A = 0.5 * clamped.muscle.activeForceLength(1.5);
  const double v = clamped.muscle.fibreVelocity(0.5, fibre, 0.1).fibreVelocity * 0.1 / 0.134;
  EXPECT_NEAR(A * schutte::forceVelocity(v) + 0.017 * v, 0, 1e-13);
  EXPECT_EQ(fibreRateDerivatives(clamped.muscle, 0.5, fibre, 0.1).dV_dMuscleTendonLength, 0);
}

TEST(SchutteMuscle, ActivationBelowTheFloorActsAsTheFloor) {
  const SchutteParameters p = support::tricepsLongHead();
  const Compiled c(p);
  const auto at = [&](double a) { return c.muscle.fibreVelocity(a, 0.13, 0.275).fibreVelocity; };
  EXPECT_EQ(at(0.0), at(1e-3));
  EXPECT_EQ(at(-1.0), at(1e-3));
  EXPECT_NE(at(2e-3), at(1e-3));
  EXPECT_EQ(fibreRateDerivatives(c.muscle, 0, 0.13, 0.275).dV_dActivation, 0);
}

TEST(SchutteMuscle, NegativeSplineValuesOfForceLengthCountAsZero) {
  SchutteParameters p = support::tricepsLongHead();
  p.activeForceLength = {{0, 2}, {-1, 1}};
  const Compiled c(p);
  EXPECT_EQ(c.muscle.activeForceLength(0.5), 0);
  EXPECT_EQ(c.muscle.activeForceLength(1.5), 0.5);
  // A = 0: v = P/B
  const auto rate = c.muscle.fibreVelocity(1, 0.1, 0.245);
  const double kappa = 0.1 / c.muscle.projectedFibreLength(0.1);
  const double P = rate.tendonForce / 771.8 * kappa - c.muscle.passiveForceLength(0.1 / 0.134);
  EXPECT_NEAR(rate.fibreVelocity, P / 0.017 * 1.34, 1e-10);
}

TEST(SchutteMuscle, WithoutPassiveCurveUsesTheExponential) {
  SchutteParameters p = support::tricepsLongHead();
  p.passiveForceLength.reset();
  const Compiled c(p);
  EXPECT_NEAR(c.muscle.passiveForceLength(1.5), 1, 1e-14);
  EXPECT_NEAR(c.muscle.passiveForceLength(1.0), std::exp(-4.0), 1e-16);
}

TEST(SchutteMuscle, ASlackTendonCarriesNoForce) {
  const Compiled c(support::tricepsLongHead());
  const double slack = c.muscle.projectedFibreLength(0.13) + 0.143;
  EXPECT_EQ(c.muscle.tendonForce(0.13, slack - 1e-6), 0);
  EXPECT_GT(c.muscle.tendonForce(0.13, slack + 1e-6), 0);
}

TEST(SchutteMuscle, AFibreShorterThanItsThicknessIsNotANumber) {
  const Compiled c(support::tricepsLongHead());
  for (const double fibre : {c.muscle.thickness(), 0.5 * c.muscle.thickness(), 0.0, -0.1}) {
    EXPECT_TRUE(std::isnan(c.muscle.fibreVelocity(0.5, fibre, 0.27).fibreVelocity));
    EXPECT_TRUE(std::isnan(fibreRateDerivatives(c.muscle, 0.5, fibre, 0.27).fibreVelocity));
  }
  const Compiled parallel(elbowMuscles()[4]);
  EXPECT_TRUE(std::isnan(parallel.muscle.fibreVelocity(0.5, 0, 0.3).fibreVelocity));
}

// First derivatives: by hand, through the scalar type and by differences.
TEST(SchutteMuscle, FirstDerivativesAgreeThreeWays) {
  using Dual3 = info::Dual<3>;
  std::mt19937 random(3);
  for (const bool clamp : {true, false}) {
    for (const SchutteParameters& p : elbowMuscles()) {
      const Compiled c(p, {.clampForce = clamp});
      const SchutteQuantities<double> q = schutteQuantities(p);
      const SchutteMuscle<Dual3> dualMuscle(
          {Dual3(q.maxIsometricForce), Dual3(q.optimalFibreLength), Dual3(q.tendonSlackLength),
           Dual3(q.pennation), Dual3(q.timeScale), Dual3(q.damping)},
          c.curves, {.clampForce = clamp});
      SchuttePieces pieces;
      for (int i = 0; i < 100; ++i) {
        const State s = randomState(random, p);
        const FibreRateDerivatives d =
            fibreRateDerivatives(c.muscle, s.activation, s.fibreLength, s.muscleTendonLength);
        const FibreRateDerivatives again = fibreRateDerivatives(
            c.muscle, s.activation, s.fibreLength, s.muscleTendonLength, pieces);
        EXPECT_EQ(again.dV_dFibreLength, d.dV_dFibreLength);
        EXPECT_EQ(again.dF_dMuscleTendonLength, d.dF_dMuscleTendonLength);
        const auto rate = c.muscle.fibreVelocity(s.activation, s.fibreLength, s.muscleTendonLength);
        EXPECT_NEAR(d.fibreVelocity, rate.fibreVelocity, 1e-13 * (1 + std::abs(d.fibreVelocity)));
        EXPECT_NEAR(d.tendonForce, rate.tendonForce, 1e-12 * p.maxIsometricForce);
        const auto dual =
            dualMuscle.fibreVelocity(Dual3(s.activation, 3, 0), Dual3(s.fibreLength, 3, 1),
                                     Dual3(s.muscleTendonLength, 3, 2));
        const auto near = [](double a, double b) { EXPECT_NEAR(a, b, 1e-10 * (1 + std::abs(b))); };
        near(d.dV_dActivation, dual.fibreVelocity.derivatives()[0]);
        near(d.dV_dFibreLength, dual.fibreVelocity.derivatives()[1]);
        near(d.dV_dMuscleTendonLength, dual.fibreVelocity.derivatives()[2]);
        near(d.dF_dFibreLength, dual.tendonForce.derivatives()[1]);
        near(d.dF_dMuscleTendonLength, dual.tendonForce.derivatives()[2]);

        // differences where no kink lies within the stencil
        const double h = 1e-7;
        const auto regime = [&](double offset) {
          const auto v =
              c.muscle.fibreVelocity(s.activation, s.fibreLength + offset, s.muscleTendonLength)
                  .fibreVelocity;
          return v > 0;
        };
        if (regime(-1e-4) != regime(1e-4)) continue;
        const double difference = support::centralDifference(
            [&](double x) {
              return c.muscle.fibreVelocity(s.activation, s.fibreLength, x).fibreVelocity;
            },
            s.muscleTendonLength, h);
        EXPECT_NEAR(d.dV_dMuscleTendonLength, difference, 2e-4 * (1 + std::abs(difference)));
      }
    }
  }
}

// Derivatives in the parameters flow through the scalar type.
TEST(SchutteMuscle, ParameterDerivativesAgreeWithDifferences) {
  using Dual6 = info::Dual<6>;
  const SchutteParameters p = support::tricepsLongHead();
  const SchutteCurves curves(p);
  const SchutteQuantities<double> q = schutteQuantities(p);
  const std::array<double, 6> value = {q.maxIsometricForce, q.optimalFibreLength,
                                       q.tendonSlackLength, q.pennation,
                                       q.timeScale,         q.damping};
  const auto evaluate = [&](const std::array<double, 6>& z) {
    return SchutteMuscle<double>({z[0], z[1], z[2], z[3], z[4], z[5]}, curves)
        .fibreVelocity(0.4, 0.12, 0.265);
  };
  std::array<Dual6, 6> z;
  for (int i = 0; i < 6; ++i) {
    z[static_cast<std::size_t>(i)] = Dual6(value[static_cast<std::size_t>(i)], 6, i);
  }
  const auto dual = SchutteMuscle<Dual6>({z[0], z[1], z[2], z[3], z[4], z[5]}, curves)
                        .fibreVelocity(Dual6(0.4), Dual6(0.12), Dual6(0.265));
  for (std::size_t i = 0; i < 6; ++i) {
    const auto moved = [&](double x) {
      std::array<double, 6> y = value;
      y[i] = x;
      return evaluate(y);
    };
    const double h = 1e-5 * value[i];
    const double dV =
        support::centralDifference([&](double x) { return moved(x).fibreVelocity; }, value[i], h);
    const double dF =
        support::centralDifference([&](double x) { return moved(x).tendonForce; }, value[i], h);
    const auto k = static_cast<Eigen::Index>(i);
    EXPECT_NEAR(dual.fibreVelocity.derivatives()[k], dV, 1e-6 * (1 + std::abs(dV))) << i;
    EXPECT_NEAR(dual.tendonForce.derivatives()[k], dF, 1e-6 * (1 + std::abs(dF))) << i;
  }
}

TEST(StaticEquilibrium, FibreRestsThere) {
  for (const SchutteParameters& p : elbowMuscles()) {
    const Compiled c(p);
    for (const double a : {0.0, 0.05, 0.5, 1.0}) {
      for (const double stretch : {0.7, 1.0, 1.3}) {
        const double length = p.tendonSlackLength + stretch * p.optimalFibreLength;
        const StaticEquilibrium rest = staticEquilibrium(c.muscle, a, length);
        ASSERT_EQ(rest.why, StaticEquilibrium::Why::found);
        const FibreRateDerivatives d = fibreRateDerivatives(c.muscle, a, rest.fibreLength, length);
        EXPECT_NEAR(d.fibreVelocity, 0, 1e-11 * std::max(1.0, std::abs(d.dV_dFibreLength)));
        EXPECT_LT(d.dV_dFibreLength, 0);
        EXPECT_EQ(d.tendonForce, rest.tendonForce);
      }
    }
  }
}

TEST(StaticEquilibrium, IsFoundOrReportedForAnyMuscle) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> unit(0, 1);
  int found = 0, several = 0;
  SchutteParameters p = support::elbowCurves();
  const SchutteCurves splines(p);
  p.passiveForceLength.reset();
  const SchutteCurves exponential(p);
  for (int i = 0; i < 100000; ++i) {
    const double fibre = 0.02 + 0.3 * unit(random);
    const SchutteQuantities<double> q{10 + 2000 * unit(random),
                                      fibre,
                                      fibre * std::pow(10.0, -1 + 2.3 * unit(random)),
                                      i % 3 == 0 ? 0 : 0.8 * unit(random),
                                      0.1,
                                      0.001 + 0.1 * unit(random)};
    const SchutteMuscle<double> muscle(q, i % 2 == 0 ? splines : exponential);
    const double length = q.tendonSlackLength + (-0.2 + 2 * unit(random)) * fibre;
    const double activation = unit(random);
    const StaticEquilibrium rest = staticEquilibrium(muscle, activation, length);
    if (length <= q.tendonSlackLength) {
      ASSERT_EQ(rest.why, StaticEquilibrium::Why::tendonTooShort);
      ASSERT_TRUE(std::isnan(rest.fibreLength));
      continue;
    }
    ASSERT_TRUE(rest.isUsable()) << describe(rest.why) << " stretch "
                                 << (length - q.tendonSlackLength) / fibre;
    if (rest.why != StaticEquilibrium::Why::found) continue;
    ++found;
    several += rest.count > 1 ? 1 : 0;
    ASSERT_GT(rest.fibreLength, muscle.thickness());
    const double residual = muscle.equilibriumResidual(activation, rest.fibreLength, length, 0);
    ASSERT_NEAR(residual / q.maxIsometricForce, 0, 1e-9);
  }
  EXPECT_GT(found, 70000);
  RecordProperty("withSeveralEquilibria", several);
}

TEST(StaticEquilibrium, RefusesWhatIsNotANumber) {
  const Compiled c(support::tricepsLongHead());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(staticEquilibrium(c.muscle, nan, 0.3), std::invalid_argument);
  EXPECT_THROW(staticEquilibrium(c.muscle, 0.5, nan), std::invalid_argument);
}

TEST(SchutteQuantities, NamesTheBrokenRule) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refuses = [](auto change, const char* words) {
    SchutteParameters p = support::tricepsLongHead();
    change(p);
    try {
      schutteQuantities(p);
      ADD_FAILURE() << "accepted: " << words;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  };
  for (const double bad : {0.0, -1.0, nan}) {
    refuses([&](auto& p) { p.maxIsometricForce = bad; }, "maximal isometric force");
    refuses([&](auto& p) { p.optimalFibreLength = bad; }, "optimal fibre length");
    refuses([&](auto& p) { p.tendonSlackLength = bad; }, "tendon slack length");
    refuses([&](auto& p) { p.timeScale = bad; }, "time scale");
    refuses([&](auto& p) { p.damping = bad; }, "damping");
  }
  for (const double bad : {-0.1, 1.6, nan}) {
    refuses([&](auto& p) { p.pennation = bad; }, "pennation");
  }
}

}  // namespace
}  // namespace bio
