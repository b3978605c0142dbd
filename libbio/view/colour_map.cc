#include "view/colour_map.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace bio::view {

Colour viridis(double x) {
  constexpr std::array<std::array<int, 3>, 9> knots = {{{68, 1, 84},
                                                        {71, 44, 122},
                                                        {59, 81, 139},
                                                        {44, 113, 142},
                                                        {33, 144, 141},
                                                        {39, 173, 129},
                                                        {92, 200, 99},
                                                        {170, 220, 50},
                                                        {253, 231, 37}}};
  const double place = (x > 0 ? std::min(x, 1.0) : 0.0) * (knots.size() - 1);
  const auto low = std::min(static_cast<std::size_t>(place), knots.size() - 2);
  const double fraction = place - static_cast<double>(low);
  Colour colour;
  for (std::size_t c = 0; c < 3; ++c) {
    colour[c] = (knots[low][c] + fraction * (knots[low + 1][c] - knots[low][c])) / 255;
  }
  return colour;
}

double lightness(const Colour& colour) {
  // IEC 61966-2-1: sRGB to linear light, its luminance, then CIE L*.
  const auto linear = [](double s) {
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
  };
  const double Y =
      0.2126 * linear(colour[0]) + 0.7152 * linear(colour[1]) + 0.0722 * linear(colour[2]);
  return Y > 216.0 / 24389 ? 116 * std::cbrt(Y) - 16 : 24389.0 / 27 * Y;
}

}  // namespace bio::view
