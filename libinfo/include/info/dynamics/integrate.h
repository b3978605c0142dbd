#pragma once

#include "info/dynamics/step_map.h"

namespace info {

/// The classical Runge–Kutta step of fourth order as an explicit step map.
///
///     x_{k+1} = x_k + Δt/6 (k₁ + 2k₂ + 2k₃ + k₄)
/// with u linear between u_k and u_{k+1}. Order 4 where f is four times differentiable;
/// conditionally stable. Source: Kutta 1901.
template <SmoothSystem S>
struct Rk4 {
  static constexpr int stateSize = S::stateSize, inputSize = S::inputSize,
                       parameterSize = S::parameterSize, outputSize = S::outputSize;
  S system;
  double timeStep;  ///< Δt [s] ≠ 0

  Dimensions dimensions() const { return dimensionsOf(system); }
  std::vector<std::string> parameterNames() const { return system.parameterNames(); }

  template <class T>
  Vector<T, stateSize> step(const Vector<T, stateSize>& x, const Vector<T, inputSize>& u0,
                            const Vector<T, inputSize>& u1,
                            const Vector<T, parameterSize>& theta) const {
    using State = Vector<T, stateSize>;
    const T h(timeStep), half(0.5 * timeStep), sixth(timeStep / 6.0), two(2.0);
    const Vector<T, inputSize> um = (u0 + u1) * T(0.5);
    const State k1 = system.f(x, u0, theta);
    const State k2 = system.f(State(x + k1 * half), um, theta);
    const State k3 = system.f(State(x + k2 * half), um, theta);
    const State k4 = system.f(State(x + k3 * h), u1, theta);
    return x + (k1 + k2 * two + k3 * two + k4) * sixth;
  }
  template <class T>
  Vector<T, outputSize> g(const Vector<T, stateSize>& x, const Vector<T, inputSize>& u,
                          const Vector<T, parameterSize>& theta) const {
    return system.g(x, u, theta);
  }
};

/// The implicit midpoint step as an implicit step map.
///
///     0 = x_{k+1} − x_k − Δt f((x_k + x_{k+1})/2, (u_k + u_{k+1})/2, θ)
/// Order 2, A-stable, symplectic on Hamiltonian systems.
template <SmoothSystem S>
struct ImplicitMidpoint {
  static constexpr int stateSize = S::stateSize, inputSize = S::inputSize,
                       parameterSize = S::parameterSize, outputSize = S::outputSize;
  S system;
  double timeStep;  ///< Δt [s] ≠ 0

  Dimensions dimensions() const { return dimensionsOf(system); }
  std::vector<std::string> parameterNames() const { return system.parameterNames(); }

  template <class T>
  Vector<T, stateSize> residual(const Vector<T, stateSize>& x1, const Vector<T, stateSize>& x,
                                const Vector<T, inputSize>& u0, const Vector<T, inputSize>& u1,
                                const Vector<T, parameterSize>& theta) const {
    const Vector<T, stateSize> xm = (x + x1) * T(0.5);
    const Vector<T, inputSize> um = (u0 + u1) * T(0.5);
    return x1 - x - system.f(xm, um, theta) * T(timeStep);
  }
  template <class T>
  Vector<T, outputSize> g(const Vector<T, stateSize>& x, const Vector<T, inputSize>& u,
                          const Vector<T, parameterSize>& theta) const {
    return system.g(x, u, theta);
  }
};

}  // namespace info
