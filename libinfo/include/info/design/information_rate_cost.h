#pragma once

#include "info/dynamics/extended_derivatives.h"

namespace info {

/// Running cost of a motion that is informative about θ and stays near a state:
///
///     l(x, ψ, u) = tr[(S Γᵀ Σ⁻¹ Γ S + ε 1)⁻¹] + (x − x̂)ᵀ Q (x − x̂),   Γ = D_xg ψ + D_θg
///
/// For one parameter the first term is 1/(Γ²/σ² + ε). S = diag(scale) makes parameters of different
/// units comparable: a change of θ_i by scale_i counts as 1. ε > 0 keeps the term finite if Γ is
/// not informative, such as at rest; there its gradient vanishes, so that without Q no motion would
/// begin. Smooth. Γ may depend on u (a load cell), and so may l.
///
/// Source: Wilson, Information-based Trajectory Optimization, (6.3). Differences: ε, without which
/// the printed cost is singular at rest, S, and the term of u.
template <SmoothSystem S>
struct InformationRateCost {
  static constexpr int n = S::stateSize, m = S::inputSize, p = S::parameterSize, l = S::outputSize;
  static_assert(n > 0 && m > 0 && p > 0 && l > 0, "fixed sizes, at least one of each");

  Matrix<double, l, l> inverseCovariance;               ///< Σ⁻¹ ≻ 0, per sample
  Vector<double, p> scale = Vector<double, p>::Ones();  ///< in the unit of each parameter, > 0
  double epsilon = 1e-2;                                ///< ε [1] > 0
  Matrix<double, n, n> stateWeight = Matrix<double, n, n>::Zero();  ///< Q ⪰ 0
  StateOf<S> desired = StateOf<S>::Zero();                          ///< x̂

  struct Gradient {
    StateOf<S> x;
    StateSensitivityOf<S> psi;
    InputOf<S> u;
  };

  double value(const S& system, const StateOf<S>& x, const StateSensitivityOf<S>& psi,
               const InputOf<S>& u, const ParametersOf<S>& theta) const;
  Gradient gradient(const S& system, const StateOf<S>& x, const StateSensitivityOf<S>& psi,
                    const InputOf<S>& u, const ParametersOf<S>& theta) const;

 private:
  Matrix<double, p, p> inverseRate(const Matrix<double, l, p>& gamma) const;
};

template <SmoothSystem S>
double InformationRateCost<S>::value(const S& system, const StateOf<S>& x,
                                     const StateSensitivityOf<S>& psi, const InputOf<S>& u,
                                     const ParametersOf<S>& theta) const {
  const StateOf<S> off = x - desired;
  return inverseRate(extendedOutput(system, x, psi, u, theta).along).trace() +
         off.dot(stateWeight * off);
}

template <SmoothSystem S>
typename InformationRateCost<S>::Gradient InformationRateCost<S>::gradient(
    const S& system, const StateOf<S>& x, const StateSensitivityOf<S>& psi, const InputOf<S>& u,
    const ParametersOf<S>& theta) const {
  // dl = −tr(M⁻¹ dM M⁻¹) = ⟨P, dΓ⟩,  P = −2 Σ⁻¹ Γ S M⁻² S
  const Matrix<double, l, p> gamma = extendedOutput(system, x, psi, u, theta).along;
  const Matrix<double, p, p> inverse = inverseRate(gamma);
  const Matrix<double, p, p> square = inverse * inverse;
  const Matrix<double, l, p> P =
      -2 * inverseCovariance * gamma * scale.asDiagonal() * square * scale.asDiagonal();
  const auto d = extendedOutputDerivatives(system, x, psi, u, theta);
  const Vector<double, n + m> along = d.dpsiw.transpose() * P.reshaped();
  return {along.template head<n>() + 2 * stateWeight * (x - desired),
          d.dw.template leftCols<n>().transpose() * P, along.template tail<m>()};
}

template <SmoothSystem S>
Matrix<double, InformationRateCost<S>::p, InformationRateCost<S>::p>
InformationRateCost<S>::inverseRate(const Matrix<double, l, p>& gamma) const {
  Matrix<double, p, p> M =
      scale.asDiagonal() * (gamma.transpose() * inverseCovariance * gamma) * scale.asDiagonal();
  M.diagonal().array() += epsilon;
  return M.inverse();
}

}  // namespace info
