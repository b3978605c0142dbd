#include <gtest/gtest.h>

#include "libbio/calibration/calibration_statistics.h"
#include "libbio/calibration/torque_statistics.h"

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

/// Of 200 repetitions a variance is known to 10 %, a coverage of 95 % to 1.5 %.
void expectTheBound(const TorqueStatistics& s) {
  EXPECT_GE(s.converged, 160);  // the others stop at a kink
  EXPECT_LT(s.bias.abs().maxCoeff(), 3.5);
  EXPECT_GT(s.variance.minCoeff(), 0.7);
  EXPECT_LT(s.variance.maxCoeff(), 1.3);
  EXPECT_GE(s.coverage.minCoeff(), 0.91);
}

TEST(CalibrationCoverage, TorqueOfADynamometerAttainsTheBound) {
  expectTheBound(repeatTorqueCalibration(200, {}));
}

TEST(CalibrationCoverage, MomentAngleAndFascicleTogetherAttainTheirBound) {
  const TorqueStatistics moment = repeatTorqueCalibration(200, {.shoulder = true});
  const TorqueStatistics all = repeatTorqueCalibration(200, {.fascicle = true, .shoulder = true});
  expectTheBound(all);
  // the bound falls, and the estimates with it
  EXPECT_LT((all.bound / moment.bound).minCoeff(), 0.9);
}

}  // namespace
}  // namespace bio::fixtures
