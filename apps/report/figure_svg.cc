#include "report/figure_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "report/axis_ticks.h"
#include "report/polyline.h"
#include "report/series_stroke.h"
#include "report/svg_text.h"
#include "report/thinned_series.h"

namespace app {
namespace {

// 140 mm at 96 pixels an inch; 11 pixels are 8.25 points.
constexpr double paperWidth = 529, plotHeight = 250, letterSize = 11;
constexpr const char* ink = "#1a1a1a";

std::string strokeAttributes(const SeriesStroke& stroke, double width) {
  std::string text =
      fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"{:g}\"", stroke.colour, width);
  if (!stroke.dashes.empty()) {
    text += " stroke-dasharray=\"";
    for (std::size_t i = 0; i < stroke.dashes.size(); ++i)
      text += fmt::format("{}{:g}", i > 0 ? " " : "", 0.75 * stroke.dashes[i]);
    text += "\"";
  }
  return text;
}

/// One of six shapes about a point, filled or outlined, so that they differ in black and white.
std::string markerPath(std::size_t shape, PlanePoint at, double r) {
  const auto [x, y] = at;
  switch (shape % 6) {
    case 0:  // disc
    case 4:  // circle
      return fmt::format("M{:.1f} {:.1f}a{r:g} {r:g} 0 1 0 {d:g} 0a{r:g} {r:g} 0 1 0 -{d:g} 0z",
                         x - r, y, fmt::arg("r", r), fmt::arg("d", 2 * r));
    case 1:  // triangle
      return fmt::format("M{:.1f} {:.1f}l{:g} {:g}h{:g}z", x, y - 1.2 * r, 1.1 * r, 2 * r,
                         -2.2 * r);
    case 2:  // square
    case 5:
      return fmt::format("M{:.1f} {:.1f}h{s:g}v{s:g}h-{s:g}z", x - 0.9 * r, y - 0.9 * r,
                         fmt::arg("s", 1.8 * r));
    default:  // cross
      return fmt::format("M{:.1f} {:.1f}l{d:g} {d:g}m0 -{d:g}l-{d:g} {d:g}", x - r, y - r,
                         fmt::arg("d", 2 * r));
  }
}

std::string markerPaint(const SeriesStroke& stroke) {
  const bool isOutline = stroke.marker % 6 >= 3;
  return isOutline ? fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"1\"", stroke.colour)
                   : fmt::format("fill=\"{}\"", stroke.colour);
}

class FigureDrawing {
 public:
  explicit FigureDrawing(const Figure& figure) : figure_(figure) {
    std::vector<double> xs, ys;
    bool onlyPoints = true;
    for (Series& series : figure_.series) {
      for (const auto* values : {&series.y, &series.bandLow, &series.bandHigh}) {
        const bool isBand = values != &series.y;
        if (values->size() != series.x.size() && !(isBand && values->empty())) {
          throw std::invalid_argument(fmt::format("figure '{}', series '{}': {} values for {} of x",
                                                  figure.title, series.name, values->size(),
                                                  series.x.size()));
        }
        ys.insert(ys.end(), values->begin(), values->end());
      }
      xs.insert(xs.end(), series.x.begin(), series.x.end());
      onlyPoints = onlyPoints && series.style == SeriesStyle::points;
      series = thinned(series);
    }
    x_ = rangeOf(xs, figure.xScale,
                 onlyPoints || figure.xScale == AxisScale::logarithmic ? 0.03 : 0);
    y_ = rangeOf(ys, figure.yScale, 0.05);
    xTicks_ = ticksOf(x_, figure.xScale, 8);
    yTicks_ = ticksOf(y_, figure.yScale, 7);
    double widest = 0;
    for (const AxisTick& tick : yTicks_)
      widest = std::max(widest, letterSize * textWidth(tick.label));
    left_ = 26 + widest;
  }

