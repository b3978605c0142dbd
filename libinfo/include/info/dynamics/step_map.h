#pragma once

#include <cmath>
#include <limits>

#include "info/autodiff/derivatives.h"
#include "info/dynamics/system.h"

namespace info {

/// x_{k+1} of a step, and whether it converged; non-convergence is a result, not an exception.
template <int N>
struct Step {
  Vector<double, N> x1;       ///< x_{k+1}; the last iterate if not converged
  bool converged = true;      ///< false: do not use x1
  int iterations = 0;         ///< Newton iterations, 0 for explicit maps
  double residualNorm = 0.0;  ///< largest |r_i| at the last evaluation
};

/// First derivatives of x_{k+1} = Φ(x_k, u_k, u_{k+1}, θ).
template <int N, int M, int P>
struct StepLinearisation {
  Step<N> solution;
  Matrix<double, N, N> dx;      ///< A_k = ∂Φ/∂x_k
  Matrix<double, N, M> du0;     ///< ∂Φ/∂u_k
  Matrix<double, N, M> du1;     ///< ∂Φ/∂u_{k+1}
  Matrix<double, N, P> dtheta;  ///< ∂Φ/∂θ
};

template <class M>
using StepLinearisationOf = StepLinearisation<M::stateSize, M::inputSize, M::parameterSize>;

/// a + b of two sizes, `dynamic` if either is.
constexpr int addSizes(int a, int b) {
  return a == dynamic || b == dynamic ? dynamic : a + b;
}

/// Length of z = (x_k, u_k, u_{k+1}, θ), the argument of Φ as one vector.
template <class M>
inline constexpr int argumentSize = addSizes(addSizes(M::stateSize, M::parameterSize),
                                             addSizes(M::inputSize, M::inputSize));

/// z = (x_k, u_k, u_{k+1}, θ).
template <class M>
Vector<double, argumentSize<M>> packArgument(const StateOf<M>& x, const InputOf<M>& u0,
                                             const InputOf<M>& u1, const ParametersOf<M>& theta) {
  Vector<double, argumentSize<M>> z(x.size() + u0.size() + u1.size() + theta.size());
  z << x, u0, u1, theta;
  return z;
}

/// Stopping rule of the Newton iteration of an implicit step.
struct NewtonOptions {
  /// Largest |δ_i|/(1 + |x_i|) of the last update; convergence is quadratic, so the remaining error
  /// is about its square, below rounding.
  double tolerance = 1e-8;
  int maxIterations = 25;
};

namespace detail {

/// Calls function(x, u0, u1, θ) on the pieces of a packed argument of any scalar.
template <class M, class T, class F>
auto withPieces(const M& map, const Vector<T, argumentSize<M>>& z, const F& function) {
  const Dimensions d = dimensionsOf(map);
  constexpr int n = M::stateSize, m = M::inputSize, p = M::parameterSize;
  return function(StateOf<M, T>(z.template head<n>(d.state)),
                  InputOf<M, T>(z.template segment<m>(d.state, d.input)),
                  InputOf<M, T>(z.template segment<m>(d.state + d.input, d.input)),
                  ParametersOf<M, T>(z.template segment<p>(d.state + 2 * d.input, d.parameter)));
}

template <class M>
auto stepOfArgument(const M& map) {
  return [&map]<class T>(const Vector<T, argumentSize<M>>& z) {
    return withPieces<M, T>(
        map, z,
        [&](const auto& x, const auto& u0, const auto& u1, const auto& theta) -> StateOf<M, T> {
          return map.step(x, u0, u1, theta);
        });
  };
}

/// r(x1, z) as a function of the one vector (x1, z).
template <class M>
auto residualOfArgument(const M& map) {
  constexpr int size = addSizes(M::stateSize, argumentSize<M>);
  return [&map]<class T>(const Vector<T, size>& y) {
    const Eigen::Index n = dimensionsOf(map).state;
    const StateOf<M, T> x1 = y.template head<M::stateSize>(n);
    return withPieces<M, T>(
        map, Vector<T, argumentSize<M>>(y.template segment<argumentSize<M>>(n, y.size() - n)),
        [&](const auto& x, const auto& u0, const auto& u1, const auto& theta) -> StateOf<M, T> {
          return map.residual(x1, x, u0, u1, theta);
        });
  };
}

template <class M>
auto residualJacobian(const M& map, const StateOf<M>& x1, const StateOf<M>& x, const InputOf<M>& u0,
                      const InputOf<M>& u1, const ParametersOf<M>& theta) {
  constexpr int size = addSizes(M::stateSize, argumentSize<M>);
  const auto z = packArgument<M>(x, u0, u1, theta);
  Vector<double, size> y(x1.size() + z.size());
  y << x1, z;
  return std::pair{y, jacobian(residualOfArgument(map), y)};
}

}  // namespace detail

/// x_{k+1} = Φ(x_k, u_k, u_{k+1}, θ) of any kind of step map.
///
/// An implicit map is solved by Newton's method from x_{k+1} ≈ x_k with the exact Jacobian.
/// @throws DimensionError if a run-time size is wrong
template <StepMap M>
Step<M::stateSize> solve(const M& map, const StateOf<M>& x, const InputOf<M>& u0,
                         const InputOf<M>& u1, const ParametersOf<M>& theta,
                         const NewtonOptions& options = {}) {
  requireSizes(map, x, u0, theta);
  if constexpr (DifferentiatedStepMap<M>) {
    return map.solve(x, u0, u1, theta);
  } else if constexpr (ExplicitStepMap<M>) {
    return {map.step(x, u0, u1, theta)};
  } else {
    Step<M::stateSize> out{x, false};
    const auto residual = [&]<class T>(const StateOf<M, T>& x1) -> StateOf<M, T> {
      return map.residual(
          x1, StateOf<M, T>(x.template cast<T>()), InputOf<M, T>(u0.template cast<T>()),
          InputOf<M, T>(u1.template cast<T>()), ParametersOf<M, T>(theta.template cast<T>()));
    };
    for (out.iterations = 1; out.iterations <= options.maxIterations; ++out.iterations) {
      const auto at = differentiate(residual, out.x1);
      const StateOf<M> delta = at.jacobian.partialPivLu().solve(-at.value);
      out.x1 += delta;
      out.residualNorm = at.value.size() ? at.value.cwiseAbs().maxCoeff() : 0.0;
      const double scaled = (delta.array().abs() / (1.0 + out.x1.array().abs())).sum();
      if (!std::isfinite(scaled)) return out;
      if (scaled <= options.tolerance) {
        out.converged = true;
        return out;
      }
    }
    --out.iterations;
    return out;
  }
}

/// The step and its exact first derivatives; for an implicit map by the implicit function theorem,
///     ∂x_{k+1}/∂z = −(∂r/∂x_{k+1})⁻¹ ∂r/∂z.
/// If the step fails, `solution.converged` is false and the derivatives are meaningless.
template <StepMap M>
StepLinearisationOf<M> linearise(const M& map, const StateOf<M>& x, const InputOf<M>& u0,
                                 const InputOf<M>& u1, const ParametersOf<M>& theta) {
  if constexpr (DifferentiatedStepMap<M>) {
    return map.linearise(x, u0, u1, theta);
  } else {
    const Eigen::Index n = x.size(), m = u0.size();
    Step<M::stateSize> solution;
    Matrix<double, M::stateSize, argumentSize<M>> dz(n, n + 2 * m + theta.size());
    if constexpr (ExplicitStepMap<M>) {
      requireSizes(map, x, u0, theta);
      const auto at = differentiate(detail::stepOfArgument(map), packArgument<M>(x, u0, u1, theta));
      solution.x1 = at.value;
      dz = at.jacobian;
    } else {
      solution = info::solve(map, x, u0, u1, theta);
      const auto [y, dr] = detail::residualJacobian(map, solution.x1, x, u0, u1, theta);
      const Matrix<double, M::stateSize, M::stateSize> dr_dx1 =
          dr.template leftCols<M::stateSize>(n);
      dz = -dr_dx1.partialPivLu().solve(dr.template rightCols<argumentSize<M>>(dr.cols() - n));
    }
    return {solution, dz.template leftCols<M::stateSize>(n),
            dz.template middleCols<M::inputSize>(n, m),
            dz.template middleCols<M::inputSize>(n + m, m),
            dz.template rightCols<M::parameterSize>(theta.size())};
  }
}

/// Σ_i w_i ∂²Φ_i/∂z², z = (x_k, u_k, u_{k+1}, θ): the second derivatives of a step, contracted.
///
/// For an implicit map, with μ = (∂r/∂x_{k+1})⁻ᵀ w and W = ∂(x_{k+1}, z)/∂z: −Wᵀ (Σ μ_i r_i″) W.
template <StepMap M>
Matrix<double, argumentSize<M>, argumentSize<M>> contractedHessian(
    const M& map, const StateOf<M>& x, const InputOf<M>& u0, const InputOf<M>& u1,
    const ParametersOf<M>& theta, const StateOf<M>& w) {
  if constexpr (DifferentiatedStepMap<M>) {
    return map.contractedHessian(x, u0, u1, theta, w);
  } else if constexpr (ExplicitStepMap<M>) {
    requireSizes(map, x, u0, theta);
    return contractedHessian(detail::stepOfArgument(map), packArgument<M>(x, u0, u1, theta), w);
  } else {
    const Step<M::stateSize> solution = info::solve(map, x, u0, u1, theta);
    const auto [y, dr] = detail::residualJacobian(map, solution.x1, x, u0, u1, theta);
    const Eigen::Index n = x.size(), nz = dr.cols() - n;
    const Matrix<double, M::stateSize, M::stateSize> dr_dx1 = dr.template leftCols<M::stateSize>(n);
    const StateOf<M> mu = dr_dx1.transpose().partialPivLu().solve(w);
    Matrix<double, addSizes(M::stateSize, argumentSize<M>), argumentSize<M>> W(n + nz, nz);
    W.template topRows<M::stateSize>(n) =
        -dr_dx1.partialPivLu().solve(dr.template rightCols<argumentSize<M>>(nz));
    W.template bottomRows<argumentSize<M>>(nz).setIdentity();
    return -W.transpose() * contractedHessian(detail::residualOfArgument(map), y, mu) * W;
  }
}

/// A step together with its sensitivity ψ = dx/dθ.
template <int N, int P>
struct SensitivityStep {
  Step<N> solution;
  Matrix<double, N, P> psi1;  ///< ψ_{k+1} = ∂Φ/∂x ψ_k + ∂Φ/∂θ   (5.1)
};

/// One step of x and ψ. Explicit maps propagate the p directions (ψ_k, I) through the step itself,
/// so that the cost grows with p only; ψ is the derivative of the numerical steps, exact to
/// rounding.
template <StepMap M>
SensitivityStep<M::stateSize, M::parameterSize> advance(
    const M& map, const StateOf<M>& x, const Matrix<double, M::stateSize, M::parameterSize>& psi,
    const InputOf<M>& u0, const InputOf<M>& u1, const ParametersOf<M>& theta) {
  if constexpr (ExplicitStepMap<M> && !DifferentiatedStepMap<M>) {
    requireSizes(map, x, u0, theta);
    constexpr int block = detail::directionBlock(M::parameterSize);
    using T = Dual<block>;
    SensitivityStep<M::stateSize, M::parameterSize> out;
    out.solution.x1 = x;
    out.psi1 = psi;
    const Eigen::Index p = theta.size();
    const InputOf<M, T> u0T = u0.template cast<T>(), u1T = u1.template cast<T>();
    for (Eigen::Index first = 0; first == 0 || first < p; first += block) {
      const Eigen::Index count = std::min<Eigen::Index>(block, p - first);
      StateOf<M, T> xT = x.template cast<T>();
      ParametersOf<M, T> thetaT = theta.template cast<T>();
      for (Eigen::Index i = 0; i < x.size(); ++i)
        for (Eigen::Index j = 0; j < count; ++j) xT[i].derivatives()[j] = psi(i, first + j);
      for (Eigen::Index j = 0; j < count; ++j) thetaT[first + j].derivatives()[j] = 1.0;
      const StateOf<M, T> x1 = map.step(xT, u0T, u1T, thetaT);
      for (Eigen::Index i = 0; i < x.size(); ++i) {
        out.solution.x1[i] = x1[i].value();
        for (Eigen::Index j = 0; j < count; ++j) out.psi1(i, first + j) = x1[i].derivatives()[j];
      }
    }
    return out;
  } else {
    const auto at = info::linearise(map, x, u0, u1, theta);
    return {at.solution, at.dx * psi + at.dtheta};
  }
}

}  // namespace info
