#include "report/series_stroke.h"

#include <algorithm>
#include <array>

namespace app {

SeriesStroke strokeOf(const Figure& figure, std::size_t index) {
  static const std::array<const char*, 8> colours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                     "#000000", "#E69F00", "#56B4E9", "#808080"};
  static const std::array<std::vector<double>, 5> dashes = {
      {{}, {9, 4}, {2, 3}, {9, 3, 2, 3}, {16, 4}}};
  const Series& series = figure.series.at(index);
  const bool points = series.style == SeriesStyle::points;
  const auto before = static_cast<std::size_t>(std::count_if(
      figure.series.begin(), figure.series.begin() + static_cast<std::ptrdiff_t>(index),
      [&](const Series& other) { return (other.style == SeriesStyle::points) == points; }));
  SeriesStroke stroke{.colour = colours[index % colours.size()]};
  if (points) {
    stroke.marker = before;
  } else {
    const std::size_t pattern = before % dashes.size();
    stroke.dashes = dashes[pattern == 0 && series.style == SeriesStyle::dashed ? 1 : pattern];
  }
  return stroke;
}

}  // namespace app
