#pragma once

#include <limits>
#include <utility>
#include <vector>

#include "info/dynamics/sensitivity.h"
#include "info/estimation/least_squares.h"

namespace info {

/// The experiment on a step map: initial state, inputs, and sampling times.
template <StepMap M>
struct Experiment {
  StateOf<M> x0;                      ///< initial state, known and independent of θ
  std::vector<InputOf<M>> inputs;     ///< u_0 … u_K
  std::vector<std::size_t> measured;  ///< steps k of the samples, 0 ≤ k ≤ K
};

/// first, first + every, … up to and including `last`: the steps of equidistant samples.
inline std::vector<std::size_t> stepsEvery(std::size_t first, std::size_t every, std::size_t last) {
  std::vector<std::size_t> steps;
  for (std::size_t k = first; k <= last; k += every) steps.push_back(k);
  return steps;
}

namespace detail {

/// y and Γ = D_x g ψ + D_θ g   (2.6)   of one sample, along the directions (ψ, I).
template <StepMap M>
void outputWithSensitivity(const M& map, const StateOf<M>& x, const StateSensitivityOf<M>& psi,
                           const InputOf<M>& u, const ParametersOf<M>& theta,
                           Eigen::Ref<Eigen::VectorXd> y, Eigen::Ref<Eigen::MatrixXd> gamma) {
  constexpr int block = directionBlock(M::parameterSize);
  using T = Dual<block>;
  const Eigen::Index p = theta.size();
  const InputOf<M, T> uT = u.template cast<T>();
  for (Eigen::Index first = 0; first == 0 || first < p; first += block) {
    const Eigen::Index count = std::min<Eigen::Index>(block, p - first);
    StateOf<M, T> xT = x.template cast<T>();
    ParametersOf<M, T> thetaT = theta.template cast<T>();
    for (Eigen::Index j = 0; j < count; ++j) {
      for (Eigen::Index i = 0; i < x.size(); ++i) xT[i].derivatives()[j] = psi(i, first + j);
      thetaT[first + j].derivatives()[j] = 1.0;
    }
    const OutputOf<M, T> yT = map.g(xT, uT, thetaT);
    for (Eigen::Index i = 0; i < yT.size(); ++i) {
      y[i] = yT[i].value();
      for (Eigen::Index j = 0; j < count; ++j) gamma(i, first + j) = yT[i].derivatives()[j];
    }
  }
}

/// g as a function of the one vector (x, θ).
template <StepMap M>
auto outputOfStateAndParameters(const M& map, const InputOf<M>& u) {
  constexpr int size = addSizes(M::stateSize, M::parameterSize);
  return [&map, &u]<class T>(const Vector<T, size>& z) -> OutputOf<M, T> {
    const Dimensions d = dimensionsOf(map);
    return map.g(StateOf<M, T>(z.head(d.state)), InputOf<M, T>(u.template cast<T>()),
                 ParametersOf<M, T>(z.tail(d.parameter)));
  };
}

}  // namespace detail

/// The predictor of an experiment on a step map (Rk4, ImplicitMidpoint, a variational integrator, a
/// user's own): outputs, first derivatives along the steps taken (5.1), and second derivatives by
/// one backward sweep,
///     Σ_k w_kᵀ d²y_k/dθ² = Σ_k (D_x gᵀw_k)ᵀ Ω_k + Z_kᵀ (Σ_i w_ik ∂²g_i/∂(x,θ)²) Z_k,   Z_k = (ψ_k,
///     I)
/// which is (2.9) with every term. After a step that fails, the samples are NaN. θ is the complete
/// parameter vector of the map, in its units; reparametrise() selects a part of it.
///
/// @throws DimensionError if a sample lies beyond the inputs, or a run-time size does not fit
template <StepMap M>
Predictor makePredictor(M map, Experiment<M> experiment) {
  if (experiment.measured.empty())
    throw DimensionError("measured: number of samples is 0, must be >= 1");
  for (std::size_t k : experiment.measured)
    if (k >= experiment.inputs.size())
      throw DimensionError("measured: step " + std::to_string(k) +
                           " lies beyond the inputs, must be < " +
                           std::to_string(experiment.inputs.size()));
  const Dimensions d = dimensionsOf(map);
  requireLength("x0", experiment.x0.size(), d.state);
  const double undefined = std::numeric_limits<double>::quiet_NaN();
  const auto parametersFrom = [p = d.parameter](const Eigen::VectorXd& theta) {
    requireLength("parameters theta", theta.size(), p);
    return ParametersOf<M>(theta);
  };

  Predictor predictor;
  predictor.outputs = [map, experiment, d, undefined,
                       parametersFrom](const Eigen::VectorXd& theta) -> Eigen::MatrixXd {
    const ParametersOf<M> parameters = parametersFrom(theta);
    const auto run = simulate(map, experiment.x0, experiment.inputs, parameters);
    const Eigen::Index n = static_cast<Eigen::Index>(experiment.measured.size());
    Eigen::MatrixXd outputs = Eigen::MatrixXd::Constant(d.output, n, undefined);
    for (Eigen::Index s = 0; s < n; ++s) {
      const std::size_t k = experiment.measured[static_cast<std::size_t>(s)];
      if (k < run.x.size()) outputs.col(s) = map.g(run.x[k], experiment.inputs[k], parameters);
    }
    return outputs;
  };
  predictor.withSensitivities = [map, experiment, d, undefined,
                                 parametersFrom](const Eigen::VectorXd& theta) {
    const ParametersOf<M> parameters = parametersFrom(theta);
    const auto run = simulateWithSensitivity(
        map, experiment.x0, StateSensitivityOf<M>::Zero(d.state, d.parameter).eval(),
        experiment.inputs, parameters);
    const Eigen::Index n = static_cast<Eigen::Index>(experiment.measured.size());
    Prediction prediction{Eigen::MatrixXd::Constant(d.output, n, undefined),
                          Eigen::MatrixXd::Constant(d.output * n, d.parameter, undefined)};
    Eigen::VectorXd y(d.output);
    for (Eigen::Index s = 0; s < n; ++s) {
      const std::size_t k = experiment.measured[static_cast<std::size_t>(s)];
      if (k >= run.x.size()) continue;
      detail::outputWithSensitivity(map, run.x[k], run.psi[k], experiment.inputs[k], parameters, y,
                                    prediction.gamma.middleRows(s * d.output, d.output));
      prediction.outputs.col(s) = y;
    }
    return prediction;
  };
  predictor.contractedCurvature = [map, experiment, d, undefined, parametersFrom](
                                      const Eigen::VectorXd& theta,
                                      const Eigen::MatrixXd& w) -> Eigen::MatrixXd {
    const ParametersOf<M> parameters = parametersFrom(theta);
    const auto run = simulateWithSensitivity(
        map, experiment.x0, StateSensitivityOf<M>::Zero(d.state, d.parameter).eval(),
        experiment.inputs, parameters);
    if (!run.complete) return Eigen::MatrixXd::Constant(d.parameter, d.parameter, undefined);
    // the direct contribution of the outputs, and their weights on the states
    constexpr int size = addSizes(M::stateSize, M::parameterSize);
    std::vector<StateOf<M>> weights(run.x.size(), StateOf<M>::Zero(d.state));
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(d.parameter, d.parameter);
    for (std::size_t s = 0; s < experiment.measured.size(); ++s) {
      const std::size_t k = experiment.measured[s];
      const OutputOf<M> w_k = w.col(static_cast<Eigen::Index>(s));
      Vector<double, size> z(d.state + d.parameter);
      z << run.x[k], parameters;
      const auto g = detail::outputOfStateAndParameters(map, experiment.inputs[k]);
      weights[k] += jacobian(g, z).leftCols(d.state).transpose() * w_k;
      Matrix<double, size, M::parameterSize> Z(d.state + d.parameter, d.parameter);
      Z.topRows(d.state) = run.psi[k];
      Z.bottomRows(d.parameter).setIdentity();
      sum += Z.transpose() * contractedHessian(g, z, w_k) * Z;
    }
    return sum + contractSecondSensitivity(map, run, experiment.inputs, parameters, weights);
  };
  return predictor;
}

/// The predictor for a subset of a model's parameters, in other units: the full vector is
/// `nominal`, with nominal[estimated[i]] replaced by unit[i]·θ_i.
/// @throws std::invalid_argument if sizes differ or an index is out of range
Predictor reparametrise(Predictor full, Eigen::VectorXd nominal,
                        std::vector<Eigen::Index> estimated, Eigen::VectorXd unit);

}  // namespace info
