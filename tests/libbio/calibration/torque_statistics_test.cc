#include "libbio/calibration/torque_statistics.h"

#include <gtest/gtest.h>

namespace bio::fixtures {
namespace {

// The spread of 12 repetitions is known to 43 %, their coverage to 6 %: this sees blunders only.
// 200 repetitions: calibration_coverage_test. Where a fibre turns within a trial, the moment has a
// kink in the parameters, at which a search may stop.
TEST(TorqueStatistics, CalibrationsFromADynamometerLookRight) {
  const TorqueStatistics s = repeatTorqueCalibration(12, {});
  EXPECT_GE(s.converged, 9);
  EXPECT_LT(s.bias.abs().maxCoeff(), 4);
  EXPECT_GT(s.variance.minCoeff(), 0.2);
  EXPECT_LT(s.variance.maxCoeff(), 2.5);
  EXPECT_GE(s.coverage.minCoeff(), 0.75);
}

TEST(TorqueStatistics, MomentAngleAndFascicleAreFittedTogether) {
  const TorqueStatistics s = repeatTorqueCalibration(6, {.fascicle = true, .shoulder = true});
  EXPECT_GE(s.converged, 4);
  EXPECT_LT(s.bias.abs().maxCoeff(), 4);
  EXPECT_LT(s.variance.maxCoeff(), 3);
  EXPECT_GE(s.coverage.minCoeff(), 0.5);  // 3 of 6: by chance in one of 12,000 at 95 %
}

}  // namespace
}  // namespace bio::fixtures
