#include "info/estimation/censored.h"

#include <gmock/gmock.h>

#include <cmath>

namespace {

using namespace info;
using testing::HasSubstr;

TEST(Censored, IsTheParabolaWithinTheLimits) {
  const SampleCost c = sampleCost({.sd = 0.5, .lower = 0, .upper = 3}, 1, 2);
  EXPECT_DOUBLE_EQ(c.value, 2);
  EXPECT_DOUBLE_EQ(c.slope, 4);
  EXPECT_DOUBLE_EQ(c.curvature, 4);
}

TEST(Censored, KnowsTheNormalDistribution) {
  // −ln Φ: 0 gives ln 2; known values of Φ(−1), Φ(−10), Φ(−40) from tables
  EXPECT_NEAR(minusLogNormal(0).value, std::log(2.0), 1e-15);
  EXPECT_NEAR(minusLogNormal(-1).value, -std::log(0.15865525393145705), 1e-14);
  EXPECT_NEAR(minusLogNormal(-10).value, -std::log(7.619853024160527e-24), 1e-11);
  EXPECT_NEAR(minusLogNormal(-40).value, 804.608442013754, 1e-8);
  EXPECT_NEAR(minusLogNormal(8).value, 6.220960574271785e-16, 1e-29);
}

TEST(Censored, HasItsDerivatives) {
  for (double t = -30; t <= 12; t += 0.37) {
    const double h = 1e-5 * (1 + std::abs(t));
    const SampleCost at = minusLogNormal(t), plus = minusLogNormal(t + h),
                     minus = minusLogNormal(t - h);
    EXPECT_NEAR(at.slope, (plus.value - minus.value) / (2 * h), 1e-8 * (1 + std::abs(at.slope)))
        << t;
    EXPECT_NEAR(at.curvature, (plus.slope - minus.slope) / (2 * h), 1e-7) << t;
    EXPECT_GE(at.curvature, 0);
    EXPECT_LE(at.curvature, 1);
  }
}

TEST(Censored, IsContinuousWhereTheTailFormulaTakesOver) {
  const SampleCost before = minusLogNormal(-8 + 1e-12), after = minusLogNormal(-8 - 1e-12);
  EXPECT_NEAR(before.value, after.value, 1e-10);
  EXPECT_NEAR(before.slope, after.slope, 1e-10);
  EXPECT_NEAR(before.curvature, after.curvature, 1e-10);
}

TEST(Censored, SaysAtLeastAtTheUpperLimitAndAtMostAtTheLower) {
  const ClippedSensor sensor{.sd = 0.1, .lower = 0, .upper = 2.5};
  // far above the limit a clipped reading costs and says nothing; below it, nearly the parabola
  EXPECT_NEAR(sampleCost(sensor, 2.5, 4).value, 0, 1e-12);
  EXPECT_NEAR(sampleCost(sensor, 2.5, 4).slope, 0, 1e-12);
  EXPECT_LT(sampleCost(sensor, 2.5, 1.5).slope, -100);
  EXPECT_NEAR(sampleCost(sensor, 0, -2).value, 0, 1e-12);
  EXPECT_GT(sampleCost(sensor, 0, 1).slope, 100);
  // chain rule by differences
  for (double reading : {0.0, 2.5})
    for (double y : {-0.1, 0.15, 2.4, 2.6}) {
      const double h = 1e-6;
      const auto at = sampleCost(sensor, reading, y);
      const auto plus = sampleCost(sensor, reading, y + h),
                 minus = sampleCost(sensor, reading, y - h);
      EXPECT_NEAR(at.slope, (plus.value - minus.value) / (2 * h), 1e-5 * (1 + std::abs(at.slope)));
      EXPECT_NEAR(at.curvature, (plus.slope - minus.slope) / (2 * h), 1e-3);
    }
}

TEST(Censored, NamesTheRuleThatIsBroken) {
  const auto message = [](const ClippedSensor& sensor, double reading) {
    try {
      sampleCost(sensor, reading, 1);
      return std::string();
    } catch (const std::domain_error& e) {
      return std::string(e.what());
    }
  };
  EXPECT_THAT(message({.sd = 0}, 1), HasSubstr("deviation: 0, must be > 0"));
  EXPECT_THAT(message({.sd = std::nan("")}, 1), HasSubstr("must be > 0"));
  EXPECT_THAT(message({.sd = 1, .lower = 2, .upper = 2}, 1),
              HasSubstr("2 to 2, must satisfy lower < upper"));
  EXPECT_THAT(message({.sd = 1}, std::nan("")), HasSubstr("must be finite"));
}

}  // namespace
