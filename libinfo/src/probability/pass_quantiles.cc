#include "info/probability/pass_quantiles.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <set>

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
    if (search.isFound || order < search.low || order > search.high) continue;
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
}

void PassQuantiles::endPass(Search& s) const {
  const std::uint64_t within = s.rank - s.below;
  if (s.bins.empty()) {
    const auto at = s.values.begin() + static_cast<std::ptrdiff_t>(within);
    std::nth_element(s.values.begin(), at, s.values.end());
    s.value = *at;
    s.values = {};
    s.isFound = true;
    return;
  }
  std::size_t bin = 0;
  std::uint64_t before = 0;
  while (before + s.bins[bin] <= within) before += s.bins[bin++];
  const std::uint64_t width = s.width();
  s.below += before;
  s.inside = s.bins[bin];
  s.low += bin * width;
  s.high = std::min(s.high, s.low + (width - 1));
  s.bins = {};
}

bool PassQuantiles::wantsAnotherPass() {
  bool wants = false;
  for (Column& column : columns_) {
    if (isFirst_ && column.count > kept()) beginSearches(column);
    for (Search& search : column.searches) {
      if (!isFirst_ && !search.isFound) endPass(search);
      if (search.low == search.high) {
        search.value = numberAt(search.low);
        search.isFound = true;
      }
      if (search.isFound) continue;
      if (search.inside > kept()) search.bins.assign(bins_, 0);
      wants = true;
    }
  }
  isFirst_ = false;
  return wants;
}

double PassQuantiles::mean(std::size_t column) const {
  return columns_[column].count > 0 ? columns_[column].mean : none;
}

double PassQuantiles::sd(std::size_t column) const {
  const Column& c = columns_[column];
  return c.count > 1 ? std::sqrt(c.squares / static_cast<double>(c.count - 1)) : none;
}

double PassQuantiles::orderStatistic(const Column& column, std::uint64_t rank) const {
  const auto is = [&](const Search& search) { return search.rank == rank; };
  return std::ranges::find_if(column.searches, is)->value;
}

double PassQuantiles::quantile(std::size_t index, std::size_t share) const {
  const Column& column = columns_[index];
  if (column.count <= kept()) return quantileOf(column.first, shares_[share]);
  const Place place = placeOf(column.count, shares_[share]);
  return std::lerp(orderStatistic(column, place.below), orderStatistic(column, place.above),
                   place.weight);
}

}  // namespace info
