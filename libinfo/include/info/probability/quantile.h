#pragma once

#include <vector>

namespace info {

/// The sample quantile, linear between order statistics (definition 7 of Hyndman & Fan); values
/// that are not finite are ignored.
/// @param share probability, 0 to 1
/// @return NaN if no value is finite
double quantileOf(std::vector<double> values, double share);

}  // namespace info
