#pragma once

#include <array>

namespace bio::view {

using Colour = std::array<double, 3>;  ///< red, green, blue, 0 … 1

/// The colour map viridis (S. van der Walt and N. Smith, 2015): lightness rises evenly, and readers
/// with a colour-vision deficiency see the same order. Linear between nine of its colours.
/// @param x 0 … 1; values outside take the end colours
Colour viridis(double x);

/// CIE 1976 lightness L* of an sRGB colour, 0 (black) … 100 (white).
double lightness(const Colour& colour);

}  // namespace bio::view
