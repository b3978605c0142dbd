#include <gtest/gtest.h>

#include "support/calibration_statistics.h"

namespace bio::testing {
namespace {

TEST(CalibrationCoverage, TwoHundredRepetitionsAttainTheBoundAndTheirIntervalsHold) {
  const CalibrationStatistics s = repeatCalibration(200);
  EXPECT_EQ(s.converged, 200);
  EXPECT_NEAR(s.noise, 0.5, 0.01);
  for (Eigen::Index k = 0; k < 3; ++k) {
    EXPECT_LT(std::abs(s.bias[k]), 3);
    EXPECT_NEAR(s.variance[k], 1, 0.25);
    EXPECT_GE(s.coverage[k], 0.92);
    EXPECT_LE(s.coverage[k], 0.98);
  }
}

}  // namespace
}  // namespace bio::testing
