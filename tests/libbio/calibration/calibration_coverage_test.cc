#include <gtest/gtest.h>

#include "libbio/calibration/calibration_statistics.h"
#include "libbio/calibration/latent_statistics.h"
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

// What excited a muscle without an electrode is drawn from the declared prior.
TEST(CalibrationCoverage, LatentExcitationsLeaveHonestIntervals) {
  const LatentStatistics s = repeatLatentCalibration(200);
  EXPECT_GE(s.latent.converged, 195);
  EXPECT_GE(s.latent.told.minCoeff(), 0.99);
  EXPECT_GE(s.latent.coverage.minCoeff(), 0.91);
  EXPECT_LE(s.latent.coverage.maxCoeff(), 0.99);
  EXPECT_LT((s.latent.rms / s.latent.sd).maxCoeff(), 1.2);
  // the shared electrode taken as it is: large errors, hardly any interval, and those are wrong
  EXPECT_GT((s.shared.rms / s.latent.rms).minCoeff(), 5);
  EXPECT_LT(s.shared.told.maxCoeff(), 0.2);
  EXPECT_LT(s.shared.coverage[0], 0.5);
}

}  // namespace
}  // namespace bio::fixtures
