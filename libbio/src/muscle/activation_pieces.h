#pragma once

// Steps of FirstOrderActivation that meet a limit or change between rising and falling; not public.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "bio/muscle/bracketed_root.h"
#include "bio/muscle/first_order_activation.h"

namespace bio::muscles::detail {

/// Points and weights of Gauss's rule with five points on 0 … 1.
inline constexpr std::array<double, 5> gaussPoint{0.046910077030668004, 0.23076534494715845, 0.5,
                                                  0.76923465505284155, 0.95308992296933199};
inline constexpr std::array<double, 5> gaussWeight{0.11846344252809454, 0.23931433524968324,
                                                   0.28444444444444444, 0.23931433524968324,
                                                   0.11846344252809454};

/// A stretch of a step on one branch of the law.
template <class T>
struct Piece {
  T activation;
  T duration;  ///< [s]
  enum class Ended { atEnd, crossing, limit } why = Ended::atEnd;
};

/// t(σ)/τ_a = Σ c_k σ^k while rising: from dt/dσ = τ_a z, z′ = 3/2 e and e′ = −e + μz follows
/// c_{k+3} = (−c_{k+2} + 3/2 μ c_{k+1}/(k+2))/(k+3). z is its first derivative, 3/2 e its second.
template <class T>
class RisingSeries {
 public:
  RisingSeries(const T& e, const T& z, const T& mu) {
    c_[0] = T(0.0);
    c_[1] = z;
    c_[2] = 0.75 * e;
    for (std::size_t k = 0; k + 3 < c_.size(); ++k) {
      const auto n = static_cast<double>(k);
      c_[k + 3] = (1.5 / (n + 2) * mu * c_[k + 1] - c_[k + 2]) * (1 / (n + 3));
    }
    reach_ = 1 / (1 + std::sqrt(1.5 * std::abs(plainValue(mu))));
  }
  /// The largest σ for which what is cut off is below 1e-14.
  double reach() const { return reach_; }

  template <class U>
  CurvePoint<T> at(const U& sigma) const {
    CurvePoint<T> p{T(0.0), T(0.0), T(0.0)};
    for (std::size_t k = c_.size(); k-- > 0;) {
      p.curvature = p.curvature * sigma + 2.0 * p.slope;
      p.slope = p.slope * sigma + p.value;
      p.value = p.value * sigma + c_[k];
    }
    return p;
  }

