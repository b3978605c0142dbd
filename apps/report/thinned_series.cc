#include "report/thinned_series.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace app {
namespace {

constexpr std::size_t parts = thinnedParts;

/// Places of the lowest and highest of values[from..to), and of the first that is no number.
void addExtremes(const std::vector<double>& values, std::size_t from, std::size_t to,
                 std::set<std::size_t>& kept) {
  std::size_t lowest = to, highest = to;
  bool gap = false;
  for (std::size_t i = from; i < to; ++i) {
    if (!std::isfinite(values[i])) {
      if (!gap) kept.insert(i);
      gap = true;
      continue;
    }
    if (lowest == to || values[i] < values[lowest]) lowest = i;
    if (highest == to || values[i] > values[highest]) highest = i;
  }
  if (lowest < to) kept.insert({lowest, highest});
}

std::vector<double> only(const std::vector<double>& values, const std::set<std::size_t>& kept) {
  std::vector<double> chosen;
  if (values.empty()) return chosen;
  for (const std::size_t i : kept) chosen.push_back(values[i]);
  return chosen;
}

}  // namespace

Series thinned(const Series& series) {
  const std::size_t count = series.x.size();
  if (count <= 4 * parts || series.style == SeriesStyle::path ||
      !std::is_sorted(series.x.begin(), series.x.end())) {
    return series;
  }
  std::set<std::size_t> kept = {0, count - 1};
  for (std::size_t part = 0; part < parts; ++part) {
    const std::size_t from = part * count / parts, to = (part + 1) * count / parts;
    for (const auto* values : {&series.y, &series.bandLow, &series.bandHigh}) {
      if (!values->empty()) addExtremes(*values, from, to, kept);
    }
  }
  Series drawn = series;
  drawn.x = only(series.x, kept);
  drawn.y = only(series.y, kept);
  drawn.bandLow = only(series.bandLow, kept);
  drawn.bandHigh = only(series.bandHigh, kept);
  return drawn;
}

}  // namespace app
