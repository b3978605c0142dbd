#include "view/chart.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "view/virtual_display.h"

namespace {

using namespace bio::view;

class Charts : public ::testing::Test {
 protected:
  static constexpr int width = 640, height = 400;

  /// A steep and a flat line.
  Chart twoLines() const {
    return {"Two lines",   "Time [s]",
            "Angle [deg]", false,
            false,         {{"steep", {0, 1, 2}, {0, 10, 20}}, {"flat", {0, 1, 2}, {5, 5, 5}}}};
  }

  static bool isNear(const Image& image, int x, int y, int red, int green, int blue) {
    const auto first = 3 * static_cast<std::size_t>(y * image.width + x);
    return std::abs(image.rgb[first] - red) + std::abs(image.rgb[first + 1] - green) +
               std::abs(image.rgb[first + 2] - blue) <
           40;
  }

  /// Mean row of the pixels of a colour between two columns; NaN without any.
  static double meanRow(const Image& image, int left, int right, int red, int green, int blue) {
    double sum = 0;
    int count = 0;
    for (int y = height / 8; y < height * 7 / 8; ++y) {
      for (int x = left; x < right; ++x) {
        if (!isNear(image, x, y, red, green, blue)) continue;
        sum += y;
        ++count;
      }
    }
    return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
  }

  VirtualDisplay display_;
};

TEST_F(Charts, CurvesHaveTheirColoursAndRiseUpwards) {
  const Image image = drawChart(twoLines(), width, height);
  const double steepLeft = meanRow(image, 120, 200, 0, 114, 178);
  const double steepRight = meanRow(image, 320, 400, 0, 114, 178);
  EXPECT_GT(steepLeft, steepRight + 40) << "row 0 is the upper one";
  const double flatLeft = meanRow(image, 120, 200, 213, 94, 0);
  const double flatRight = meanRow(image, 320, 400, 213, 94, 0);
  EXPECT_NEAR(flatLeft, flatRight, 2);
}

TEST_F(Charts, APowerIsAStraightLineOnLogarithmicAxes) {
  Chart chart = twoLines();
  chart.xLogarithmic = chart.yLogarithmic = true;
  ChartCurve square{"square", {}, {}};
  for (double x = 0.001; x < 1.01; x *= 1.1) {
    square.x.push_back(x);
    square.y.push_back(x * x);
  }
  square.x.insert(square.x.begin(), {-1, 0.1});
  square.y.insert(square.y.begin(), {1, 0});
  chart.curves = {square};
  const Image image = drawChart(chart, width, height);
  const double left = meanRow(image, 150, 160, 0, 114, 178);
  const double middle = meanRow(image, 250, 260, 0, 114, 178);
  const double right = meanRow(image, 350, 360, 0, 114, 178);
  EXPECT_GT(left, right + 40);
  EXPECT_NEAR(middle, (left + right) / 2, 3);
}

TEST_F(Charts, TitleAndAxesAreWrittenOutsideTheCurves) {
  const Image first = drawChart(twoLines(), width, height);
  const auto changedRows = [&](const Chart& chart) {
    const Image other = drawChart(chart, width, height);
    std::vector<int> rows;
    for (int y = 0; y < height; ++y) {
      const auto from = static_cast<std::ptrdiff_t>(3 * y * width);
      if (!std::equal(first.rgb.begin() + from, first.rgb.begin() + from + 3 * width,
                      other.rgb.begin() + from)) {
        rows.push_back(y);
      }
    }
    return rows;
  };
  Chart chart = twoLines();
  chart.title = "Two other lines";
  ASSERT_FALSE(changedRows(chart).empty());
  EXPECT_LT(changedRows(chart).back(), height / 6);
  chart = twoLines();
  chart.xLabel = "Step [s]";
  ASSERT_FALSE(changedRows(chart).empty());
  EXPECT_GT(changedRows(chart).front(), height * 5 / 6);
}

TEST_F(Charts, RefusesListsOfDifferentLengthAndDrawsNothingOfNothing) {
  Chart chart = twoLines();
  chart.curves[0].y.pop_back();
  EXPECT_THROW(drawChart(chart, width, height), std::invalid_argument);
  chart.curves[0] = {"empty", {}, {}};
  chart.curves[1].y = std::vector<double>(3, std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(drawChart(chart, width, height).rgb.size(), 3u * width * height);
}

}  // namespace
