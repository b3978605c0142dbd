#include <gtest/gtest.h>

#include "support/calibration_statistics.h"

namespace bio::fixtures {
namespace {

// A coverage out of 200 repetitions is known to 1.5 % only, out of 1500 to 0.6 %.
TEST(CalibrationCoverage, RepetitionsAttainTheBoundAndTheirIntervalsHold) {
  const CalibrationStatistics s = repeatCalibration(1500);
  EXPECT_GE(s.converged, 1490);
  EXPECT_NEAR(s.noise, 0.5, 0.01);
  for (Eigen::Index k = 0; k < 3; ++k) {
    EXPECT_LT(std::abs(s.bias[k]), 3);
    EXPECT_NEAR(s.variance[k], 1, 0.25);
    EXPECT_GE(s.coverage[k], 0.92);
    EXPECT_LE(s.coverage[k], 0.98);
  }
}

}  // namespace
}  // namespace bio::fixtures
