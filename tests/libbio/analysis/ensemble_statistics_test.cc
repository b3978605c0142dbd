#include "bio/analysis/ensemble_statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace bio {
namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

TEST(EnsembleStatistics, SpreadIsOfTheFiniteValues) {
  const Spread s = spreadOf({1, missing, 2, 3, INFINITY, 4, 5});
  EXPECT_DOUBLE_EQ(s.mean, 3);
  EXPECT_DOUBLE_EQ(s.sd, std::sqrt(2.5));
  EXPECT_DOUBLE_EQ(s.p5, 1.2);
  EXPECT_DOUBLE_EQ(s.p50, 3);
  EXPECT_DOUBLE_EQ(s.p95, 4.8);
  EXPECT_TRUE(std::isnan(spreadOf({missing}).mean));
  EXPECT_TRUE(std::isnan(spreadOf({2}).sd));
}

// y = 3 x₁ + x₂ on the unit square: S = (0.9, 0.1), no interactions.
TEST(EnsembleStatistics, SobolKnowsASum) {
  std::vector<double> values;
  for (std::uint64_t k = 0; k < 4 * 512; ++k) {
    const Eigen::VectorXd x = info::sobolPoint(k, 2, 1);
    values.push_back(3 * x[0] + x[1]);
  }
  values[9] = missing;
  const SobolFinding found = sobolOf(values, 2, 1);
  EXPECT_EQ(found.indices.undefined, 1);
  EXPECT_NEAR(found.indices.first[0], 0.9, 0.02);
  EXPECT_NEAR(found.indices.total[1], 0.1, 0.02);
  EXPECT_LT(found.intervals.first(0, 0), found.indices.first[0]);
  EXPECT_GT(found.intervals.first(0, 1), found.indices.first[0]);
}

TEST(EnsembleStatistics, ARunLeavesTheRangeByMoreThanATenthOfIt) {
  Coordinate c;
  c.isRotation = true;
  c.rangeMin = 0;
  c.rangeMax = 2;
  EXPECT_FALSE(leavesRange(c, -0.19, 2.19));
  EXPECT_TRUE(leavesRange(c, -0.21, 1));
  EXPECT_TRUE(leavesRange(c, 1, 2.21));
  EXPECT_FALSE(leavesRange(c, missing, missing));
  c.rangeMax = 0;  // a degree at least
  EXPECT_FALSE(leavesRange(c, 0, 0.017));
  EXPECT_TRUE(leavesRange(c, 0, 0.018));
}

}  // namespace
}  // namespace bio