 private:
  std::array<T, 18> c_;
  double reach_;
};

/// The first place in 0 … end where f, positive at 0, is 0; `end` if it stays positive.
template <class F>
double firstZero(const F& f, double end) {
  const double first = f(0.0), last = f(end);
  if (!(first > 0)) return 0;
  if (last > 0) return end;
  return bracketedRoot(f, 0.0, first, end, last, 1e-15 * end);
}

/// A root that was found in plain numbers, after one step of Newton's method in the number type; as
/// it is where rounding alone makes that step long.
template <class T>
T polished(double root, const T& step, double whole) {
  if (!(std::abs(plainValue(step)) < 1e-6 * whole)) return T(root);
  return root - step;
}

template <class T>
Piece<T> rise(const FirstOrderActivation<T>& law, const T& u, const T& slope, const T& a,
              const T& rest) {
  using Ended = typename Piece<T>::Ended;
  const T mu = slope * law.activationTime;
  const T span = rest / law.activationTime;
  T e = u - a, z = 0.5 + 1.5 * a, passed(0.0);
  for (;;) {
    const RisingSeries<T> series(e, z, mu);
    const double reach = series.reach();
    const T left = span - passed;
    const RisingSeries<double> plain(plainValue(e), plainValue(z), plainValue(mu));
    // which comes first: the end of the step, u = a, or a = 1
    const double crossing = plainValue(mu) < 0
                                ? firstZero([&](double x) { return plain.at(x).curvature; }, reach)
                                : reach;
    const double limit = firstZero([&](double x) { return 2 - plain.at(x).slope; }, crossing);
    const double end =
        firstZero([&](double x) { return plainValue(left) - plain.at(x).value; }, limit);
    const CurvePoint<T> at = series.at(end);
    if (end < limit) {
      const CurvePoint<T> last = series.at(T(end - (at.value - left) / at.slope));
      return {T((last.slope - 0.5) * (2.0 / 3)), rest, Ended::atEnd};
    }
    if (limit < crossing) {
      const T sigma = limit - (at.slope - 2.0) / at.curvature;
      return {T(1.0), T((passed + series.at(sigma).value) * law.activationTime), Ended::limit};
    }
    if (crossing < reach) {
      const double bend = plainValue(mu) * plainValue(at.slope) * 1.5;  // of z′ at e = 0
      const T sigma = polished(crossing, T(at.curvature / bend), reach);
      const T time = (passed + series.at(sigma).value) * law.activationTime;
      return {T(u + slope * time), time, Ended::crossing};
    }
    passed += at.value;
    z = at.slope;
    e = at.curvature * (2.0 / 3);
  }
}

/// w = 1/z after a time while falling.
template <class T>
T fallenBy(const T& deactivationTime, const T& u, const T& slope, const T& w, const T& time) {
  using std::exp;
  const T span = time / deactivationTime;
  const T x = (0.5 + 1.5 * (u + 0.5 * slope * time)) * span;
  const T bend = 0.75 * slope * time * span;
  T sum(0.0);
  for (std::size_t i = 0; i < 5; ++i) {
    const double r = gaussPoint[i];
    sum += gaussWeight[i] * exp(T(-(r * x + r * (1 - r) * bend)));
  }
  return w * exp(T(-x)) + span * sum;
}

template <class T>
Piece<T> fall(const FirstOrderActivation<T>& law, const T& u0, const T& slope, const T& a0,
              const T& rest) {
  using Ended = typename Piece<T>::Ended;
  const double span = plainValue(rest) / plainValue(law.deactivationTime);
  const double change = plainValue(slope) * plainValue(rest);
  const double x = std::max(std::abs(0.5 + 1.5 * plainValue(u0)),
                            std::abs(0.5 + 1.5 * (plainValue(u0) + change))) *
                   span;
  const double count = std::ceil(std::max({x, std::abs(0.75 * change * span), 1.0}));
  const T stretch = rest / count;
  T u = u0, a = a0, passed(0.0);
  for (double k = 0; k < count; ++k) {
    const T w = 1.0 / (0.5 + 1.5 * a);
    const auto after = [&](const T& time) {
      return T((1.0 / fallenBy(law.deactivationTime, u, slope, w, time) - 0.5) * (2.0 / 3));
    };
    const double whole = plainValue(stretch);
    const auto plainAfter = [tau = plainValue(law.deactivationTime), at = plainValue(u),
                             way = plainValue(slope), from = plainValue(w)](double time) {
      return (1 / fallenBy(tau, at, way, from, time) - 0.5) * (2.0 / 3);
    };
    const auto above = [&](double time) {
      return plainAfter(time) - (plainValue(u) + plainValue(slope) * time);
    };
    const T end = after(stretch);
    const double least = plainValue(law.minimum);
    // u below a and not rising stays below; rounding may say otherwise
    const bool crosses =
        plainValue(slope) > 0 && plainValue(u) + plainValue(slope) * whole > plainValue(end);
    const double crossing = crosses ? firstZero(above, whole) : whole;
    if (plainAfter(crossing) < least) {
      const double t = firstZero([&](double time) { return plainAfter(time) - least; }, crossing);
      const T at = after(T(t));
      const T fallRate = (u + slope * t - at) * (0.5 + 1.5 * at) / law.deactivationTime;
      return {law.minimum, T(passed + (t - (at - law.minimum) / plainValue(fallRate))),
              Ended::limit};
    }
    if (crosses) {
      // ȧ = 0 there, so that u − a changes as u does
      const T lag = u + slope * crossing - after(T(crossing));
      const T time = polished(crossing, T(lag / plainValue(slope)), whole);
      return {T(u + slope * time), T(passed + time), Ended::crossing};
    }
    a = end;
    u = u + slope * stretch;
    passed = passed + stretch;
  }
  return {a, rest, Ended::atEnd};
}

/// A step in as many pieces as it needs.
template <class T>
T stepInPieces(const FirstOrderActivation<T>& law, const T& u0, const T& u1, const T& a0,
               const T& h) {
  using Ended = typename Piece<T>::Ended;
  const double least = plainValue(law.minimum);
  T a = plainValue(a0) < least ? law.minimum : plainValue(a0) > 1 ? T(1.0) : a0;
  if (!(plainValue(h) > 0)) return a0;
  if (!std::isfinite(plainValue(u0) + plainValue(u1) + plainValue(a0) + plainValue(h))) {
    return T(std::numeric_limits<double>::quiet_NaN());
  }
  const T slope = (u1 - u0) / h;
  const double way = plainValue(slope);
  T u = u0, rest = h;
  bool atLimit = plainValue(a) <= least || plainValue(a) >= 1;
  bool crossed = false;  // u = a but for rounding
  for (int k = 0; k < 8 && plainValue(rest) > 0; ++k) {
    const double e = crossed ? 0 : plainValue(u) - plainValue(a);
    crossed = false;
    const bool rises = e > 0 || (e == 0 && way > 0);
    if (e == 0 && way == 0) return a;
    // held at a limit until u comes back past it
    if (atLimit && (rises ? plainValue(a) >= 1 : plainValue(a) <= least)) {
      if (rises ? way >= 0 : way <= 0) return a;
      const T wait = (a - u) / slope;
      if (plainValue(wait) >= plainValue(rest)) return a;
      rest = rest - wait;
      u = u + slope * wait;
      crossed = true;
      continue;
    }
    const Piece<T> piece = rises ? rise(law, u, slope, a, rest) : fall(law, u, slope, a, rest);
    a = piece.activation;
    if (piece.why == Ended::atEnd) return a;
    rest = rest - piece.duration;
    u = u + slope * piece.duration;
    atLimit = piece.why == Ended::limit;
    crossed = piece.why == Ended::crossing;
  }
  return a;
}

}  // namespace bio::muscles::detail
