#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "info/dynamics/extended_derivatives.h"
#include "info/dynamics/step_map.h"

/// A system at one θ with its sensitivities ψ = dx/dθ as further states, made from any step map or
/// continuous system, for the optimisation of motions. Run-time sizes; pure, and usable from
/// several threads.
namespace info {

/// Γ = D_x g ψ + D_θ g   (2.6)   and the gradient of ⟨P, Γ⟩.
struct ExtendedOutput {
  std::function<Eigen::MatrixXd(const Eigen::VectorXd& x, const Eigen::MatrixXd& psi,
                                const Eigen::VectorXd& u)>
      gamma;  ///< outputs × parameters
  struct Gradient {
    Eigen::VectorXd x;
    Eigen::MatrixXd psi;  ///< n × p: D_x gᵀ P
    Eigen::VectorXd u;    ///< not 0 if g depends on u
  };
  std::function<Gradient(const Eigen::VectorXd& x, const Eigen::MatrixXd& psi,
                         const Eigen::VectorXd& u, const Eigen::MatrixXd& P)>
      gradient;
};

/// (x, ψ)_{k+1} from (x, ψ)_k, u_k and u_{k+1}, ψ_{k+1} = ∂Φ/∂x ψ_k + ∂Φ/∂θ   (5.1).
struct ExtendedStepMap {
  Dimensions dimensions;
  std::vector<std::string> parameterNames;
  struct Next {
    Eigen::VectorXd x;
    Eigen::MatrixXd psi;
    bool converged;
  };
  std::function<Next(const Eigen::VectorXd& x, const Eigen::MatrixXd& psi,
                     const Eigen::VectorXd& u0, const Eigen::VectorXd& u1)>
      step;
  /// First derivatives of a step; those of ψ hold the second derivatives of Φ. ψ column by column.
  struct Derivatives {
    Eigen::MatrixXd x;    ///< ∂x_{k+1}/∂(x, u_k, u_{k+1}): n × (n + 2m)
    Eigen::MatrixXd psi;  ///< ∂vec ψ_{k+1}/∂(x, u_k, u_{k+1}) at fixed ψ_k: np × (n + 2m)
  };
  std::function<Derivatives(const Eigen::VectorXd& x, const Eigen::MatrixXd& psi,
                            const Eigen::VectorXd& u0, const Eigen::VectorXd& u1)>
      derivatives;
  ExtendedOutput output;
  int candidates = 1;  ///< number of stacked systems; sizes are those of the stack
};

/// ẋ = f, ψ̇ = D_x f ψ + D_θ f   (2.7).
struct ExtendedFlow {
  Dimensions dimensions;
  std::vector<std::string> parameterNames;
  struct Rate {
    Eigen::VectorXd x;
    Eigen::MatrixXd psi;
  };
  std::function<Rate(const Eigen::VectorXd& x, const Eigen::MatrixXd& psi,
                     const Eigen::VectorXd& u)>
      rate;
  struct Derivatives {
    Eigen::MatrixXd x;    ///< ∂f/∂(x, u): n × (n + m)
    Eigen::MatrixXd psi;  ///< ∂vec ψ̇/∂(x, u) at fixed ψ: np × (n + m)
  };
  std::function<Derivatives(const Eigen::VectorXd& x, const Eigen::MatrixXd& psi,
                            const Eigen::VectorXd& u)>
      derivatives;
  ExtendedOutput output;
  int candidates = 1;  ///< how many systems it is a stack of, sizes being those of all
};

namespace detail {

template <class S>
ExtendedOutput outputFunctions(std::shared_ptr<const S> system, const ParametersOf<S>& theta) {
  constexpr int n = S::stateSize, m = S::inputSize;
  ExtendedOutput out;
  out.gamma = [=](const Eigen::VectorXd& x, const Eigen::MatrixXd& psi, const Eigen::VectorXd& u) {
    return Eigen::MatrixXd(
        extendedOutput(*system, StateOf<S>(x), StateSensitivityOf<S>(psi), InputOf<S>(u), theta)
            .along);
  };
  out.gradient = [=](const Eigen::VectorXd& x, const Eigen::MatrixXd& psi, const Eigen::VectorXd& u,
                     const Eigen::MatrixXd& P) {
    const auto d = extendedOutputDerivatives(*system, StateOf<S>(x), StateSensitivityOf<S>(psi),
                                             InputOf<S>(u), theta);
    const Eigen::VectorXd along = d.dpsiw.transpose() * P.reshaped();
    return ExtendedOutput::Gradient{along.head(n), d.dw.leftCols(n).transpose() * P, along.tail(m)};
  };
  return out;
}

}  // namespace detail

/// The extended form of a step map of fixed sizes at θ. The derivatives of ψ come from the nested
/// scalar for an explicit map, from the map's own second derivatives otherwise.
template <StepMap M>
ExtendedStepMap extend(M map, const ParametersOf<M>& theta) {
  constexpr int n = M::stateSize, m = M::inputSize, p = M::parameterSize, nz = argumentSize<M>;
  static_assert(n > 0 && m > 0 && p > 0, "fixed sizes, at least one state, input and parameter");
  const auto shared = std::make_shared<const M>(std::move(map));
  ExtendedStepMap out{dimensionsOf(*shared), shared->parameterNames(), {}, {}, {}};
  out.step = [=](const Eigen::VectorXd& x, const Eigen::MatrixXd& psi, const Eigen::VectorXd& u0,
                 const Eigen::VectorXd& u1) {
    const Matrix<double, n, p> fixedPsi = psi;
    const auto next =
        advance(*shared, StateOf<M>(x), fixedPsi, InputOf<M>(u0), InputOf<M>(u1), theta);
    return ExtendedStepMap::Next{next.solution.x1, next.psi1, next.solution.converged};
  };
  out.derivatives = [=](const Eigen::VectorXd& x, const Eigen::MatrixXd& psi,
                        const Eigen::VectorXd& u0, const Eigen::VectorXd& u1) {
    constexpr int w = n + 2 * m;
    if constexpr (ExplicitStepMap<M> && !DifferentiatedStepMap<M>) {
      const auto step = [&](const auto& at, const auto& parameters) {
        using T = typename std::decay_t<decltype(at)>::Scalar;
        return StateOf<M, T>(shared->step(Vector<T, n>(at.template head<n>()),
                                          Vector<T, m>(at.template segment<m>(Eigen::Index{n})),
                                          Vector<T, m>(at.template tail<m>()), parameters));
      };
      Vector<double, w> at;
      at << x, u0, u1;
      const auto d = detail::nestedDerivatives<n, w, p>(step, at, psi, theta);
      return ExtendedStepMap::Derivatives{d.dw, d.dpsiw};
    } else if constexpr (requires(const StateOf<M>& s, const InputOf<M>& u) {
                           shared->secondDerivatives(
                               shared->argumentsOf(s, u, u, theta),
                               shared->step(shared->argumentsOf(s, u, u, theta)));
                         }) {
      // a variational integrator: all second derivatives at once; only ρ of u_{k+1} has an effect
      const auto z = shared->argumentsOf(StateOf<M>(x), InputOf<M>(u0), InputOf<M>(u1), theta);
      const auto at = shared->secondDerivatives(z, shared->step(z));
      const Eigen::Index r = z.rho1.size(), known = n + m + r;
      Matrix<double, M::zSize, p> directions = Matrix<double, M::zSize, p>::Zero();
      directions.template topRows<n>() = psi;
      directions.template bottomRows<p>().setIdentity();
      ExtendedStepMap::Derivatives d{Eigen::MatrixXd::Zero(n, w), Eigen::MatrixXd::Zero(n * p, w)};
      d.x.leftCols(n + m) = at.first.leftCols(n + m);
      d.x.rightCols(r) = at.first.middleCols(n + m, r);
      for (int i = 0; i < n; ++i) {
        const Matrix<double, M::zSize, p> along = at.second[std::size_t(i)] * directions;
        for (int j = 0; j < p; ++j) {
          d.psi.row(j * n + i).head(n + m) = along.col(j).head(n + m).transpose();
          d.psi.row(j * n + i).tail(r) = along.col(j).segment(known - r, r).transpose();
        }
      }
      return d;
    } else {
      const StateOf<M> xF = x;
      const InputOf<M> u0F = u0, u1F = u1;
      Matrix<double, nz, p> directions = Matrix<double, nz, p>::Zero();
      directions.template topRows<n>() = psi;
      directions.template bottomRows<p>().setIdentity();
      const auto first = linearise(*shared, xF, u0F, u1F, theta);
      ExtendedStepMap::Derivatives d{Eigen::MatrixXd(n, w), Eigen::MatrixXd(n * p, w)};
      d.x << first.dx, first.du0, first.du1;
      for (int i = 0; i < n; ++i) {
        const auto hessian =
            contractedHessian(*shared, xF, u0F, u1F, theta, StateOf<M>(StateOf<M>::Unit(i)));
        const Matrix<double, w, p> along = hessian.template topRows<w>() * directions;
        for (int j = 0; j < p; ++j) d.psi.row(j * n + i) = along.col(j).transpose();
      }
      return d;
    }
  };
  out.output = detail::outputFunctions<M>(shared, theta);
  return out;
}

/// The extended form of a continuous system of fixed sizes at θ.
template <SmoothSystem S>
ExtendedFlow extendFlow(S system, const ParametersOf<S>& theta) {
  static_assert(S::stateSize > 0 && S::inputSize > 0 && S::parameterSize > 0,
                "fixed sizes, at least one state, input and parameter");
  const auto shared = std::make_shared<const S>(std::move(system));
  ExtendedFlow out{dimensionsOf(*shared), shared->parameterNames(), {}, {}, {}};
  out.rate = [=](const Eigen::VectorXd& x, const Eigen::MatrixXd& psi, const Eigen::VectorXd& u) {
    const auto at =
        extendedRate(*shared, StateOf<S>(x), StateSensitivityOf<S>(psi), InputOf<S>(u), theta);
    return ExtendedFlow::Rate{at.value, at.along};
  };
  out.derivatives = [=](const Eigen::VectorXd& x, const Eigen::MatrixXd& psi,
                        const Eigen::VectorXd& u) {
    const auto d = extendedRateDerivatives(*shared, StateOf<S>(x), StateSensitivityOf<S>(psi),
                                           InputOf<S>(u), theta);
    return ExtendedFlow::Derivatives{d.dw, d.dpsiw};
  };
  out.output = detail::outputFunctions<S>(shared, theta);
  return out;
}

}  // namespace info
