#pragma once

// Numbers of several simulations side by side, one per lane, for the files of simd/ alone. All of
// it is compiled once per instruction set, so nothing here may be shared between files by the
// linker: hence the unnamed namespace. What a lane comes to never depends on the others.

#include "simulation/simd/lane_real.h"

namespace bio::lanes {

namespace {

// How many the file that includes this advances together.
#ifndef FISHERHILL_LANES
#define FISHERHILL_LANES 4
#endif
using Here = Lanes<FISHERHILL_LANES>;
using Real [[gnu::aligned(sizeof(Here::Number))]] = Here::Number;
using Mask [[gnu::aligned(sizeof(Here::Number))]] = Here::Mask;
inline constexpr int width = Here::width;
static_assert(width == 4 || width == 8);
static_assert(alignof(Real) == sizeof(Real) && alignof(Mask) == sizeof(Mask));

inline Real same(double x) {
  Real r;
  for (int l = 0; l < width; ++l) r[l] = x;
  return r;
}

/// Its lanes as bits.
inline int bitsOf(const Mask& m) {
#if FISHERHILL_LANES == 8 && defined __AVX512DQ__
  using Whole [[gnu::vector_size(64)]] = long long;
  return static_cast<unsigned char>(__builtin_ia32_cvtq2mask512(reinterpret_cast<Whole>(m)));
#elif FISHERHILL_LANES == 4 && defined __AVX__
  return __builtin_ia32_movmskpd256(reinterpret_cast<Real>(m));
#elif FISHERHILL_LANES == 4 && defined __SSE2__
  const Real r = reinterpret_cast<Real>(m);
  return __builtin_ia32_movmskpd(__builtin_shufflevector(r, r, 0, 1)) |
         __builtin_ia32_movmskpd(__builtin_shufflevector(r, r, 2, 3)) << 2;
#else
  int bits = 0;
  for (int l = 0; l < width; ++l) bits |= m[l] != 0 ? 1 << l : 0;
  return bits;
#endif
}
inline bool any(const Mask& m) {
  return bitsOf(m) != 0;
}
inline bool all(const Mask& m) {
  return bitsOf(m) == (1 << width) - 1;
}

inline Real choose(const Mask& m, const Real& yes, const Real& no) {
  return m ? yes : no;
}
inline Real absolute(const Real& x) {
  return choose(x < 0, -x, x);
}
inline Real larger(const Real& a, const Real& b) {
  return choose(a < b, b, a);
}

/// √x, rounded correctly.
inline Real squareRoot(const Real& x) {
  Real r;
  for (int l = 0; l < width; ++l) r[l] = __builtin_sqrt(x[l]);
  return r;
}

/// Σ c[k] z^k
template <int n>
inline Real polynomial(const double (&c)[n], const Real& z) {
  Real sum = same(c[n - 1]);
  for (int k = n - 2; k >= 0; --k) sum = sum * z + c[k];
  return sum;
}

struct SineCosine {
  Real sine, cosine;
};

/// Taylor's series about the nearest multiple of π/2; off by at most 2e-16 for |x| ≤ 1e5.
inline SineCosine sineCosine(const Real& x) {
  // 1.5·2⁵² behind whose point nothing fits: adding it rounds to a whole number, in its last bits
  constexpr double rounder = 6755399441055744.0;
  const Real shifted = x * 0.63661977236758134308 + rounder;
  const Real n = shifted - rounder;
  const Mask quadrant = reinterpret_cast<Mask>(shifted);
  // π/2 in two parts, the first with so few digits that its multiples are exact
  const Real r = (x - n * 1.5707963267341256) - n * 6.077100506506192e-11;
  const Real z = r * r;
  static constexpr double sines[] = {1,
                                     -1.0 / 6,
                                     1.0 / 120,
                                     -1.0 / 5040,
                                     1.0 / 362880,
                                     -1.0 / 39916800,
                                     1.0 / 6227020800,
                                     -1.0 / 1307674368000,
                                     1.0 / 355687428096000};
  static constexpr double cosines[] = {1,
                                       -1.0 / 2,
                                       1.0 / 24,
                                       -1.0 / 720,
                                       1.0 / 40320,
                                       -1.0 / 3628800,
                                       1.0 / 479001600,
                                       -1.0 / 87178291200,
                                       1.0 / 20922789888000};
  const Real s = r * polynomial(sines, z);
  const Real c = polynomial(cosines, z);
  const Mask odd = (quadrant & 1) != 0;
  const Real sine = choose(odd, c, s);
  const Real cosine = choose(odd, s, c);
  return {choose((quadrant & 2) != 0, -sine, sine),
          choose(((quadrant + 1) & 2) != 0, -cosine, cosine)};
}

/// eˣ for |x| ≤ 708, beyond that of the nearer end; off by at most 3e-16 of it. x = n ln 2 + r with
/// |r| ≤ ln 2/2, Taylor's series for eʳ.
inline Real exponential(const Real& x) {
  constexpr double rounder = 6755399441055744.0;  // see sineCosine
  const Real low = choose(x < -708, same(-708), x);
  const Real within = choose(low > 708, same(708), low);
  const Real shifted = within * 1.4426950408889634074 + rounder;
  const Real n = shifted - rounder;
  // ln 2 in two parts, the first with so few digits that its multiples are exact
  const Real r = (within - n * 0.693147180369123816490) - n * 1.90821492927058770002e-10;
  const Real z = r * r;
  static constexpr double evens[] = {1,           1.0 / 2,       1.0 / 24,       1.0 / 720,
                                     1.0 / 40320, 1.0 / 3628800, 1.0 / 479001600};
  static constexpr double odds[] = {
      1, 1.0 / 6, 1.0 / 120, 1.0 / 5040, 1.0 / 362880, 1.0 / 39916800, 1.0 / 6227020800};
  const Mask exponent = (reinterpret_cast<Mask>(shifted) + 1023) << 52;
  return (polynomial(evens, z) + r * polynomial(odds, z)) * reinterpret_cast<Real>(exponent);
}

/// ln x of normal numbers x > 0, NaN of infinity and NaN; off by at most 3e-16 of it, or of 1.
/// x = 2ⁿ m with m about 1, ln m = 2 artanh s by its series with s = (m − 1)/(m + 1).
inline Real logarithm(const Real& x) {
  constexpr double rounder = 6755399441055744.0;
  const Mask bits = reinterpret_cast<Mask>(x);
  const Mask exponent = ((bits >> 52) & 0x7ff) - 1023;
  // the exponent as a number: in the last bits of the rounder
  const Real n0 =
      reinterpret_cast<Real>(exponent + reinterpret_cast<Mask>(same(rounder))) - rounder;
  const Mask mask = reinterpret_cast<Mask>(same(1));
  const Real m0 = reinterpret_cast<Real>((bits & 0xfffffffffffff) | mask);
  const Mask large = m0 > 1.4142135623730951;
  const Real m = choose(large, m0 / 2, m0);
  const Real n = choose(large, n0 + 1, n0);
  const Real s = (m - 1) / (m + 1);
  static constexpr double series[] = {2,        2.0 / 3,  2.0 / 5,  2.0 / 7,  2.0 / 9, 2.0 / 11,
                                      2.0 / 13, 2.0 / 15, 2.0 / 17, 2.0 / 19, 2.0 / 21};
  const Real part = s * polynomial(series, s * s);
  const Real whole = n * 0.693147180369123816490 + (part + n * 1.90821492927058770002e-10);
  return whole + (x - x);
}

/// The angle in [0, 2π) whose sine and cosine are these up to a positive factor; off by at most
/// 2e-15. Brought to ±π/8, where arctan t = t·p(t²) with the polynomial through Chebyshev's points
/// (1.3e-18 of t).
inline Real angleOf(const Real& sine, const Real& cosine) {
  static constexpr double arctan[] = {
      1.0,
      -0.3333333333333312,
      0.19999999999940868,
      -0.14285714279248055,
      0.11111110744810647,
      -0.09090896805912162,
      0.07692045274291998,
      -0.06662951162727927,
      0.05846873503411509,
      -0.05035080589113427,
      0.03796469507021349,
      -0.01780477396050943,
  };
  constexpr double eighth = 0.41421356237309503;  // tan π/8
  constexpr double pi = 3.14159265358979323846;
  const Real a = absolute(sine);
  const Real b = absolute(cosine);
  const Mask steep = a > b;
  const Real low = choose(steep, b, a);
  const Real high = choose(steep, a, b);
  const Mask far = low > eighth * high;
  const Real t = choose(far, low - high, low) / choose(far, low + high, high);
  const Real part = choose(far, same(pi / 4), same(0)) + t * polynomial(arctan, t * t);
  const Real upright = choose(steep, pi / 2 - part, part);
  const Real above = choose(cosine < 0, pi - upright, upright);
  return choose(sine < 0, 2 * pi - above, above);
}

}  // namespace
}  // namespace bio::lanes
