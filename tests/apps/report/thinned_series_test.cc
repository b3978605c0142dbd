#include "report/thinned_series.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace app {
namespace {

Series longWave(std::size_t count) {
  Series series{.name = "wave"};
  for (std::size_t i = 0; i < count; ++i) {
    series.x.push_back(static_cast<double>(i));
    series.y.push_back(std::sin(1e-3 * static_cast<double>(i)));
  }
  return series;
}

TEST(ThinnedSeries, KeepsEndsAndEveryPeakOfALongCurve) {
  Series series = longWave(500000);
  series.y[123456] = 7;
  series.y[400001] = -9;
  const Series drawn = thinned(series);
  EXPECT_LE(drawn.x.size(), 4002u);
  EXPECT_EQ(drawn.x.size(), drawn.y.size());
  EXPECT_EQ(drawn.x.front(), 0);
  EXPECT_EQ(drawn.x.back(), 499999);
  const auto peak = std::max_element(drawn.y.begin(), drawn.y.end());
  EXPECT_EQ(*peak, 7);
  EXPECT_EQ(drawn.x[static_cast<std::size_t>(peak - drawn.y.begin())], 123456);
  EXPECT_EQ(*std::min_element(drawn.y.begin(), drawn.y.end()), -9);
  EXPECT_TRUE(std::is_sorted(drawn.x.begin(), drawn.x.end()));
}

TEST(ThinnedSeries, KeepsGapsAndBands) {
  Series series = longWave(100000);
  series.y[50000] = std::nan("");
  series.bandLow = series.bandHigh = series.y;
  series.bandHigh[70000] = 5;
  const Series drawn = thinned(series);
  EXPECT_EQ(std::count_if(drawn.y.begin(), drawn.y.end(), [](double y) { return std::isnan(y); }),
            1);
  EXPECT_EQ(drawn.bandLow.size(), drawn.x.size());
  ASSERT_EQ(drawn.bandHigh.size(), drawn.x.size());
  EXPECT_EQ(std::count(drawn.bandHigh.begin(), drawn.bandHigh.end(), 5.0), 1);
}

TEST(ThinnedSeries, LeavesShortCurvesPathsAndTurningOnesAsTheyAre) {
  EXPECT_EQ(thinned(longWave(8000)).x.size(), 8000u);
  Series path = longWave(20000);
  path.style = SeriesStyle::path;
  EXPECT_EQ(thinned(path).x.size(), 20000u);
  Series turning = longWave(20000);
  std::swap(turning.x[5], turning.x[6]);
  EXPECT_EQ(thinned(turning).x.size(), 20000u);
}

}  // namespace
}  // namespace app
