#pragma once

#include <Eigen/Core>
#include <cmath>
#include <span>

#include "info/autodiff/dual.h"

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

namespace detail {

/// e = u − a after a time h, from e0 at excitation uStart that changes by `slope`, on one branch.
template <class Dynamics, class T>
T lagAfter(const Dynamics& dynamics, const T& slope, const T& uStart, const T& e0, const T& h,
           bool rising) {
  using std::exp;
  const T k = dynamics.rateConstant(T(uStart + slope * h * T(0.5)), rising);
  const T steady = slope / k;  // e for t → ∞ if k stayed
  const T x = k * h;
  const T decay = exp(T(-x));
  const T growth = (k - dynamics.rateConstant(uStart, rising)) * T(2.0);  // k′h
  const T e1 = steady + (e0 - steady) * decay;
  if (plainValue(growth) == 0 || plainValue(x) == 0) return e1;
  const T bracket = x - T(2.0) + (x + T(2.0)) * decay;
  const T corrected = e1 - steady * growth * bracket / (T(2.0) * k * x);
  return corrected;
}

}  // namespace detail

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
  using std::log;
  if (!(plainValue(h) > 0)) return a0;
  const T slope = (u1 - u0) / h;  // of u
  T e = u0 - a0;
  const bool rising = plainValue(e) > 0 || (plainValue(e) == 0 && plainValue(slope) >= 0);
  const T atEnd = detail::lagAfter(dynamics, slope, u0, e, h, rising);
  if (rising ? plainValue(atEnd) >= 0 : plainValue(atEnd) <= 0) {
    const T a1 = u1 - atEnd;
    return a1;
  }
  // e = 0 at exp(−k t) = −steady/(e − steady) for a constant k; Newton, with ė = u′ at e = 0
  const T k = dynamics.rateConstant(T((u0 + u1) * T(0.5)), rising);
  const T steady = slope / k;
  const T ratio = (steady - e) / steady;
  T crossing = log(ratio) / k;
  for (int iteration = 0; iteration < 3; ++iteration) {
    crossing = crossing - detail::lagAfter(dynamics, slope, u0, e, crossing, rising) / slope;
  }
  const T uCrossing = u0 + slope * crossing;
  const T rest = h - crossing;
  const T a1 = u1 - detail::lagAfter(dynamics, slope, uCrossing, T(0.0), rest, !rising);
  return a1;
}

/// stepActivation of Schutte's dynamics and its derivatives.
struct ActivationStep {
  double value;                   ///< a₁
  Eigen::Matrix<double, 7, 1> d;  ///< in u₀, u₁, a₀, h, t_s, c₁ and c₂, in this order
};
/// Written out if the excitation stays above or below the activation, else computed by automatic
/// differentiation.
ActivationStep stepActivationWithDerivatives(const SchutteActivation<double>& dynamics, double u0,
                                             double u1, double a0, double h);

}  // namespace bio
