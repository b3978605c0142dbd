#include "support/torque_statistics.h"

#include <gtest/gtest.h>

namespace bio::fixtures {
namespace {

// The spread of 20 repetitions is known to 32 %, their coverage to 5 %: this sees blunders only.
// 200 repetitions: calibration_coverage_test.
TEST(TorqueStatistics, TwentyCalibrationsFromADynamometerLookRight) {
  const TorqueStatistics s = repeatTorqueCalibration(20, {});
  EXPECT_EQ(s.converged, 20);
  EXPECT_LT(s.bias.abs().maxCoeff(), 4);
  EXPECT_GT(s.variance.minCoeff(), 0.3);
  EXPECT_LT(s.variance.maxCoeff(), 2.2);
  EXPECT_GE(s.coverage.minCoeff(), 0.75);
}

TEST(TorqueStatistics, MomentAngleAndFascicleAreFittedTogether) {
  const TorqueStatistics s = repeatTorqueCalibration(10, {.fascicle = true, .shoulder = true});
  EXPECT_EQ(s.converged, 10);
  EXPECT_LT(s.bias.abs().maxCoeff(), 4);
  EXPECT_LT(s.variance.maxCoeff(), 3);
}

}  // namespace
}  // namespace bio::fixtures
