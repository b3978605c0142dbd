#pragma once

#include <cmath>
#include <span>

#include "info/dual.h"

namespace bio {

using info::plainValue;

/// First-order activation dynamics with one rate for rising and one for falling:
///
///     ȧ = (u − a)/τ_act  if u > a,   else (u − a)/τ_deact       (the equation after (3.1) in
///     Wilson's thesis)
///
/// Excitation u and activation a are dimensionless, 0…1. The rate is continuous; its slope jumps at
/// u = a.
template <class T>
struct FirstOrderActivation {
  T activationTime;    ///< τ_act [s] > 0
  T deactivationTime;  ///< τ_deact [s] > 0

  T rateConstant(const T&, bool rising) const {  ///< k in ȧ = k(u − a) [1/s]
    const T k = T(1.0) / (rising ? activationTime : deactivationTime);
    return k;
  }
};

/// Schutte's own activation dynamics, whose rate grows with the excitation while it rises:
///
///     t_s·ȧ = (u − a)(c₁u + c₂)  if u ≥ a,   else (u − a)c₂
///
/// with c₁ = activation1, c₂ = activation2 (7.667 and 1.459854 in the elbow model).
template <class T>
struct SchutteActivation {
  T timeScale;    ///< t_s [s] > 0
  T activation1;  ///< c₁ [1] ≥ 0
  T activation2;  ///< c₂ [1] > 0

  T rateConstant(const T& u, bool rising) const {  ///< k in ȧ = k(u − a) [1/s]
    if (!rising) {
      const T k = activation2 / timeScale;
      return k;
    }
    const T k = (activation1 * u + activation2) / timeScale;
    return k;
  }
};

/// ȧ [1/s] at excitation u and activation a.
template <class Dynamics, class T>
T activationRate(const Dynamics& dynamics, const T& u, const T& a) {
  const bool rising = plainValue(u) >= plainValue(a);
  const T rate = dynamics.rateConstant(u, rising) * (u - a);
  return rate;
}

/// Activation at the end of a step of length h [s] in which the excitation goes straight from u0 to
/// u1, from activation a0 at its start.
///
/// With k constant, e = u − a obeys ė = (u1 − u0)/h − k e, solved in closed form; a change between
/// rising and falling inside the step (there is at most one) is placed exactly and the step
/// continued from there with the other rate. FirstOrderActivation: exact. SchutteActivation: while
/// rising k = k̄ + k′(t − h/2) is linear in time, and
///     e(h) = e₀ E + u′[ (1 − E)/k̄ − (k′/2)(x − 2 + (x + 2)E)/k̄³ + O(h⁵) ],   x = k̄h,  E = exp(−x),
/// exact for constant u, fourth order in h otherwise. Stable for every h.
template <class Dynamics, class T>
T stepActivation(const Dynamics& dynamics, const T& u0, const T& u1, const T& a0, const T& h) {
  using std::exp;
  using std::log;
  if (!(plainValue(h) > 0)) return a0;
  const T slope = (u1 - u0) / h;  // of u
  const double e0 = plainValue(u0) - plainValue(a0);
  bool rising = e0 > 0 || (e0 == 0 && plainValue(slope) >= 0);
  T remaining = h;
  T uStart = u0;
  T e = u0 - a0;
  for (int part = 0; part < 2; ++part) {
    const T half = slope * remaining * T(0.5);
    const T k = dynamics.rateConstant(T(uStart + half), rising);
    const T steady = slope / k;  // e for t → ∞ if k stayed
    const T x = k * remaining;
    const T decay = exp(T(-x));
    T eEnd = steady + (e - steady) * decay;
    const T growth = (k - dynamics.rateConstant(uStart, rising)) * T(2.0);  // k′h
    if (plainValue(growth) != 0) {
      const T bracket = x - T(2.0) + (x + T(2.0)) * decay;
      eEnd = eEnd - steady * growth * bracket / (T(2.0) * k * x);
    }
    const bool crosses = rising ? plainValue(eEnd) < 0 : plainValue(eEnd) > 0;
    if (!crosses || part == 1) {
      e = eEnd;
      break;
    }
    // e = 0 at exp(−k t) = −steady/(e − steady)
    const T ratio = (steady - e) / steady;
    const T crossing = log(ratio) / k;
    uStart = uStart + slope * crossing;
    remaining = remaining - crossing;
    e = T(0.0);
    rising = !rising;
  }
  const T a1 = u1 - e;
  return a1;
}

/// stepActivation for many muscles with the same step: a[i] moves from excitation u0[i] to u1[i].
/// All spans have the same length.
template <class Dynamics>
void stepActivations(std::span<const Dynamics> dynamics, std::span<const double> u0,
                     std::span<const double> u1, double h, std::span<double> a) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    a[i] = stepActivation(dynamics[i], u0[i], u1[i], a[i], h);
  }
}

}  // namespace bio
