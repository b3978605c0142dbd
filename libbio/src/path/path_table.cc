#include "bio/path/path_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace bio {
namespace {

bool agree(const PathTable::Value& a, const PathTable::Value& b) {
  return std::abs(a.length - b.length) <= PathTable::lengthError &&
         std::abs(a.slope - b.slope) <= PathTable::slopeError &&
         std::abs(a.curvature - b.curvature) <= PathTable::curvatureError && a.wrapped == b.wrapped;
}

/// Coefficients of the quintic over 0 ≤ x ≤ 1 that meets value, slope and curvature at both ends.
std::array<double, 6> quintic(const PathTable::Value& a, const PathTable::Value& b, double width) {
  const double slope = a.slope * width, bend = a.curvature * width * width / 2;
  // what the parabola from the left end leaves to do at the right end
  const double rise = b.length - (a.length + slope + bend);
  const double turn = b.slope * width - (slope + 2 * bend);
  const double curve = b.curvature * width * width - 2 * bend;
  return {a.length,
          slope,
          bend,
          10 * rise - 4 * turn + curve / 2,
          -15 * rise + 7 * turn - curve,
          6 * rise - 3 * turn + curve / 2};
}

}  // namespace

PathTable::PathTable(double lowest, double highest, std::size_t pieces,
                     const std::function<Value(double q)>& exact)
    : lowest_(lowest) {
  const double range = highest - lowest;
  if (!(range > 0 && std::isfinite(range)) || pieces == 0) {
    throw std::invalid_argument(
        fmt::format("path table: {} pieces between {} and {}", pieces, lowest, highest));
  }
  perWidth_ = static_cast<double>(pieces) / range;
  const double width = 1 / perWidth_;
  pieces_.resize(pieces);
  Value left = exact(lowest);
  for (std::size_t i = 0; i < pieces; ++i) {
    const double from = lowest + static_cast<double>(i) * width;
    const Value right = exact(lowest + static_cast<double>(i + 1) * width);
    Piece& piece = pieces_[i];
    piece.c = quintic(left, right, width);
    piece.wrapped = left.wrapped;
    piece.stands = left.wrapped == right.wrapped;
    Value middle;
    piece.stands =
        piece.stands && find(from + width / 2, middle) && agree(middle, exact(from + width / 2));
    left = right;
  }
}

std::size_t PathTable::standing() const {
  return static_cast<std::size_t>(std::count_if(pieces_.begin(), pieces_.end(),
                                                [](const Piece& piece) { return piece.stands; }));
}

}  // namespace bio
