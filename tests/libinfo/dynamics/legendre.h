#pragma once

#include "info/dynamics/lagrangian.h"

namespace info {

/// Velocity q̇ and energy E = pᵀq̇ − L [J] of a momentum.
template <int N>
struct Legendre {
  Vector<double, N> qDot;
  double energy;
};

/// The velocity that belongs to a momentum, for a Lagrangian that is quadratic in q̇: q̇ =
/// (∂²L/∂q̇²)⁻¹ (p − p₀) with p₀ = ∂L/∂q̇ at q̇ = 0.
template <LagrangianSystem S>
Legendre<S::coordinateSize> legendre(const S& system, const CoordinatesOf<S>& q,
                                     const CoordinatesOf<S>& p, const KinematicOf<S>& rho,
                                     const KinematicOf<S>& rhoDot, const ParametersOf<S>& theta) {
  const auto map = [&]<class T>(const CoordinatesOf<S, T>& v) {
    Vector<T, 1> L;
    L << system.lagrangian(
        CoordinatesOf<S, T>(q.template cast<T>()), v, KinematicOf<S, T>(rho.template cast<T>()),
        KinematicOf<S, T>(rhoDot.template cast<T>()), ParametersOf<S, T>(theta.template cast<T>()));
    return L;
  };
  const CoordinatesOf<S> rest = CoordinatesOf<S>::Zero(q.size());
  const CoordinatesOf<S> p0 = momentum(system, q, rest, rho, rhoDot, theta);
  const auto mass = contractedHessian(map, rest, Vector<double, 1>(1.0));
  Legendre<S::coordinateSize> out;
  out.qDot = mass.ldlt().solve(p - p0);
  out.energy = p.dot(out.qDot) - system.lagrangian(q, out.qDot, rho, rhoDot, theta);
  return out;
}

}  // namespace info
