#pragma once

#include "bio/muscle/bezier_curve.h"

namespace bio::muscles {

/// The four curves of Millard's muscle (Millard, Uchida, Seth, Delp 2013; OpenSim 4.6,
/// SmoothSegmentedFunctionFactory) as functions of their numbers, which may be dual numbers.
/// Curviness is the file's, 0 … 1; a corner gets c = 0.1 + 0.8·curviness.
/// @throws std::invalid_argument for numbers with which a section turns back

/// f_l over ℓ/ℓ0: from `minimum` at x₀ by the shallow slope s past x₁ to 1 at ℓ0, and back to
/// `minimum` at x₃; `minimum` outside. Needs 0 ≤ x₀ < x₁ < 1 < x₃, 0 ≤ s < (1 − minimum)/(1 − x₁).
template <class T>
BezierShape<T, 5> millardActiveForce(const T& x0, const T& x1, const T& x3, const T& s,
                                     const T& minimum) {
  const double delta = 0.05;
  const T c = T(0.9);
  const T zero = T(0.0), one = T(1.0), half = T(0.5);
  const double x_s = 1 - delta;
  const T y1 = 1.0 - s * (x_s - x1);
  const T s01 = 1.25 * y1 / (x1 - x0);
  const T x01 = 0.5 * (x0 + x1), y01 = 0.5 * y1;
  const T x1s = 0.5 * (x1 + x_s), y1s = 0.5 * (y1 + 1.0);
  const T x23 = 0.5 * (1.0 + delta + x3);
  const T s23 = -1.0 / ((x3 - delta) - (1.0 + delta));
  return {
      {{bezierCorner(x0, minimum, zero, x01, y01, s01, c),
        bezierCorner(x01, y01, s01, x1s, y1s, s, c), bezierCorner(x1s, y1s, s, one, one, zero, c),
        bezierCorner(one, one, zero, x23, half, s23, c),
        bezierCorner(x23, half, s23, x3, minimum, zero, c)}},
      zero,
      zero};
}

/// f_PE over ℓ/ℓ0: 0 up to 1 + e₀, 1 with slope k_iso at 1 + e₁ and on from there.
/// Needs k_iso > 1/(e₁ − e₀) > k_low > 0.
template <class T>
BezierShape<T, 2> millardPassiveForce(const T& e0, const T& e1, const T& k_low, const T& k_iso,
                                      const T& curviness) {
  const T zero = T(0.0), one = T(1.0);
  const T c = 0.1 + 0.8 * curviness;
  const T x_z = 1.0 + e0, x_i = 1.0 + e1;
  const T byStiffness = 0.1 / k_iso, byWidth = 0.1 * (x_i - x_z);
  const T delta = plainValue(byStiffness) < plainValue(byWidth) ? byStiffness : byWidth;
  const T x_l = x_z + delta, y_l = 0.5 * k_low * delta;
  return {{{bezierCorner(x_z, zero, zero, x_l, y_l, k_low, c),
            bezierCorner(x_l, y_l, k_low, x_i, one, k_iso, c)}},
          zero,
          k_iso};
}

/// f_T over ℓ_T/ℓs: 0 up to 1, f_toe with slope k_iso where the toe ends, on from there through 1
/// at 1 + e. Needs k_iso > 1/e, 0 < f_toe < 1.
template <class T>
BezierShape<T, 2> millardTendonForce(const T& e, const T& k_iso, const T& f_toe,
                                     const T& curviness) {
  const T zero = T(0.0), one = T(1.0);
  const T c = 0.1 + 0.8 * curviness;
  const T x_i = 1.0 + e;
  const T x_t = x_i + (f_toe - 1.0) / k_iso;
  const T x_f = 1.0 + 0.1 * (x_t - 1.0);
  const T y_m = 0.5 * f_toe, x_m = x_i + (y_m - 1.0) / k_iso;
  const T s_m = y_m / (x_m - x_f);
  const T x_k = 0.5 * (x_f + x_m), y_k = s_m * (x_k - x_f);
  return {{{bezierCorner(one, zero, zero, x_k, y_k, s_m, c),
            bezierCorner(x_k, y_k, s_m, x_t, f_toe, k_iso, c)}},
          zero,
          k_iso};
}

/// f_v over ℓ̇/(V ℓ0): 0 at −1, 1 at 0, f_max at 1; C, C_n, I, E_n, E: its slopes at −1, near −1, at
/// 0, near 1 and at 1. Needs 0 ≤ C < C_n ≤ 1 < I, f_max > 1, 0 ≤ E ≤ E_n < f_max − 1.
template <class T>
BezierShape<T, 4> millardForceVelocity(const T& C, const T& C_n, const T& I, const T& E,
                                       const T& E_n, const T& f_max, const T& concentric,
                                       const T& eccentric) {
  const T zero = T(0.0), one = T(1.0), x_n = T(-0.9), x_m = T(0.9);
  const T c = 0.1 + 0.8 * concentric, d = 0.1 + 0.8 * eccentric;
  const T y_n = 0.05 * (C_n + C), y_m = f_max - 0.05 * (E_n + E);
  return {
      {{bezierCorner(T(-1.0), zero, C, x_n, y_n, C_n, c),
        bezierCorner(x_n, y_n, C_n, zero, one, I, c), bezierCorner(zero, one, I, x_m, y_m, E_n, d),
        bezierCorner(x_m, y_m, E_n, one, f_max, E, d)}},
      C,
      E};
}

}  // namespace bio::muscles
