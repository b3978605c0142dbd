#pragma once

#include <functional>
#include <vector>

#include "info/autodiff/derivatives.h"
#include "info/dynamics/adaptive.h"
#include "info/dynamics/sensitivity.h"

namespace info {

/// u(t) of a system S.
template <class S>
using InputSignal = std::function<InputOf<S>(double)>;

/// The motion of a continuous system at the requested times, by solveOde.
template <SmoothSystem S>
AdaptiveTrajectory integrate(const S& system, const StateOf<S>& x0, const InputSignal<S>& u,
                             const ParametersOf<S>& theta, const std::vector<double>& times,
                             const AdaptiveOptions& options = {}) {
  const Eigen::Index n = x0.size();
  const auto field = [&](double t, const double* x, double* xDot) {
    const StateOf<S> at = Eigen::Map<const StateOf<S>>(x, n);
    Eigen::Map<StateOf<S>>(xDot, n) = system.f(at, u(t), theta);
  };
  return solveOde(field, x0, times, options);
}

/// x and ψ = dx/dθ at the last time, as one system of differential equations:
///     ψ̇ = D_x f ψ + D_θ f,  ψ_0 = 0   (2.7)
template <SmoothSystem S>
struct MotionAtEnd {
  StateOf<S> x;
  StateSensitivityOf<S> psi;
};
template <SmoothSystem S>
MotionAtEnd<S> integrateWithSensitivity(const S& system, const StateOf<S>& x0,
                                        const InputSignal<S>& u, const ParametersOf<S>& theta,
                                        double duration, const AdaptiveOptions& options) {
  static constexpr int n = S::stateSize, p = S::parameterSize;
  using Psi = StateSensitivityOf<S>;
  const auto field = [&](double t, const double* z, double* zDot) {
    const InputOf<S> input = u(t);
    const auto f = [&]<class T>(const Vector<T, n + p>& at) {
      return StateOf<S, T>(system.f(StateOf<S, T>(at.template head<n>()),
                                    InputOf<S, T>(input.template cast<T>()),
                                    ParametersOf<S, T>(at.template tail<p>())));
    };
    Vector<double, n + p> at;
    at << Eigen::Map<const StateOf<S>>(z), theta;
    const auto slope = differentiate(f, at);
    Eigen::Map<StateOf<S>>{zDot} = slope.value;
    Eigen::Map<Psi>{zDot + n} =
        slope.jacobian.template leftCols<n>() * Eigen::Map<const Psi>(z + n) +
        slope.jacobian.template rightCols<p>();
  };
  Eigen::VectorXd z = Eigen::VectorXd::Zero(n + n * p);
  z.head<n>() = x0;
  const AdaptiveTrajectory run = solveOde(field, z, {0.0, duration}, options);
  const Eigen::VectorXd& end = run.x.at(1);
  return {StateOf<S>(end.head<n>()), Psi(Eigen::Map<const Psi>(end.data() + n))};
}

}  // namespace info
