#pragma once

#include <limits>

namespace info {

/// A sensor with normal noise, N(y, σ²), that clips at its limits.
struct ClippedSensor {
  double sd;                                                ///< σ [unit of y] > 0
  double lower = -std::numeric_limits<double>::infinity();  ///< smallest reading, < upper
  double upper = std::numeric_limits<double>::infinity();   ///< reads no more
};

/// −ln of the probability (density) of a reading, up to a constant, with its derivatives in y.
struct SampleCost {
  double value;
  double slope;      ///< d/dy
  double curvature;  ///< d²/dy², in [0, 1/σ²]
};

/// Cost of a prediction y given a reading: a reading within the limits is a measurement, one at a
/// limit is an inequality (Tobit):
///
///     ½ ((y − ỹ)/σ)²   lower < ỹ < upper
///     −ln Φ((y − upper)/σ)   ỹ ≥ upper,      −ln Φ((lower − y)/σ)   ỹ ≤ lower
/// Φ is the standard normal distribution. Convex and smooth in y; accurate far in the tails, where
/// it approaches the parabola ½ t².
///
/// Source: Tobin 1958.
/// @throws std::domain_error naming value and rule if σ, the limits or the reading break one
SampleCost sampleCost(const ClippedSensor& sensor, double reading, double predicted);

/// @throws std::domain_error as sampleCost
void checkSensor(const ClippedSensor& sensor);

/// −ln Φ(t) with its first two derivatives, for every finite t.
SampleCost minusLogNormal(double t);

}  // namespace info
