#pragma once

#include <cmath>

#include "bio/muscle/activation_law.h"
#include "bio/muscle/number_type.h"

namespace bio::muscles {

/// Activation dynamics of De Groote's muscle (De Groote et al. 2016; OpenSim 4.6,
/// DeGrooteFregly2016Muscle), z = ½ + 3/2 a:
///
///     ȧ = [ (½ + f)/(τ_a z) + (½ − f) z/τ_d ] (u − a),   f = ½ tanh(b(u − a))
///
/// smooth; with b = 0.1, OpenSim's default, both time constants act always. A step is Gauss's
/// method with three stages (implicit, order 6) over stretches of at most the shorter time
/// constant, over 1 + b/5, its stages solved by Newton's method to rounding; the derivatives are
/// those of that step. In steps of 10 ms it errs by less than 1e-8 where u − a stays below 0.1, by
/// 1e-5 where u jumps.
///
/// Departure from OpenSim: there the first muscle evaluated in a process lends its time constants
/// and smoothing to all others of the process.
template <class T = double>
struct SmoothActivation {
  T activationTime = T(0.015);    ///< τ_a [s] > 0
  T deactivationTime = T(0.060);  ///< τ_d [s] > 0
  T smoothing = T(0.1);           ///< b [1] > 0

  static constexpr std::array<std::string_view, 3> names{
      "activation_time_constant", "deactivation_time_constant", "activation_dynamics_smoothing"};

  /// ȧ [1/s]
  T rate(const T& u, const T& a) const {
    using std::tanh;
    const T z = 0.5 + 1.5 * a;
    const T f = 0.5 * tanh(T(smoothing * (u - a)));
    return ((0.5 + f) / (activationTime * z) + (0.5 - f) * z / deactivationTime) * (u - a);
  }

  /// a after a step; a₀ for h ≤ 0. Any h.
  double step(double u0, double u1, double a0, double h) const;
  ActivationStep<3> stepWithDerivatives(double u0, double u1, double a0, double h) const;
};

template <>
double SmoothActivation<double>::step(double u0, double u1, double a0, double h) const;
template <>
ActivationStep<3> SmoothActivation<double>::stepWithDerivatives(double u0, double u1, double a0,
                                                                double h) const;
static_assert(ActivationLaw<SmoothActivation<double>>);

}  // namespace bio::muscles
