#include "libbio/calibration/latent_statistics.h"

#include <gtest/gtest.h>

namespace bio::fixtures {
namespace {

// Five repetitions see blunders only. 200 of them: calibration_coverage_test.
TEST(LatentStatistics, AMissingElectrodeCostsLessWhereTheExcitationMayBeCorrected) {
  const LatentStatistics s = repeatLatentCalibration(5);
  EXPECT_GE(s.latent.converged, 4);
  EXPECT_GE(s.latent.told.minCoeff(), 0.8);
  EXPECT_GE(s.latent.coverage.minCoeff(), 0.6);
  EXPECT_LT(s.latent.bias.abs().maxCoeff(), 4);
  EXPECT_LT((s.latent.rms / s.shared.rms).maxCoeff(), 0.5);
}

TEST(LatentStatistics, WilsonsIntervalIsThatOfTextbooks) {
  const auto [low, high] = wilson(0.9, 10);
  EXPECT_NEAR(low, 0.5958, 1e-4);
  EXPECT_NEAR(high, 0.9821, 1e-4);
}

}  // namespace
}  // namespace bio::fixtures
