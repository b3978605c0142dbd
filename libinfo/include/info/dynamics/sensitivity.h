#pragma once

#include <string>
#include <vector>

#include "info/dynamics/step_map.h"

namespace info {

/// States at k = 0 … K and, if requested, ψ_k = dx_k/dθ.
template <int N, int P>
struct Trajectory {
  std::vector<Vector<double, N>> x;       ///< shorter than K + 1 if a step failed
  std::vector<Matrix<double, N, P>> psi;  ///< empty unless requested
  bool complete = true;                   ///< false: step x.size() − 1 failed
  double residualNorm = 0.0;              ///< of the failed step
};

template <class M>
using TrajectoryOf = Trajectory<M::stateSize, M::parameterSize>;
template <class M>
using StateSensitivityOf = Matrix<double, M::stateSize, M::parameterSize>;

/// Runs a step map from x_0 under u_0 … u_K.
/// @throws DimensionError if a run-time size is wrong or there is no u_0
template <StepMap M>
TrajectoryOf<M> simulate(const M& map, const StateOf<M>& x0, const std::vector<InputOf<M>>& inputs,
                         const ParametersOf<M>& theta) {
  if (inputs.empty()) throw DimensionError("inputs: number is 0, must be >= 1 (u_0 ... u_K)");
  requireSizes(map, x0, inputs.front(), theta);
  TrajectoryOf<M> out;
  out.x.reserve(inputs.size());
  out.x.push_back(x0);
  for (std::size_t k = 0; k + 1 < inputs.size(); ++k) {
    const auto next = info::solve(map, out.x.back(), inputs[k], inputs[k + 1], theta);
    if (!next.converged) {
      out.complete = false;
      out.residualNorm = next.residualNorm;
      break;
    }
    out.x.push_back(next.x1);
  }
  return out;
}

/// The trajectory of x with ψ_{k+1} = A_k ψ_k + ∂Φ/∂θ   (5.1), exact for the steps taken.
/// @param psi0 ψ_0 = dx_0/dθ, zero if the initial state does not depend on θ
template <StepMap M>
TrajectoryOf<M> simulateWithSensitivity(const M& map, const StateOf<M>& x0,
                                        const StateSensitivityOf<M>& psi0,
                                        const std::vector<InputOf<M>>& inputs,
                                        const ParametersOf<M>& theta) {
  if (inputs.empty()) throw DimensionError("inputs: number is 0, must be >= 1 (u_0 ... u_K)");
  requireSizes(map, x0, inputs.front(), theta);
  requireLength("psi_0 rows", psi0.rows(), x0.size());
  requireLength("psi_0 columns", psi0.cols(), theta.size());
  TrajectoryOf<M> out;
  out.x.reserve(inputs.size());
  out.psi.reserve(inputs.size());
  out.x.push_back(x0);
  out.psi.push_back(psi0);
  for (std::size_t k = 0; k + 1 < inputs.size(); ++k) {
    const auto next = advance(map, out.x.back(), out.psi.back(), inputs[k], inputs[k + 1], theta);
    if (!next.solution.converged) {
      out.complete = false;
      out.residualNorm = next.solution.residualNorm;
      break;
    }
    out.x.push_back(next.solution.x1);
    out.psi.push_back(next.psi1);
  }
  return out;
}

/// Σ_k w_kᵀ Ω_k [p × p], Ω_k = d²x_k/dθ², by one backward sweep: with λ_K = w_K, λ_k = A_kᵀ λ_{k+1}
/// + w_k,
///     Σ_k w_kᵀ Ω_k = Σ_k Z_kᵀ (Σ_i λ_{k+1,i} ∂²Φ_i/∂(x,θ)²) Z_k,   Z_k = (ψ_k, I).
/// No tensor is formed. Needs a trajectory with ψ; Ω_0 = 0.
/// @param weights w_0 … w_K
template <StepMap M>
Matrix<double, M::parameterSize, M::parameterSize> contractSecondSensitivity(
    const M& map, const TrajectoryOf<M>& trajectory, const std::vector<InputOf<M>>& inputs,
    const ParametersOf<M>& theta, const std::vector<StateOf<M>>& weights);

namespace detail {

/// Zᵀ H Z with Z = (ψ, 0, 0, I) in z = (x, u_k, u_{k+1}, θ).
template <StepMap M>
Matrix<double, M::parameterSize, M::parameterSize> alongParameters(
    const Matrix<double, argumentSize<M>, argumentSize<M>>& hessian,
    const StateSensitivityOf<M>& psi) {
  const Eigen::Index n = psi.rows(), p = psi.cols(), last = hessian.rows() - p;
  const Matrix<double, M::parameterSize, M::parameterSize> cross =
      hessian.template block<M::parameterSize, M::stateSize>(last, 0, p, n) * psi;
  return psi.transpose() * hessian.template topLeftCorner<M::stateSize, M::stateSize>(n, n) * psi +
         cross + cross.transpose() +
         hessian.template bottomRightCorner<M::parameterSize, M::parameterSize>(p, p);
}

template <StepMap M>
void requireSensitivities(const M&, const TrajectoryOf<M>& t, std::size_t inputs) {
  if (t.psi.size() != t.x.size() || t.x.empty())
    throw DimensionError("trajectory: number of psi_k is " + std::to_string(t.psi.size()) +
                         ", must be as many as states, " + std::to_string(t.x.size()) +
                         " and >= 1");
  if (inputs < t.x.size())
    throw DimensionError("inputs: number is " + std::to_string(inputs) +
                         ", must be >= " + std::to_string(t.x.size()) + " (one per state)");
}

}  // namespace detail

template <StepMap M>
Matrix<double, M::parameterSize, M::parameterSize> contractSecondSensitivity(
    const M& map, const TrajectoryOf<M>& trajectory, const std::vector<InputOf<M>>& inputs,
    const ParametersOf<M>& theta, const std::vector<StateOf<M>>& weights) {
  detail::requireSensitivities(map, trajectory, inputs.size());
  if (weights.size() != trajectory.x.size())
    throw DimensionError("weights: number is " + std::to_string(weights.size()) + ", must be " +
                         std::to_string(trajectory.x.size()) + " (one per state)");
  using Square = Matrix<double, M::parameterSize, M::parameterSize>;
  Square sum = Square::Zero(theta.size(), theta.size());
  StateOf<M> lambda = weights.back();
  for (std::size_t k = trajectory.x.size() - 1; k-- > 0;) {
    const auto& x = trajectory.x[k];
    sum += detail::alongParameters<M>(
        info::contractedHessian(map, x, inputs[k], inputs[k + 1], theta, lambda),
        trajectory.psi[k]);
    const auto at = info::linearise(map, x, inputs[k], inputs[k + 1], theta);
    lambda = (at.dx.transpose() * lambda + weights[k]).eval();
  }
  return sum;
}

}  // namespace info
