#include "report/figure_svg.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include "report/axis_ticks.h"
#include "report/polyline.h"
#include "report/series_stroke.h"

namespace app {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

std::size_t countOf(const std::string& text, const std::string& what) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find(what, at)) != text.npos; ++at) ++count;
  return count;
}

Figure paperFigure() {
  return {.title = "Angle & moment",
          .xLabel = "Time [s]",
          .yLabel = "Angle [deg]",
          .series = {{.name = "simulated",
                      .x = {0, 1, 2, 3},
                      .y = {0, 10, 15, 30},
                      .bandLow = {-1, 9, 14, 28},
                      .bandHigh = {1, 11, 16, 32}},
                     {.name = "measured",
                      .x = {0, 1, 2},
                      .y = {1, std::numeric_limits<double>::quiet_NaN(), 3},
                      .style = SeriesStyle::points}},
          .caption = "What to see."};
}

TEST(FigureSvg, HasLabelsLegendBandAndItsTitleAsText) {
  const std::string svg = figureSvg(paperFigure());
  EXPECT_THAT(svg, AllOf(HasSubstr("<title>Angle &amp; moment</title>"),
                         HasSubstr("<desc>What to see.</desc>"), HasSubstr(">Time [s]</text>"),
                         HasSubstr(">Angle [deg]</text>"), HasSubstr(">simulated</text>"),
                         HasSubstr(">measured</text>"), HasSubstr("width=\"140mm\"")));
  EXPECT_EQ(countOf(svg, "fill-opacity=\"0.2\""), 1u);
  // two measured values and the one of the legend, below the line
  EXPECT_EQ(countOf(svg, "a1.9 1.9") + countOf(svg, "a2.6 2.6"), 6u);
  EXPECT_LT(svg.find("a2.6 2.6"), svg.find("stroke-linecap"));
}

TEST(FigureSvg, TakesTextLiterallyAndLeavesOutWhatXmlForbids) {
  Figure figure = paperFigure();
  figure.series[0].name = "</text><script>alert(1)</script>";
  figure.title = "a\x01\xff]]>";
  EXPECT_THAT(figureSvg(figure), AllOf(Not(HasSubstr("<script")), HasSubstr("&lt;script&gt;"),
                                       HasSubstr("<title>a\uFFFD\uFFFD]]&gt;")));
}

TEST(FigureSvg, DrawsALongSmoothCurveByFewPoints) {
  Figure figure = paperFigure();
  Series wave{.name = "wave"};
  for (int k = 0; k < 100000; ++k) {
    wave.x.push_back(1e-4 * k);
    wave.y.push_back(std::sin(1e-4 * k));
  }
  figure.series = {wave};
  EXPECT_LT(figureSvg(figure).size(), 8000u);  // 4.6 kB; 1.3 MB with every point
}

TEST(FigureSvg, DrawsWhatHasNothingToShow) {
  for (const AxisScale scale : {AxisScale::linear, AxisScale::logarithmic}) {
    Figure figure = paperFigure();
    figure.xScale = figure.yScale = scale;
    EXPECT_THAT(figureSvg(figure), Not(HasSubstr("nan")));
    for (const double value : {0.0, -3.0, HUGE_VAL, 1e-310, 1e308}) {
      figure.series = {{.name = "one", .x = {value}, .y = {value}}};
      EXPECT_THAT(figureSvg(figure), AllOf(Not(HasSubstr("nan")), Not(HasSubstr("inf"))));
    }
    figure.series.clear();
    EXPECT_THAT(figureSvg(figure), HasSubstr("</svg>"));
  }
  Figure figure = paperFigure();
  figure.series[0].y.pop_back();
  EXPECT_THROW(figureSvg(figure), std::invalid_argument);
}

