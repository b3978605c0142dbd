#pragma once

#include <algorithm>
#include <cmath>

namespace bio::muscles {

/// A root of f between a and b, where f has the values fa and fb of different signs, to within
/// `tolerance`: Chandrupatla's method (1997), bisection or inverse quadratic interpolation where
/// three points say that it is safe. f may be infinite.
template <class F>
double bracketedRoot(const F& f, double a, double fa, double b, double fb, double tolerance) {
  double c = a, fc = fa, t = 0.5;
  for (int iteration = 0; iteration < 200; ++iteration) {
    const double x = a + t * (b - a);
    const double fx = f(x);
    if ((fx > 0) == (fa > 0)) {
      c = a, fc = fa;
    } else {
      c = b, b = a, fc = fb, fb = fa;
    }
    a = x, fa = fx;
    const double best = std::abs(fa) < std::abs(fb) ? a : b;
    const double width = std::abs(b - a);
    if (fa == 0 || width <= 2 * tolerance) return best;
    const double xi = (a - b) / (c - b);
    const double phi = (fa - fb) / (fc - fb);
    t = 0.5;
    if (phi * phi < xi && (1 - phi) * (1 - phi) < 1 - xi) {
      t = fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb);
    }
    const double margin = tolerance / width;
    t = std::clamp(t, margin, 1 - margin);
  }
  return std::abs(fa) < std::abs(fb) ? a : b;
}

}  // namespace bio::muscles
