#include "report/interval_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "output/text.h"

namespace app {
namespace {

constexpr double width = 960, rowHeight = 30, topMargin = 34, bottomMargin = 52, rightEdge = 930;
// Names stand left of the scale, which gives way to long ones as far as that. A character is 7.4
// wide on average (DejaVu Sans of 15), names of many capitals more.
constexpr double leastLeft = 300, mostLeft = 640, labelGap = 14, perCharacter = 8.2;

// Of UTF-8 text.
std::ptrdiff_t characters(const std::string& text) {
  return std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; });
}

/// 1, 2 or 5 times a power of ten, so that about six steps fit into the span.
double tickStep(double span) {
  const double rough = span / 6, power = std::pow(10, std::floor(std::log10(rough)));
  for (const double m : {1.0, 2.0, 5.0}) {
    if (m * power >= rough) return m * power;
  }
  return 10 * power;
}

struct Scale {
  double low, high;
  double left;  ///< where `low` is drawn
  double place(double value) const {
    const double inside = std::clamp(value, low, high);
    return left + (inside - low) / (high - low) * (rightEdge - left);
  }
};

Scale scaleOf(const std::vector<IntervalRow>& rows) {
  double low = 0, high = 0;
  const auto widen = [&](double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  };
  for (const IntervalRow& row : rows) {
    if (row.estimate) widen(*row.estimate);
    for (const auto& pair : {row.interval, row.before}) {
      if (pair) {
        widen(pair->first);
        widen(pair->second);
      }
    }
  }
  const double margin = high > low ? 0.05 * (high - low) : 1;
  std::ptrdiff_t longest = 0;
  for (const IntervalRow& row : rows) longest = std::max(longest, characters(row.name));
  return {low - margin, high + margin,
          std::clamp(labelGap + perCharacter * static_cast<double>(longest), leastLeft, mostLeft)};
}

std::string bar(const Scale& scale, double y, const std::pair<double, double>& ends,
                const char* colour, double thickness) {
  return fmt::format(
      "<line x1=\"{:.1f}\" x2=\"{:.1f}\" y1=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" "
      "stroke-width=\"{}\"/>\n",
      scale.place(ends.first), scale.place(ends.second), y, y, colour, thickness);
}

}  // namespace

std::string intervalDrawing(const std::vector<IntervalRow>& rows, const std::string& xLabel) {
  const Scale scale = scaleOf(rows);
  const double left = scale.left;
  const double bottom = topMargin + rowHeight * static_cast<double>(rows.size());
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" width=\"100%\" "
      "font-family=\"sans-serif\" font-size=\"15\">\n",
      width, bottom + bottomMargin);
  // what the colours mean, where there are two
  const bool both = std::any_of(rows.begin(), rows.end(),
                                [](const IntervalRow& row) { return row.before.has_value(); });
  if (both) {
    svg += fmt::format(
        "<line x1=\"{0}\" x2=\"{1}\" y1=\"14\" y2=\"14\" stroke=\"#bbbbbb\" "
        "stroke-width=\"10\"/><text x=\"{2}\" y=\"19\">prior</text><line x1=\"{3}\" x2=\"{4}\" "
        "y1=\"14\" y2=\"14\" stroke=\"#0072B2\" stroke-width=\"4\"/><text x=\"{5}\" "
        "y=\"19\">estimate and interval</text>\n",
        left, left + 30, left + 38, left + 200, left + 230, left + 238);
  }
  // axis
  const double step = tickStep(scale.high - scale.low);
  for (double k = std::ceil(scale.low / step); k * step <= scale.high; ++k) {
    const double x = scale.place(k * step);
    svg += fmt::format(
        "<line x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\" stroke=\"#dddddd\"/>"
        "<text x=\"{0:.1f}\" y=\"{3}\" text-anchor=\"middle\">{4}</text>\n",
        x, topMargin, bottom, bottom + 20, numberText(k == 0 ? 0.0 : k * step, 3));
  }
  svg +=
      fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\" font-weight=\"bold\">{}</text>\n",
                  (left + rightEdge) / 2, bottom + 44, htmlText(xLabel));
  // rows
  double y = topMargin + rowHeight / 2;
  for (const IntervalRow& row : rows) {
    // one that is longer still is narrowed rather than cut off
    const double room = left - labelGap;
    const std::string narrow =
        perCharacter * static_cast<double>(characters(row.name)) > room
            ? fmt::format(" textLength=\"{:.1f}\" lengthAdjust=\"spacingAndGlyphs\"", room)
            : "";
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\"{}>{}</text>\n",
                       left - labelGap, y + 5, narrow, htmlText(row.name));
    if (row.before) svg += bar(scale, y, *row.before, "#bbbbbb", 10);
    if (row.interval) svg += bar(scale, y, *row.interval, "#0072B2", 4);
    if (row.estimate) {
      svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\" fill=\"#0072B2\"/>\n",
                         scale.place(*row.estimate), y);
    }
    y += rowHeight;
  }
  return svg + "</svg>\n";
}

}  // namespace app