TEST(SeriesStroke, FortyLinesDifferInColourOrDashes) {
  Figure figure;
  figure.series.resize(40);
  std::set<std::pair<std::string, std::vector<double>>> strokes;
  for (std::size_t i = 0; i < 40; ++i) {
    const SeriesStroke stroke = strokeOf(figure, i);
    strokes.insert({stroke.colour, stroke.dashes});
    if (i > 0) {
      EXPECT_NE(stroke.dashes, strokeOf(figure, i - 1).dashes) << i;
    }
  }
  EXPECT_EQ(strokes.size(), 40u);
  figure.series[0].style = SeriesStyle::dashed;
  EXPECT_FALSE(strokeOf(figure, 0).dashes.empty());
  // a curve called dashed differs from the lines beside it, wherever it stands
  for (std::size_t i = 1; i < 4; ++i)
    EXPECT_NE(strokeOf(figure, i).dashes, strokeOf(figure, 0).dashes) << i;
  figure.series[0].style = SeriesStyle::line;
  // points between lines take none of their dashes
  figure.series[1].style = figure.series[2].style = SeriesStyle::points;
  EXPECT_EQ(strokeOf(figure, 2).marker, 1u);
  EXPECT_EQ(strokeOf(figure, 3).dashes, strokeOf({.series = std::vector<Series>(2)}, 1).dashes);
}

std::vector<std::string> labelsOf(const AxisRange& range, AxisScale scale) {
  std::vector<std::string> labels;
  for (const AxisTick& tick : ticksOf(range, scale, 6))
    if (!tick.label.empty()) labels.push_back(tick.label);
  return labels;
}

TEST(AxisTicks, StandAtRoundNumbersWithAsManyDecimals) {
  EXPECT_THAT(labelsOf({-0.2, 0.39}, AxisScale::linear),
              ElementsAre("−0.2", "−0.1", "0", "0.1", "0.2", "0.3"));
  EXPECT_THAT(labelsOf({0, 100}, AxisScale::linear),
              ElementsAre("0", "20", "40", "60", "80", "100"));
  EXPECT_THAT(labelsOf({0, 3.1e-5}, AxisScale::linear),
              ElementsAre("0", "10^−5", "2·10^−5", "3·10^−5"));
  EXPECT_THAT(labelsOf({1e-3, 20}, AxisScale::logarithmic),
              ElementsAre("10^−3", "10^−2", "10^−1", "1", "10^1"));
  EXPECT_THAT(labelsOf({1.5, 30}, AxisScale::logarithmic), ElementsAre("2", "5", "10^1", "2·10^1"));
}

TEST(AxisTicks, RangeHasAMarginAndHoldsAConstant) {
  const AxisRange linear = rangeOf({0, 10}, AxisScale::linear, 0.1);
  EXPECT_DOUBLE_EQ(linear.low, -1);
  EXPECT_DOUBLE_EQ(linear.high, 11);
  const AxisRange constant = rangeOf({5, 5 + 1e-12}, AxisScale::linear, 0.1);
  EXPECT_NEAR(constant.low, 4.5, 1e-9);
  const AxisRange positive = rangeOf({-1, 0, 1, 100}, AxisScale::logarithmic, 0.5);
  EXPECT_DOUBLE_EQ(positive.low, 0.1);
  EXPECT_DOUBLE_EQ(positive.high, 1000);
}

TEST(Polyline, KeepsWhatCanBeSeen) {
  const std::vector<PlanePoint> corner = {{0, 0}, {1, 0.01}, {2, 0}, {2, 1}, {2.01, 2}};
  const auto kept = withoutInvisible(corner, 0.05);
  ASSERT_EQ(kept.size(), 3u);
  EXPECT_EQ(kept[1].x, 2);
  EXPECT_EQ(kept[1].y, 0);
  // a line that turns back on itself
  EXPECT_EQ(withoutInvisible({{0, 0}, {5, 0}, {0, 0}}, 0.05).size(), 3u);
  EXPECT_EQ(withoutRepeated({{0, 0}, {0.1, 0}, {1, 0}}, 0.3).size(), 2u);
}

}  // namespace
}  // namespace app
