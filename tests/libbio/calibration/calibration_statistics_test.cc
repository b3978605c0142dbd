#include "libbio/calibration/calibration_statistics.h"

#include <gtest/gtest.h>

namespace bio::fixtures {
namespace {

// The spread of 30 repetitions is known to 26 %, their coverage to 4 %: this sees blunders only.
TEST(CalibrationStatistics, ThirtyRepetitionsLookRight) {
  const CalibrationStatistics s = repeatCalibration(30);
  EXPECT_EQ(s.converged, 30);
  EXPECT_NEAR(s.noise, 0.5, 0.02);
  for (Eigen::Index k = 0; k < 3; ++k) {
    EXPECT_LT(std::abs(s.bias[k]), 3.5);
    EXPECT_GT(s.variance[k], 0.4);
    EXPECT_LT(s.variance[k], 1.9);
    EXPECT_GE(s.coverage[k], 0.83);
  }
}

}  // namespace
}  // namespace bio::fixtures
