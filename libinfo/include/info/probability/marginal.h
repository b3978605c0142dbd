#pragma once

namespace info {

/// Probability distribution of one quantity: normal or uniform, truncated at two bounds.
struct Marginal {
  enum class Shape {
    normal,  ///< density ∝ exp(−(x − mean)²/2 deviation²) within the bounds
    even     ///< constant on mean ± √3·deviation, within the bounds
  };
  Shape shape = Shape::normal;
  double mean = 0;
  double sd = 1;     ///< before truncation, > 0
  double lower = 0;  ///< ≤ mean
  double upper = 0;  ///< ≥ mean

  /// The quantile at the probability u; increasing in u, from one bound to the other. For u uniform
  /// on (0, 1) it is a sample of the distribution.
  /// @param u probability, 0 to 1
  /// @throws std::invalid_argument if a rule above is violated
  double quantile(double u) const;
};

/// Φ⁻¹(p), the quantile of the standard normal distribution; −∞ at 0, ∞ at 1. Rational initial
/// value (Abramowitz & Stegun 26.2.23), then Halley's iteration on Φ: as accurate as erfc.
/// @throws std::invalid_argument for p outside 0 to 1
double standardNormalQuantile(double p);

/// Φ(x), the standard normal distribution function; small relative error for x ≤ 0.
double standardNormalShare(double x);

}  // namespace info
