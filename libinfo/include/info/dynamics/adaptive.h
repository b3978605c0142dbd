#pragma once

#include <functional>
#include <string>
#include <vector>

#include "info/autodiff/derivatives.h"
#include "info/dynamics/sensitivity.h"
#include "info/dynamics/system.h"

namespace info {

/// Tolerances and limits of an adaptive integration.
struct AdaptiveOptions {
  double relativeTolerance = 1e-8;   ///< of every component, > 0
  double absoluteTolerance = 1e-10;  ///< in the unit of each component, > 0
  double largestTimeStep = 0.0;  ///< [s] >= 0; 0: no limit. Set it below the shortest pulse of u
  long maxSteps = 100'000;       ///< > 0, between two requested times
};

/// Method of integrating the sensitivities ψ of a continuous system.
enum class SensitivityMethod {
  extendedState,  ///< x and ψ as one system of differential equations, (2.7)
  forward,        ///< ψ after x in every step: the staggered method of the solver
};

/// A motion at the requested times.
template <int N, int P>
struct AdaptiveTrajectory {
  std::vector<double> times;  ///< those reached [s]
  std::vector<Vector<double, N>> x;
  std::vector<Matrix<double, N, P>> psi;  ///< empty unless requested
  bool complete = true;                   ///< false: stopped before the last requested time
  double reachedTime = 0.0;               ///< [s]
  std::string why;                        ///< reason for an early stop; empty if complete
  long steps = 0;
  long evaluations = 0;  ///< of f
};

/// An ordinary differential equation of run-time size for solveOde; arrays are column-major.
struct OdeProblem {
  using Field = std::function<void(double t, const double* x, double* xDot)>;
  using JacobianField = std::function<void(double t, const double* x, double* dxDot_dx)>;
  using SensitivityField =
      std::function<void(double t, const double* x, const double* psi, double* psiDot)>;
  Eigen::Index size = 0;
  Field field;
  JacobianField jacobian;             ///< empty: approximated by differences
  Eigen::Index sensitivityCount = 0;  ///< columns of ψ
  SensitivityField sensitivity;
};

/// Solves ẋ = field(t, x) by variable-order, variable-step backward differentiation (BDF, CVODES of
/// SUNDIALS), with dense output at the requested times.
///
/// @param times t_0 < t_1 < … [s]; x0 belongs to t_0
/// @throws std::domain_error for tolerances that are not positive, times that do not increase or a
///     start that is not finite; whatever the field throws
AdaptiveTrajectory<dynamic, dynamic> solveOde(const OdeProblem& problem, const Eigen::VectorXd& x0,
                                              const Eigen::MatrixXd& psi0,
                                              const std::vector<double>& times,
                                              const AdaptiveOptions& options);

/// u(t) of a system S.
template <class S>
using InputSignal = std::function<InputOf<S>(double)>;

/// ψ̇ = D_x f ψ + D_θ f   (2.7), with ẋ and D_x f.
template <SmoothSystem S>
struct SensitivityRate {
  StateOf<S> xDot;
  Matrix<double, S::stateSize, S::stateSize> df_dx;
  StateSensitivityOf<S> psiDot;
};
template <SmoothSystem S>
SensitivityRate<S> sensitivityRate(const S& system, const StateOf<S>& x, const InputOf<S>& u,
                                   const ParametersOf<S>& theta, const StateSensitivityOf<S>& psi) {
  constexpr int n = S::stateSize, p = S::parameterSize;
  const Eigen::Index size = x.size(), count = theta.size();
  const auto field = [&]<class T>(const Vector<T, addSizes(n, p)>& z) {
    return StateOf<S, T>(system.f(StateOf<S, T>(z.template head<n>(size)),
                                  InputOf<S, T>(u.template cast<T>()),
                                  ParametersOf<S, T>(z.template segment<p>(size, count))));
  };
  Vector<double, addSizes(n, p)> z(size + count);
  z << x, theta;
  const auto at = differentiate(field, z);
  return {at.value, at.jacobian.template leftCols<n>(size),
          at.jacobian.template leftCols<n>(size) * psi + at.jacobian.template rightCols<p>(count)};
}

/// ∂f/∂x.
template <SmoothSystem S>
Matrix<double, S::stateSize, S::stateSize> stateJacobian(const S& system, const StateOf<S>& x,
                                                         const InputOf<S>& u,
                                                         const ParametersOf<S>& theta) {
  const auto field = [&]<class T>(const StateOf<S, T>& at) {
    return StateOf<S, T>(system.f(at, InputOf<S, T>(u.template cast<T>()),
                                  ParametersOf<S, T>(theta.template cast<T>())));
  };
  return jacobian(field, x);
}

namespace detail {

template <class S>
AdaptiveTrajectory<S::stateSize, S::parameterSize> withSizes(
    AdaptiveTrajectory<dynamic, dynamic>&& from, Eigen::Index n, Eigen::Index p) {
  AdaptiveTrajectory<S::stateSize, S::parameterSize> out;
  const bool extended = !from.x.empty() && from.x.front().size() > n;
  for (const auto& x : from.x) {
    out.x.push_back(x.head(n));
    if (extended) out.psi.push_back(Eigen::Map<const Eigen::MatrixXd>(x.data() + n, n, p));
  }
  for (const auto& psi : from.psi) out.psi.push_back(psi);
  out.times = std::move(from.times);
  out.complete = from.complete;
  out.reachedTime = from.reachedTime;
  out.why = std::move(from.why);
  out.steps = from.steps;
  out.evaluations = from.evaluations;
  return out;
}

}  // namespace detail

/// The motion of a continuous system at the requested times, by solveOde with the exact Jacobian.
/// Where u(t) jumps, end one call at the jump and start the next there.
template <SmoothSystem S>
AdaptiveTrajectory<S::stateSize, S::parameterSize> integrate(const S& system, const StateOf<S>& x0,
                                                             const InputSignal<S>& u,
                                                             const ParametersOf<S>& theta,
                                                             const std::vector<double>& times,
                                                             const AdaptiveOptions& options = {}) {
  const Eigen::Index n = x0.size();
  OdeProblem problem;
  problem.size = n;
  problem.field = [&](double t, const double* x, double* xDot) {
    const StateOf<S> at = Eigen::Map<const StateOf<S>>(x, n);
    Eigen::Map<StateOf<S>>(xDot, n) = system.f(at, u(t), theta);
  };
  problem.jacobian = [&](double t, const double* x, double* J) {
    const StateOf<S> at = Eigen::Map<const StateOf<S>>(x, n);
    Eigen::Map<Eigen::MatrixXd>(J, n, n) = stateJacobian(system, at, u(t), theta);
  };
  if (!times.empty()) requireSizes(system, x0, u(times.front()), theta);
  return detail::withSizes<S>(solveOde(problem, x0, Eigen::MatrixXd(n, 0), times, options), n,
                              theta.size());
}

/// The motion as by integrate(), with ψ = dx/dθ; both methods hold x and ψ to the tolerances.
/// @param psi0 dx_0/dθ
template <SmoothSystem S>
AdaptiveTrajectory<S::stateSize, S::parameterSize> integrateWithSensitivity(
    const S& system, const StateOf<S>& x0, const StateSensitivityOf<S>& psi0,
    const InputSignal<S>& u, const ParametersOf<S>& theta, const std::vector<double>& times,
    const AdaptiveOptions& options = {},
    SensitivityMethod method = SensitivityMethod::extendedState) {
  const Eigen::Index n = x0.size(), p = theta.size();
  using Psi = StateSensitivityOf<S>;
  if (!times.empty()) requireSizes(system, x0, u(times.front()), theta);
  requireLength("psi_0 rows", psi0.rows(), n);
  requireLength("psi_0 columns", psi0.cols(), p);
  const auto rate = [&](double t, const double* x, const double* psi) {
    const StateOf<S> at = Eigen::Map<const StateOf<S>>(x, n);
    const Psi with = Eigen::Map<const Psi>(psi, n, p);
    return sensitivityRate(system, at, u(t), theta, with);
  };
  OdeProblem problem;
  if (method == SensitivityMethod::extendedState) {
    problem.size = n + n * p;
    problem.field = [&](double t, const double* z, double* zDot) {
      const auto at = rate(t, z, z + n);
      Eigen::Map<StateOf<S>>(zDot, n) = at.xDot;
      Eigen::Map<Psi>(zDot + n, n, p) = at.psiDot;
    };
    // The block diagonal of D_x f; the omitted ∂ψ̇/∂x slows Newton's method only a little.
    problem.jacobian = [&](double t, const double* z, double* J) {
      const StateOf<S> at = Eigen::Map<const StateOf<S>>(z, n);
      const auto df_dx = stateJacobian(system, at, u(t), theta);
      Eigen::Map<Eigen::MatrixXd> all(J, n + n * p, n + n * p);
      all.setZero();
      for (Eigen::Index j = 0; j <= p; ++j) all.block(j * n, j * n, n, n) = df_dx;
    };
    Eigen::VectorXd z0(n + n * p);
    z0 << x0, psi0.reshaped();
    return detail::withSizes<S>(
        solveOde(problem, z0, Eigen::MatrixXd(z0.size(), 0), times, options), n, p);
  }
  problem.size = n;
  problem.field = [&](double t, const double* x, double* xDot) {
    const StateOf<S> at = Eigen::Map<const StateOf<S>>(x, n);
    Eigen::Map<StateOf<S>>(xDot, n) = system.f(at, u(t), theta);
  };
  problem.jacobian = [&](double t, const double* x, double* J) {
    const StateOf<S> at = Eigen::Map<const StateOf<S>>(x, n);
    Eigen::Map<Eigen::MatrixXd>(J, n, n) = stateJacobian(system, at, u(t), theta);
  };
  problem.sensitivityCount = p;
  problem.sensitivity = [&](double t, const double* x, const double* psi, double* psiDot) {
    Eigen::Map<Psi>(psiDot, n, p) = rate(t, x, psi).psiDot;
  };
  return detail::withSizes<S>(solveOde(problem, x0, psi0, times, options), n, p);
}

}  // namespace info
