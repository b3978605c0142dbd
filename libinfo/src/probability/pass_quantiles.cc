#include "info/probability/pass_quantiles.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include "info/probability/quantile.h"

namespace info {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

// Place of a finite number among all doubles, in rising order.
std::uint64_t orderOf(double x) {
  const auto bits = std::bit_cast<std::uint64_t>(x);
  constexpr std::uint64_t sign = std::uint64_t{1} << 63;
  return (bits & sign) != 0 ? ~bits : bits | sign;
}

double numberAt(std::uint64_t order) {
  constexpr std::uint64_t sign = std::uint64_t{1} << 63;
  return std::bit_cast<double>((order & sign) != 0 ? order ^ sign : ~order);
}

[[noreturn]] void otherValues() {
  throw std::logic_error("PassQuantiles: a pass had other values than the one before");
}

struct Place {
  std::uint64_t below, above;
  double weight;  // of the upper one
};

Place placeOf(std::uint64_t count, double share) {
  const double place = share * static_cast<double>(count - 1);
  const auto below = static_cast<std::uint64_t>(place);
  return {below, std::min(below + 1, count - 1), place - static_cast<double>(below)};
}

}  // namespace

PassQuantiles::PassQuantiles(std::size_t columns, std::vector<double> shares)
    : shares_(std::move(shares)), columns_(columns) {
  constexpr std::size_t allBins = std::size_t{1} << 22;  // of four bytes
  const std::size_t searches = std::max<std::size_t>(1, 2 * columns * shares_.size());
  bins_ = std::clamp<std::size_t>(allBins / searches, 256, std::size_t{1} << 16);
}

void PassQuantiles::add(std::size_t index, double x) {
  if (!std::isfinite(x)) return;
  x += 0.0;  // −0 is 0: they are the same value, but not the same number
  Column& column = columns_[index];
  if (isFirst_) {
    if (column.count++ == 0) column.least = column.most = x;
    column.least = std::min(column.least, x);
    column.most = std::max(column.most, x);
    const double before = x - column.mean;
    column.mean += before / static_cast<double>(column.count);
    column.squares += before * (x - column.mean);
    if (column.first.size() < kept()) column.first.push_back(x);
    return;
  }
  const std::uint64_t order = orderOf(x);
  for (Search& search : column.searches) {
    if (search.isFound() || order < search.low || order > search.high) continue;
    if (search.bins.empty()) {
      search.values.push_back(x);
    } else {
      ++search.bins[(order - search.low) / search.width()];
    }
  }
}

void PassQuantiles::beginSearches(Column& column) const {
  std::set<std::uint64_t> ranks;
  for (const double share : shares_) {
    const Place place = placeOf(column.count, share);
    ranks.insert({place.below, place.above});
  }
  for (const std::uint64_t rank : ranks)
    column.searches.push_back({rank, orderOf(column.least), orderOf(column.most), column.count});
  column.first = {};
}

void PassQuantiles::Search::narrow() {
  const std::uint64_t within = rank - below;
  if (bins.empty()) {
    if (values.size() != inside) otherValues();
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(within);
    std::nth_element(values.begin(), at, values.end());
    low = high = orderOf(*at);
    values = {};
    return;
  }
  std::size_t bin = 0;
  std::uint64_t before = 0;
  while (bin < bins.size() && before + bins[bin] <= within) before += bins[bin++];
  if (bin == bins.size()) otherValues();
  const std::uint64_t size = width();
  below += before;
  inside = bins[bin];
  low += bin * size;
  high = std::min(high, low + (size - 1));
  bins = {};
}

bool PassQuantiles::endPass() {
  bool isLast = true;
  for (Column& column : columns_) {
    if (isFirst_ && column.count > kept()) beginSearches(column);
    for (Search& search : column.searches) {
      if (!isFirst_ && !search.isFound()) search.narrow();
      if (search.isFound()) continue;
      if (search.inside > kept()) search.bins.assign(bins_, 0);
      isLast = false;
    }
  }
  isFirst_ = false;
  return isLast;
}

double PassQuantiles::mean(std::size_t column) const {
  return columns_[column].count > 0 ? columns_[column].mean : none;
}

double PassQuantiles::sd(std::size_t column) const {
  const Column& c = columns_[column];
  return c.count > 1 ? std::sqrt(c.squares / static_cast<double>(c.count - 1)) : none;
}

double PassQuantiles::quantile(std::size_t index, std::size_t share) const {
  const Column& column = columns_[index];
  if (column.count <= kept()) return quantileOf(column.first, shares_[share]);
  const Place place = placeOf(column.count, shares_[share]);
  const auto at = [&](std::uint64_t rank) {
    return numberAt(std::ranges::find(column.searches, rank, &Search::rank)->low);
  };
  return std::lerp(at(place.below), at(place.above), place.weight);
}

}  // namespace info
