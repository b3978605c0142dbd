#pragma once

namespace info {

/// What is believed of one number: a normal law or an even one, cut off at two bounds.
struct Marginal {
  enum class Shape {
    normal,  ///< density ∝ exp(−(x − mean)²/2 deviation²) within the bounds
    even     ///< constant on mean ± √3·deviation, as far as that lies within the bounds
  };
  Shape shape = Shape::normal;
  double mean = 0;
  double sd = 1;     ///< before cutting, > 0
  double lower = 0;  ///< ≤ mean
  double upper = 0;  ///< ≥ mean

  /// The value that a share u of the law lies below; rising in u, from a bound to the other one.
  /// With u even on (0, 1) it is a draw of the law.
  /// @param u share, 0 to 1
  /// @throws std::invalid_argument if the rules above are broken
  double quantile(double u) const;
};

/// Φ⁻¹(p): the standard normal law has the share p below it; −∞ at 0, ∞ at 1. Rational start
/// (Abramowitz & Stegun 26.2.23), then Halley's iteration on Φ: as exact as erfc.
/// @throws std::invalid_argument for p outside 0 to 1
double standardNormalQuantile(double p);

/// Φ(x): the share of the standard normal law below x; exact in relative terms for x ≤ 0.
double standardNormalShare(double x);

}  // namespace info
