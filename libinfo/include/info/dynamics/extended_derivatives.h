#pragma once

#include "info/dynamics/sensitivity.h"

/// Values and derivatives of f and g along the sensitivities ψ = dx/dθ, in fixed sizes and without
/// allocation: the kernels of all methods that treat (x, ψ) as one state.
namespace info {

/// F(w, θ) and the total derivative dF/dθ = D_xF ψ + D_θF, the first n components of w being x(θ)
/// with dx/dθ = ψ.
template <int Rows, int P>
struct AlongSensitivity {
  Vector<double, Rows> value;
  Matrix<double, Rows, P> along;
};

/// First derivatives of both.
template <int Rows, int W, int P>
struct NestedDerivatives {
  Matrix<double, Rows, W> dw;         ///< ∂F/∂w
  Matrix<double, Rows * P, W> dpsiw;  ///< ∂vec(D_xF ψ + D_θF)/∂w at fixed ψ, column by column
};

namespace detail {

/// One sweep over p directions.
template <int N, int W, int P, class F>
auto alongPsi(const F& function, const Vector<double, W>& w, const Matrix<double, N, P>& psi,
              const Vector<double, P>& theta) {
  using T = Dual<P>;
  Vector<T, W> wT = w.template cast<T>();
  Vector<T, P> thetaT = theta.template cast<T>();
  for (Eigen::Index j = 0; j < P; ++j) {
    for (Eigen::Index i = 0; i < N; ++i) wT[i].derivatives()[j] = psi(i, j);
    thetaT[j].derivatives()[j] = 1.0;
  }
  const auto image = function(wT, thetaT).eval();
  constexpr int rows = std::decay_t<decltype(image)>::RowsAtCompileTime;
  AlongSensitivity<rows, P> out;
  for (Eigen::Index i = 0; i < rows; ++i) {
    out.value[i] = image[i].value();
    out.along.row(i) = image[i].derivatives().transpose();
  }
  return out;
}

/// One sweep over w directions with scalars that carry p directions.
template <int N, int W, int P, class F>
auto nestedDerivatives(const F& function, const Vector<double, W>& w,
                       const Matrix<double, N, P>& psi, const Vector<double, P>& theta) {
  static_assert(N >= 0 && W >= 0 && P > 0, "fixed sizes, at least one parameter");
  using Inner = Dual<P>;
  using Outer = Dual<W, Inner>;
  Vector<Outer, W> wT;
  Vector<Outer, P> thetaT;
  for (Eigen::Index i = 0; i < W; ++i) {
    Inner value(w[i]);
    if (i < N)
      for (Eigen::Index j = 0; j < P; ++j) value.derivatives()[j] = psi(i, j);
    wT[i].value() = value;
    for (Eigen::Index d = 0; d < W; ++d) wT[i].derivatives()[d] = Inner(d == i ? 1.0 : 0.0);
  }
  for (Eigen::Index j = 0; j < P; ++j) {
    Inner value(theta[j]);
    value.derivatives()[j] = 1.0;
    thetaT[j].value() = value;
    for (Eigen::Index d = 0; d < W; ++d) thetaT[j].derivatives()[d] = Inner(0.0);
  }
  const auto image = function(wT, thetaT).eval();
  constexpr int rows = std::decay_t<decltype(image)>::RowsAtCompileTime;
  NestedDerivatives<rows, W, P> out;
  for (Eigen::Index i = 0; i < rows; ++i)
    for (Eigen::Index d = 0; d < W; ++d) {
      const Inner& slope = image[i].derivatives()[d];
      out.dw(i, d) = slope.value();
      for (Eigen::Index j = 0; j < P; ++j) out.dpsiw(j * rows + i, d) = slope.derivatives()[j];
    }
  return out;
}

/// f and g as functions of w = (x, u) and θ.
template <class S>
auto rateOf(const S& system) {
  return [&system](const auto& at, const auto& parameters) {
    using T = typename std::decay_t<decltype(at)>::Scalar;
    return StateOf<S, T>(system.f(StateOf<S, T>(at.template head<S::stateSize>()),
                                  InputOf<S, T>(at.template tail<S::inputSize>()), parameters));
  };
}
template <class S>
auto outputOf(const S& system) {
  return [&system](const auto& at, const auto& parameters) {
    using T = typename std::decay_t<decltype(at)>::Scalar;
    return OutputOf<S, T>(system.g(StateOf<S, T>(at.template head<S::stateSize>()),
                                   InputOf<S, T>(at.template tail<S::inputSize>()), parameters));
  };
}
template <class S>
Vector<double, S::stateSize + S::inputSize> stateAndInput(const StateOf<S>& x,
                                                          const InputOf<S>& u) {
  Vector<double, S::stateSize + S::inputSize> at;
  at << x, u;
  return at;
}

}  // namespace detail

/// ẋ = f and ψ̇ = D_xf ψ + D_θf   (2.7).
template <SmoothSystem S>
auto extendedRate(const S& system, const StateOf<S>& x, const StateSensitivityOf<S>& psi,
                  const InputOf<S>& u, const ParametersOf<S>& theta) {
  return detail::alongPsi<S::stateSize, S::stateSize + S::inputSize, S::parameterSize>(
      detail::rateOf(system), detail::stateAndInput<S>(x, u), psi, theta);
}

/// ∂f/∂(x, u) and ∂vec ψ̇/∂(x, u).
template <SmoothSystem S>
auto extendedRateDerivatives(const S& system, const StateOf<S>& x, const StateSensitivityOf<S>& psi,
                             const InputOf<S>& u, const ParametersOf<S>& theta) {
  return detail::nestedDerivatives<S::stateSize, S::stateSize + S::inputSize, S::parameterSize>(
      detail::rateOf(system), detail::stateAndInput<S>(x, u), psi, theta);
}

/// y = g and Γ = D_xg ψ + D_θg   (2.6).
template <Observed S>
auto extendedOutput(const S& system, const StateOf<S>& x, const StateSensitivityOf<S>& psi,
                    const InputOf<S>& u, const ParametersOf<S>& theta) {
  return detail::alongPsi<S::stateSize, S::stateSize + S::inputSize, S::parameterSize>(
      detail::outputOf(system), detail::stateAndInput<S>(x, u), psi, theta);
}

/// ∂g/∂(x, u) and ∂vec Γ/∂(x, u).
template <Observed S>
auto extendedOutputDerivatives(const S& system, const StateOf<S>& x,
                               const StateSensitivityOf<S>& psi, const InputOf<S>& u,
                               const ParametersOf<S>& theta) {
  return detail::nestedDerivatives<S::stateSize, S::stateSize + S::inputSize, S::parameterSize>(
      detail::outputOf(system), detail::stateAndInput<S>(x, u), psi, theta);
}

}  // namespace info
