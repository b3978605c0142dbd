#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "info/derivatives.h"
#include "info/step_map.h"

/// A system at one θ with its sensitivities ψ = dx/dθ as further states: what the optimisation of a
/// motion needs, made from any step map or any continuous system. Run-time sizes; pure, and usable
/// from several threads.
namespace info {

/// Γ = D_x g ψ + D_θ g   (2.6)   and the gradient of ⟨P, Γ⟩.
struct ExtendedOutput {
  std::function<Eigen::MatrixXd(const Eigen::VectorXd& x, const Eigen::MatrixXd& psi,
                                const Eigen::VectorXd& u)>
      gamma;  ///< outputs × parameters
  struct Gradient {
    Eigen::VectorXd x;
    Eigen::MatrixXd psi;  ///< n × p: D_x gᵀ P
    Eigen::VectorXd u;    ///< not 0 where u is in g
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
  int candidates = 1;  ///< how many systems it is a stack of, sizes being those of all
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

/// Value, first derivatives along (ψ, I) and the derivatives of both in w, of F(w, θ) where the
/// first n of w are x. One sweep where the directions are few.
struct NestedDerivatives {
  Eigen::MatrixXd dw;     ///< ∂F/∂w
  Eigen::MatrixXd dpsiw;  ///< ∂vec(D_xF ψ + D_θF)/∂w
};

template <int N, int W, int P, class F>
NestedDerivatives nestedDerivatives(const F& function, const Vector<double, W>& w,
                                    const Eigen::MatrixXd& psi, const Vector<double, P>& theta) {
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
  const Eigen::Index rows = image.size();
  NestedDerivatives out{Eigen::MatrixXd(rows, W), Eigen::MatrixXd(rows * P, W)};
  for (Eigen::Index i = 0; i < rows; ++i)
    for (Eigen::Index d = 0; d < W; ++d) {
      const Inner& slope = image[i].derivatives()[d];
      out.dw(i, d) = slope.value();
      for (Eigen::Index j = 0; j < P; ++j) out.dpsiw(j * rows + i, d) = slope.derivatives()[j];
    }
  return out;
}

/// The value and its derivatives along the p directions (ψ, I) only.
template <int N, int W, int P, class F>
auto alongPsi(const F& function, const Vector<double, W>& w, const Eigen::MatrixXd& psi,
              const Vector<double, P>& theta) {
  using T = Dual<P>;
  Vector<T, W> wT = w.template cast<T>();
  Vector<T, P> thetaT = theta.template cast<T>();
  for (Eigen::Index j = 0; j < P; ++j) {
    for (Eigen::Index i = 0; i < N; ++i) wT[i].derivatives()[j] = psi(i, j);
    thetaT[j].derivatives()[j] = 1.0;
  }
  const auto image = function(wT, thetaT).eval();
  std::pair<Eigen::VectorXd, Eigen::MatrixXd> out{Eigen::VectorXd(image.size()),
                                                  Eigen::MatrixXd(image.size(), P)};
  for (Eigen::Index i = 0; i < image.size(); ++i) {
    out.first[i] = image[i].value();
    out.second.row(i) = image[i].derivatives().transpose();
  }
  return out;
}

template <class S>
ExtendedOutput extendedOutput(std::shared_ptr<const S> system, const ParametersOf<S>& theta) {
  constexpr int n = S::stateSize, m = S::inputSize, p = S::parameterSize, w = n + m;
  const auto g = [=](const auto& at, const auto& parameters) {
    using T = typename std::decay_t<decltype(at)>::Scalar;
    return OutputOf<S, T>(system->g(Vector<T, n>(at.template head<n>()),
                                    Vector<T, m>(at.template tail<m>()), parameters));
  };
  ExtendedOutput out;
  out.gamma = [=](const Eigen::VectorXd& x, const Eigen::MatrixXd& psi, const Eigen::VectorXd& u) {
    Vector<double, w> at;
    at << x, u;
    return alongPsi<n, w, p>(g, at, psi, theta).second;
  };
  out.gradient = [=](const Eigen::VectorXd& x, const Eigen::MatrixXd& psi, const Eigen::VectorXd& u,
                     const Eigen::MatrixXd& P) {
    Vector<double, w> at;
    at << x, u;
    const NestedDerivatives d = nestedDerivatives<n, w, p>(g, at, psi, theta);
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
      auto d = detail::nestedDerivatives<n, w, p>(step, at, psi, theta);
      return ExtendedStepMap::Derivatives{std::move(d.dw), std::move(d.dpsiw)};
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
  out.output = detail::extendedOutput<M>(shared, theta);
  return out;
}

/// The extended form of a continuous system of fixed sizes at θ.
template <SmoothSystem S>
ExtendedFlow extendFlow(S system, const ParametersOf<S>& theta) {
  constexpr int n = S::stateSize, m = S::inputSize, p = S::parameterSize, w = n + m;
  static_assert(n > 0 && m > 0 && p > 0, "fixed sizes, at least one state, input and parameter");
  const auto shared = std::make_shared<const S>(std::move(system));
  const auto f = [=](const auto& at, const auto& parameters) {
    using T = typename std::decay_t<decltype(at)>::Scalar;
    return StateOf<S, T>(shared->f(Vector<T, n>(at.template head<n>()),
                                   Vector<T, m>(at.template tail<m>()), parameters));
  };
  ExtendedFlow out{dimensionsOf(*shared), shared->parameterNames(), {}, {}, {}};
  out.rate = [=](const Eigen::VectorXd& x, const Eigen::MatrixXd& psi, const Eigen::VectorXd& u) {
    Vector<double, w> at;
    at << x, u;
    auto [xDot, psiDot] = detail::alongPsi<n, w, p>(f, at, psi, theta);
    return ExtendedFlow::Rate{std::move(xDot), std::move(psiDot)};
  };
  out.derivatives = [=](const Eigen::VectorXd& x, const Eigen::MatrixXd& psi,
                        const Eigen::VectorXd& u) {
    Vector<double, w> at;
    at << x, u;
    auto d = detail::nestedDerivatives<n, w, p>(f, at, psi, theta);
    return ExtendedFlow::Derivatives{std::move(d.dw), std::move(d.dpsiw)};
  };
  out.output = detail::extendedOutput<S>(shared, theta);
  return out;
}

}  // namespace info
