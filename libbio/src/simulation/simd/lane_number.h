#pragma once

// Numbers of several simulations side by side as a type that muscle laws take (bio/muscle), with
// the functions by which their texts branch. In the unnamed namespace: what the laws' templates
// become with it is each file's own, so that none is shared between instruction sets.

#include "bio/muscle/number_type.h"
#include "simulation/simd/lane_numbers.h"

namespace bio::lanes {
namespace {

/// Whether something holds, lane by lane.
struct LaneMask {
  Mask v;
};
inline LaneMask operator!(const LaneMask& a) {
  return {~a.v};
}
inline LaneMask operator&&(const LaneMask& a, const LaneMask& b) {
  return {a.v & b.v};
}
inline LaneMask operator&&(bool a, const LaneMask& b) {
  return {a ? b.v : b.v ^ b.v};
}
inline LaneMask operator||(const LaneMask& a, const LaneMask& b) {
  return {a.v | b.v};
}

struct LaneNumber {
  Real v;

  LaneNumber() = default;
  LaneNumber(const Real& x) : v(x) {}
  LaneNumber(double x) : v(same(x)) {}

  friend LaneNumber operator-(const LaneNumber& a) { return -a.v; }
  friend LaneNumber operator+(const LaneNumber& a, const LaneNumber& b) { return a.v + b.v; }
  friend LaneNumber operator-(const LaneNumber& a, const LaneNumber& b) { return a.v - b.v; }
  friend LaneNumber operator*(const LaneNumber& a, const LaneNumber& b) { return a.v * b.v; }
  friend LaneNumber operator/(const LaneNumber& a, const LaneNumber& b) { return a.v / b.v; }
  LaneNumber& operator+=(const LaneNumber& b) { return *this = *this + b; }
  LaneNumber& operator-=(const LaneNumber& b) { return *this = *this - b; }
  friend LaneMask operator<(const LaneNumber& a, const LaneNumber& b) { return {a.v < b.v}; }
  friend LaneMask operator<=(const LaneNumber& a, const LaneNumber& b) { return {a.v <= b.v}; }
  friend LaneMask operator>(const LaneNumber& a, const LaneNumber& b) { return {a.v > b.v}; }
  friend LaneMask operator>=(const LaneNumber& a, const LaneNumber& b) { return {a.v >= b.v}; }

  friend LaneNumber sqrt(const LaneNumber& a) { return squareRoot(a.v); }
  friend LaneNumber exp(const LaneNumber& a) { return exponential(a.v); }
  friend LaneNumber log(const LaneNumber& a) { return logarithm(a.v); }
  friend LaneNumber sin(const LaneNumber& a) { return sineCosine(a.v).sine; }
  friend LaneNumber abs(const LaneNumber& a) { return absolute(a.v); }
  friend LaneNumber plainValue(const LaneNumber& a) { return a; }
};

/// Two numbers side by side: the Plane of Bézier sections.
struct LanePlane {
  LaneNumber x, y;
  const LaneNumber& operator[](int i) const { return i == 0 ? x : y; }

  friend LanePlane operator+(const LanePlane& a, const LanePlane& b) {
    return {a.x + b.x, a.y + b.y};
  }
  friend LanePlane operator*(const LaneNumber& a, const LanePlane& b) { return {a * b.x, a * b.y}; }
  friend LanePlane operator*(const LanePlane& a, const LaneNumber& b) { return {a.x * b, a.y * b}; }
  friend LanePlane operator/(const LaneNumber& a, const LanePlane& b) { return {a / b.x, a / b.y}; }
};

inline constexpr int allBits = (1 << width) - 1;

/// How many numbers what a branch gives consists of.
template <class S>
inline constexpr int numbersIn = sizeof(S) / sizeof(LaneNumber);

inline LaneNumber choose(const LaneMask& m, const LaneNumber& yes, const LaneNumber& no) {
  return choose(m.v, yes.v, no.v);
}
/// Number by number.
template <class S>
[[gnu::always_inline]] inline S choose(const LaneMask& m, const S& yes, const S& no) {
  constexpr int n = numbersIn<S>;
  static_assert(n >= 2 && n <= 6 && sizeof(S) == n * sizeof(LaneNumber));
  const auto of = [&](const LaneNumber& y, const LaneNumber& x) { return choose(m, y, x); };
  if constexpr (n == 2) {
    const auto& [a, b] = yes;
    const auto& [A, B] = no;
    return {of(a, A), of(b, B)};
  } else if constexpr (n == 3) {
    const auto& [a, b, c] = yes;
    const auto& [A, B, C] = no;
    return {of(a, A), of(b, B), of(c, C)};
  } else if constexpr (n == 4) {
    const auto& [a, b, c, d] = yes;
    const auto& [A, B, C, D] = no;
    return {of(a, A), of(b, B), of(c, C), of(d, D)};
  } else if constexpr (n == 5) {
    const auto& [a, b, c, d, e] = yes;
    const auto& [A, B, C, D, E] = no;
    return {of(a, A), of(b, B), of(c, C), of(d, D), of(e, E)};
  } else {
    const auto& [a, b, c, d, e, f] = yes;
    const auto& [A, B, C, D, E, F] = no;
    return {of(a, A), of(b, B), of(c, C), of(d, D), of(e, E), of(f, F)};
  }
}

/// Each side for all lanes if one needs it; what a lane gets never depends on the others.
template <class Yes, class No>
[[gnu::always_inline]] inline auto branch(const LaneMask& m, const Yes& yes, const No& no) {
  using S = decltype(yes());
  const int bits = bitsOf(m.v);
  S a, b;
  if (bits != 0) {
    a = yes();
    if (bits == allBits) return a;
  }
  b = no();
  if (bits == 0) return b;
  return S(choose(m, a, b));
}

inline bool everywhere(const LaneMask& m) {
  return all(m.v);
}

}  // namespace
}  // namespace bio::lanes
