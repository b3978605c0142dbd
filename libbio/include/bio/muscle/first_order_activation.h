#pragma once

#include <cmath>

#include "bio/muscle/activation_law.h"
#include "bio/muscle/number_type.h"

namespace bio::muscles {

/// Activation dynamics of Thelen's and Millard's muscles (OpenSim 4.6,
/// MuscleFirstOrderActivationDynamicModel), z = ½ + 3/2 a:
///
///     ȧ = (u − a)/(τ_a z)   for u > a,      ȧ = (u − a) z/τ_d   else,      a_min ≤ a ≤ 1
///
/// A step in which u goes straight is solved, not approximated:
/// - Rising, in the time σ with dt = τ_a z dσ, the lag e = u − a and z obey the linear equations
///       e′ = −e + μz,   z′ = 3/2 e,      μ = u̇ τ_a
///   whose solution is in exponentials; σ is where t(σ) = h.
/// - Falling, w = 1/z obeys ẇ = 1/τ_d − w (½ + 3/2 u)/τ_d, linear with a rate linear in time:
///       w(h) = w₀ exp(−∫₀ʰ k) + (1/τ_d) ∫₀ʰ exp(−∫ₛʰ k) ds,
///   the integral by Gauss's rule with five points over stretches so short that it errs by less
///   than 1e-10.
/// A change between rising and falling within a step is placed where u = a.
///
/// Departure from OpenSim: activation stops at a_min (and at 1). OpenSim stops its effect there,
/// but lets the state drift on without end, which delays the next rise. A start outside the limits
/// counts as the nearer one.
template <class T = double>
struct FirstOrderActivation {
  T activationTime = T(0.010);    ///< τ_a [s] > 0
  T deactivationTime = T(0.040);  ///< τ_d [s] > 0
  T minimum = T(0.01);            ///< a_min [1], 0 ≤ a_min < 1

  static constexpr std::array<std::string_view, 3> names{
      "activation_time_constant", "deactivation_time_constant", "minimum_activation"};

  /// ȧ [1/s]; 0 where a limit holds the activation.
  T rate(const T& u, const T& a) const {
    const bool falls = plainValue(u) <= plainValue(a);
    if (falls ? plainValue(a) <= plainValue(minimum) : plainValue(a) >= 1) return T(0.0);
    const T z = 0.5 + 1.5 * a;
    return falls ? T((u - a) * z / deactivationTime) : T((u - a) / (activationTime * z));
  }

  /// a after a step; a₀ for h ≤ 0. Any h.
  T step(const T& u0, const T& u1, const T& a0, const T& h) const;

  /// By hand where u stays above or below a and no limit is met, else through dual numbers.
  ActivationStep<3> stepWithDerivatives(double u0, double u1, double a0, double h) const;
};

template <>
double FirstOrderActivation<double>::step(const double& u0, const double& u1, const double& a0,
                                          const double& h) const;
template <>
ActivationStep<3> FirstOrderActivation<double>::stepWithDerivatives(double u0, double u1, double a0,
                                                                    double h) const;
static_assert(ActivationLaw<FirstOrderActivation<double>>);

}  // namespace bio::muscles
