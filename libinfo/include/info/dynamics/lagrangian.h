#pragma once

#include "info/autodiff/derivatives.h"
#include "info/autodiff/recorded_function.h"
#include "info/dynamics/system.h"

namespace info {

/// The sizes of a mechanical system.
struct MechanicalDimensions {
  int coordinate;  ///< n, length of q
  int kinematic;   ///< length of ρ, the kinematic coordinates with prescribed motion
  int force;       ///< length of u, the inputs of the generalised force
  int parameter;   ///< p, length of θ
  int output;      ///< l, length of y
};

template <class S, class T = double>
using CoordinatesOf = Vector<T, S::coordinateSize>;
template <class S, class T = double>
using KinematicOf = Vector<T, S::kinematicSize>;
template <class S, class T = double>
using ForceInputOf = Vector<T, S::forceInputSize>;

/// A mechanical system by its Lagrangian L(q, q̇, ρ, ρ̇, θ) [J] and generalised force f(q, q̇, ρ,
/// ρ̇, u, θ) [N or N m], with outputs y = measure(q, ρ, θ); ρ are kinematic configuration variables
/// (Wilson's thesis, 2.4.2), prescribed instead of solved for.
///
/// Templates over one scalar T, pure as a System's functions; L three times differentiable if
/// second derivatives of a step are requested, ∂²L/∂q̇² regular. `dynamic` sizes come with
/// `MechanicalDimensions mechanicalDimensions() const`.
template <class S>
concept LagrangianSystem = requires(const S& s, const CoordinatesOf<S>& q,
                                    const KinematicOf<S>& rho, const ForceInputOf<S>& u,
                                    const ParametersOf<S>& theta) {
  { S::measurementSize } -> std::convertible_to<int>;
  { s.lagrangian(q, q, rho, rho, theta) } -> std::convertible_to<double>;
  { s.force(q, q, rho, rho, u, theta) } -> std::convertible_to<CoordinatesOf<S>>;
  { s.measure(q, rho, theta) } -> std::convertible_to<Vector<double, S::measurementSize>>;
  { s.parameterNames() } -> std::convertible_to<std::vector<std::string>>;
};

template <LagrangianSystem S>
MechanicalDimensions mechanicalDimensionsOf(const S& s) {
  if constexpr (requires { s.mechanicalDimensions(); }) {
    return s.mechanicalDimensions();
  } else {
    static_assert(S::coordinateSize >= 0 && S::kinematicSize >= 0 && S::forceInputSize >= 0 &&
                      S::parameterSize >= 0 && S::measurementSize >= 0,
                  "a dynamic size needs `MechanicalDimensions mechanicalDimensions() const`");
    return {S::coordinateSize, S::kinematicSize, S::forceInputSize, S::parameterSize,
            S::measurementSize};
  }
}

/// Momentum p = ∂L/∂q̇ of a motion, the initial value of an integrator.
template <LagrangianSystem S>
CoordinatesOf<S> momentum(const S& system, const CoordinatesOf<S>& q, const CoordinatesOf<S>& qDot,
                          const KinematicOf<S>& rho, const KinematicOf<S>& rhoDot,
                          const ParametersOf<S>& theta) {
  const auto kinetic = [&]<class T>(const CoordinatesOf<S, T>& v) {
    Vector<T, 1> L;
    L << system.lagrangian(
        CoordinatesOf<S, T>(q.template cast<T>()), v, KinematicOf<S, T>(rho.template cast<T>()),
        KinematicOf<S, T>(rhoDot.template cast<T>()), ParametersOf<S, T>(theta.template cast<T>()));
    return L;
  };
  return jacobian(kinetic, qDot).transpose();
}

/// Discretisation of the continuous force f over a step of length Δt.
enum class Forcing {
  left,       ///< F⁻ = Δt f, F⁺ = 0: that of Wilson's thesis; first order in Δt
  symmetric,  ///< F⁻ = F⁺ = ½ Δt f: second order at the same cost
};

}  // namespace info