  std::string svg() const {
    const std::string legend = legendText();
    std::string text = fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" "
        "role=\"img\" "
        "width=\"140mm\" height=\"{:.1f}mm\" viewBox=\"0 0 {:g} {:g}\" font-family=\"DejaVu Sans, "
        "Verdana, "
        "Arial, sans-serif\" font-size=\"{:g}\" fill=\"{}\">\n<title>{}</title>\n<desc>{}</desc>\n",
        140 * height() / paperWidth, paperWidth, height(), letterSize, ink, svgText(figure_.title),
        svgText(figure_.caption));
    text += fmt::format("<rect width=\"{:g}\" height=\"{:g}\" fill=\"#ffffff\"/>\n", paperWidth,
                        height());
    text += axes();
    text += fmt::format(
        "<clipPath id=\"axes\"><rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" "
        "height=\"{:g}\"/></clipPath>\n"
        "<g clip-path=\"url(#axes)\" stroke-linejoin=\"round\">\n",
        left_ - 3, top_ - 3, right_ - left_ + 6, plotHeight + 6);
    const auto all = [&](auto draw) {
      for (std::size_t i = 0; i < figure_.series.size(); ++i) text += draw(i);
    };
    all([&](std::size_t i) { return band(i); });
    all([&](std::size_t i) { return isOfPoints(i) ? points(i) : ""; });
    all([&](std::size_t i) { return isOfPoints(i) ? "" : line(i); });
    return text + "</g>\n" + frame() + legend + "</svg>\n";
  }

 private:
  bool isOfPoints(std::size_t i) const { return figure_.series[i].style == SeriesStyle::points; }

  static double share(double value, const AxisRange& range, AxisScale scale) {
    return scale == AxisScale::logarithmic
               ? std::log(value / range.low) / std::log(range.high / range.low)
               : (value - range.low) / (range.high - range.low);
  }
  double placeX(double x) const { return left_ + share(x, x_, figure_.xScale) * (right_ - left_); }
  double placeY(double y) const { return bottom() - share(y, y_, figure_.yScale) * plotHeight; }
  double bottom() const { return top_ + plotHeight; }

  bool isShown(double x, double y) const {
    return std::isfinite(x) && std::isfinite(y) && (figure_.xScale == AxisScale::linear || x > 0) &&
           (figure_.yScale == AxisScale::linear || y > 0);
  }

  /// Grid, numbers and labels.
  std::string axes() const {
    std::string text;
    for (const AxisTick& tick : xTicks_) {
      text += fmt::format("<path d=\"M{:.1f} {:g}V{:.1f}\" {}/>\n", placeX(tick.value), top_,
                          bottom(), gridAttributes(tick));
      text += tickText(tick, placeX(tick.value), bottom() + 15, "middle");
    }
    for (const AxisTick& tick : yTicks_) {
      text += fmt::format("<path d=\"M{:.1f} {:.1f}H{:.1f}\" {}/>\n", left_, placeY(tick.value),
                          right_, gridAttributes(tick));
      text += tickText(tick, left_ - 5, placeY(tick.value) + 4, "end");
    }
    text +=
        axisLabel(figure_.xLabel, right_ - left_,
                  fmt::format("x=\"{:.1f}\" y=\"{:.1f}\"", (left_ + right_) / 2, bottom() + 32));
    text += axisLabel(
        figure_.yLabel, plotHeight + 20,
        fmt::format("transform=\"translate(13 {:.1f}) rotate(-90)\"", top_ + plotHeight / 2));
    return text;
  }

  static std::string gridAttributes(const AxisTick& tick) {
    return fmt::format("stroke=\"{}\" stroke-width=\"0.75\"",
                       tick.label.empty() ? "#f2f2f2" : "#e2e2e2");
  }

  static std::string tickText(const AxisTick& tick, double x, double y, const char* anchor) {
    if (tick.label.empty()) return "";
    const std::size_t power = tick.label.find("10^");
    std::string label = svgText(tick.label.substr(0, power));
    if (power != tick.label.npos) {
      label += fmt::format("10<tspan dy=\"-4\" font-size=\"8\">{}</tspan>",
                           svgText(tick.label.substr(power + 3)));
    }
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y,
                       anchor, label);
  }

  /// A label that is too long for its axis is set in smaller letters.
  static std::string axisLabel(const std::string& label, double room, const std::string& place) {
    const double wide = letterSize * textWidth(label);
    const std::string size =
        wide > room ? fmt::format(" font-size=\"{:.1f}\"", std::max(5.0, letterSize * room / wide))
                    : "";
    return fmt::format("<text {} text-anchor=\"middle\"{}>{}</text>\n", place, size,
                       svgText(label));
  }

  std::string frame() const {
    return fmt::format(
        "<path d=\"M{:.1f} {:g}V{:.1f}H{:.1f}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1\"/>\n",
        left_, top_, bottom(), right_, ink);
  }

  /// Points of a curve on paper, in one list for each stretch without a gap.
  std::vector<std::vector<PlanePoint>> stretches(const Series& series,
                                                 const std::vector<double>& values) const {
    std::vector<std::size_t> order(series.x.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    if (series.style != SeriesStyle::path) {
      std::stable_sort(order.begin(), order.end(),
                       [&](std::size_t a, std::size_t b) { return series.x[a] < series.x[b]; });
    }
    std::vector<std::vector<PlanePoint>> all(1);
    for (const std::size_t i : order) {
      if (!isShown(series.x[i], values[i])) {
        if (!all.back().empty()) all.emplace_back();
        continue;
      }
      all.back().push_back({placeX(series.x[i]), placeY(values[i])});
    }
    if (all.back().empty()) all.pop_back();
    return all;
  }

  static std::string pathThrough(const std::vector<PlanePoint>& points, const char* begin) {
    std::string text = begin;
    for (std::size_t i = 0; i < points.size(); ++i)
      text += fmt::format("{}{:.2f} {:.2f}", i > 0 ? "L" : "", points[i].x, points[i].y);
    return text;
  }

  std::string band(std::size_t index) const {
    const Series& series = figure_.series[index];
    if (series.bandLow.empty() || series.bandHigh.empty()) return "";
    const auto low = stretches(series, series.bandLow), high = stretches(series, series.bandHigh);
    std::string text;
    for (std::size_t i = 0; i < std::min(low.size(), high.size()); ++i) {
      std::vector<PlanePoint> edge = withoutInvisible(high[i], 0.05);
      std::reverse(edge.begin(), edge.end());
      text += fmt::format("<path d=\"{}{}z\" fill=\"{}\" fill-opacity=\"0.2\"/>\n",
                          pathThrough(withoutInvisible(low[i], 0.05), "M"), pathThrough(edge, "L"),
                          strokeOf(figure_, index).colour);
    }
    return text;
  }

  std::string line(std::size_t index) const {
    const Series& series = figure_.series[index];
    const SeriesStroke stroke = strokeOf(figure_, index);
    std::string path, marks;
    std::size_t count = 0;
    for (const auto& stretch : stretches(series, series.y)) {
      count += stretch.size();
      path += pathThrough(withoutInvisible(stretch, 0.05), "M");
      if (stretch.size() == 1) path += "h0.01";
    }
    if (path.empty()) return "";
    // few values, such as one for each step, are marked
    if (figure_.xScale == AxisScale::logarithmic && series.style != SeriesStyle::path &&
        count <= 40) {
      for (const auto& stretch : stretches(series, series.y))
        for (const PlanePoint& at : stretch) marks += markerPath(0, at, 2.2);
      marks = fmt::format("<path d=\"{}\" fill=\"{}\"/>\n", marks, stroke.colour);
    }
    return fmt::format("<path d=\"{}\" stroke-linecap=\"{}\" {}/>\n", path,
                       stroke.dashes.empty() ? "round" : "butt",
                       strokeAttributes(stroke, series.style == SeriesStyle::path ? 0.9 : 1.5)) +
           marks;
  }

  double markerSize(const Series& series) const {
    return series.x.size() <= 60 ? 2.6 : series.x.size() <= 600 ? 1.9 : 1.3;
  }

  std::string points(std::size_t index) const {
    const Series& series = figure_.series[index];
    const SeriesStroke stroke = strokeOf(figure_, index);
    std::string path;
    for (const auto& stretch : stretches(series, series.y)) {
      for (const PlanePoint& at : withoutRepeated(stretch, 0.3))
        path += markerPath(stroke.marker, at, markerSize(series));
    }
    return path.empty() ? "" : fmt::format("<path d=\"{}\" {}/>\n", path, markerPaint(stroke));
  }

  std::size_t legendColumns() const {
    double widest = 0;
    for (const Series& series : figure_.series)
      widest = std::max(widest, legendSample + letterSize * textWidth(series.name) + 16);
    const double fit = std::floor((paperWidth - 16) / std::max(widest, 1.0));
    return std::clamp<std::size_t>(static_cast<std::size_t>(fit), 1,
                                   std::max<std::size_t>(1, figure_.series.size()));
  }

  double height() const {
    const std::size_t rows = (figure_.series.size() + legendColumns() - 1) / legendColumns();
    return bottom() + 44 + legendRow * static_cast<double>(rows);
  }

  /// Below the axes, where it hides nothing.
  std::string legendText() const {
    const std::size_t columns = legendColumns();
    const double width = std::min((paperWidth - 16) / static_cast<double>(columns), 260.0);
    const double start = columns == 1 || figure_.series.size() < columns ? left_ : 8;
    std::string text;
    for (std::size_t i = 0; i < figure_.series.size(); ++i) {
      const SeriesStroke stroke = strokeOf(figure_, i);
      const double x = start + width * static_cast<double>(i % columns);
      const double y = bottom() + 52 + legendRow * static_cast<double>(i / columns);
      if (isOfPoints(i)) {
        text += fmt::format("<path d=\"{}\" {}/>", markerPath(stroke.marker, {x + 14, y - 4}, 2.6),
                            markerPaint(stroke));
      } else {
        text += fmt::format("<path d=\"M{:.1f} {:.1f}h28\" {}/>", x, y - 4,
                            strokeAttributes(stroke, 1.5));
      }
      // a name that is wider than the paper is squeezed rather than cut off
      const double room = paperWidth - x - legendSample - 4;
      const std::string& name = figure_.series[i].name;
      const std::string squeeze =
          letterSize * textWidth(name) > 1.1 * room
              ? fmt::format(" textLength=\"{:.0f}\" lengthAdjust=\"spacingAndGlyphs\"", room)
              : "";
      text += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\"{}>{}</text>\n", x + legendSample, y,
                          squeeze, svgText(name));
    }
    return text;
  }

  static constexpr double legendRow = 17, legendSample = 34, top_ = 10, right_ = paperWidth - 14;
  Figure figure_;  ///< long curves thinned
  AxisRange x_, y_;
  std::vector<AxisTick> xTicks_, yTicks_;
  double left_ = 0;
};

}  // namespace

std::string figureSvg(const Figure& figure) {
  return FigureDrawing(figure).svg();
}

}  // namespace app
