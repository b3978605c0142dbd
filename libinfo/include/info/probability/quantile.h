#pragma once

#include <vector>

namespace info {

/// The value that a share of the values lies below, linear between order statistics (the
/// definition 7 of Hyndman & Fan); values that are not finite do not count.
/// @param share 0 to 1
/// @return NaN if no value is finite
double quantileOf(std::vector<double> values, double share);

}  // namespace info
