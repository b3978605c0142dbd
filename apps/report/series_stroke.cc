#include "report/series_stroke.h"

#include <algorithm>
#include <array>

namespace app {

SeriesStroke strokeOf(const Figure& figure, std::size_t index) {
  static const std::array<const char*, 8> colours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                     "#000000", "#E69F00", "#56B4E9", "#808080"};
  static const std::array<std::vector<double>, 5> dashes = {
      {{}, {9, 4}, {2, 3}, {9, 3, 2, 3}, {16, 4}}};
  // curves that are called dashed take patterns from the other end, so that they differ from the
  // lines
  static const std::array<std::size_t, 5> alone = {0, 1, 2, 3, 4}, besideDashed = {0, 2, 3, 4, 1},
                                          dashed = {1, 4, 3, 2, 1};
  const auto kindOf = [](const Series& one) {
    return one.style == SeriesStyle::path ? SeriesStyle::line : one.style;
  };
  const auto& all = figure.series;
  const SeriesStyle kind = kindOf(all.at(index));
  const auto isOfKind = [&](const Series& one) { return kindOf(one) == kind; };
  const auto before = static_cast<std::size_t>(
      std::count_if(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(index), isOfKind));
  SeriesStroke stroke{.colour = colours[index % colours.size()]};
  if (kind == SeriesStyle::points) {
    stroke.marker = before;
    return stroke;
  }
  const bool hasDashed = std::any_of(
      all.begin(), all.end(), [](const Series& one) { return one.style == SeriesStyle::dashed; });
  const auto& order = kind == SeriesStyle::dashed ? dashed : hasDashed ? besideDashed : alone;
  stroke.dashes = dashes[order[before % order.size()]];
  return stroke;
}

}  // namespace app
