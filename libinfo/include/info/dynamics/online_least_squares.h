#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "info/dynamics/predictor.h"
#include "info/estimation/censored.h"
#include "info/estimation/estimate.h"

namespace info {

/// Window and iteration of an on-line estimator.
struct OnlineOptions {
  std::size_t window = 0;  ///< number of past samples used; 0: all, from a known initial state
  /// Prior standard deviation of each state at the start of the window about the last estimate, ≥ 0
  /// (0: fixed); only used with a window. [unit of the state]
  Eigen::VectorXd startSd = {};
  int maxIterations = 20;            ///< per update, ≥ 1
  double decrementTolerance = 1e-9;  ///< converged if a further step would gain less [nats], > 0
  std::size_t capacity = 0;          ///< number of samples to reserve memory for
};

/// @throws std::domain_error, DimensionError naming the violated rule
void checkOnlineOptions(const OnlineOptions& options, Eigen::Index states);

/// The result of an update.
template <StepMap M>
struct OnlineEstimate {
  ParametersOf<M> parameters;
  Matrix<double, M::parameterSize, M::parameterSize>
      covariance;             ///< Cramér–Rao bound at the estimate
  StateOf<M> x;               ///< state at the last sample
  StateSensitivityOf<M> psi;  ///< dx/dθ there
  std::size_t samples = 0;    ///< k of the last sample + 1
  double cost = 0;            ///< −log posterior up to a constant
  int iterations = 0;
  Termination why = Termination::iterationLimit;
  bool converged = false;
};

/// Nonlinear least squares on a growing recording: the estimate of θ after each update is the
/// minimum of
///     β = Σ_k Σ_i c_i(ỹ_ik, y_ik(θ, x_s)) + priors of θ + ½ Σ_j ((x_s − x̂_s)_j/σ_j)²
/// over the window s … K, where c is the negative log likelihood of a sensor that may clip
/// (censored.h), and the state is that of the model simulated with the measured inputs from x_s. If
/// all samples are used, x_s = x_0 is known; with a sliding window it is estimated as well, with
/// the last estimate as its prior mean.
///
/// Levenberg–Marquardt within the bounds, from the last estimate; c″ stands for Σ⁻¹, which gives
/// the Gauss–Newton Hessian (Wilson's thesis, section 2.2.1) if no sample is clipped. Not
/// converging is a result.
template <StepMap M>
class OnlineLeastSquares {
 public:
  static constexpr int n = M::stateSize, p = M::parameterSize, l = M::outputSize, q = p + n;
  static_assert(n > 0 && p > 0 && l > 0 && M::inputSize > 0, "fixed sizes");

  /// @param sensors one per output
  /// @throws std::invalid_argument, std::domain_error naming the violated rule of a parameter,
  ///   sensor or option
  OnlineLeastSquares(M map, const StateOf<M>& x0, std::vector<Parameter> parameters,
                     std::vector<ClippedSensor> sensors, OnlineOptions options = {});

  /// Sample k = 0, 1, …, one time step of the map after the other. NaN outputs were not measured.
  /// @throws std::domain_error if an input is not finite
  void add(const InputOf<M>& input, const OutputOf<M>& output);

  /// Updates the estimate to all samples so far. @throws std::domain_error without samples
  OnlineEstimate<M> update();

  std::size_t samples() const { return dropped_ + inputs_.size(); }

 private:
  using Unknowns = Vector<double, q>;  // θ, then x_s
  struct Linearised {
    double cost = 0;
    Unknowns gradient = Unknowns::Zero();
    Matrix<double, q, q> hessian = Matrix<double, q, q>::Zero();
    StateOf<M> x;
    Matrix<double, n, q> sensitivity;
  };

  bool isFree(int i) const {
    return i < p ? lower_[i] < upper_[i] : options_.window > 0 && startSd_[i - p] > 0;
  }
  Linearised linearise(const Unknowns& z) const;
  void addPriors(const Unknowns& z, Linearised& at) const;
  void slideWindow();

  M map_;
  std::vector<Parameter> parameters_;
  std::vector<ClippedSensor> sensors_;
  OnlineOptions options_;
  Vector<double, p> lower_, upper_;
  StateOf<M> startMean_, startSd_ = StateOf<M>::Zero();
  Unknowns z_;
  std::size_t dropped_ = 0;
  std::vector<InputOf<M>> inputs_;
  std::vector<OutputOf<M>> outputs_;
};

template <StepMap M>
OnlineLeastSquares<M>::OnlineLeastSquares(M map, const StateOf<M>& x0,
                                          std::vector<Parameter> parameters,
                                          std::vector<ClippedSensor> sensors, OnlineOptions options)
    : map_(std::move(map)),
      parameters_(std::move(parameters)),
      sensors_(std::move(sensors)),
      options_(std::move(options)),
      startMean_(x0) {
  checkParameters(parameters_);
  requireLength("parameters", static_cast<Eigen::Index>(parameters_.size()), p);
  requireLength("sensors", static_cast<Eigen::Index>(sensors_.size()), l);
  for (const ClippedSensor& sensor : sensors_) checkSensor(sensor);
  checkOnlineOptions(options_, n);
  for (int i = 0; i < p; ++i) {
    const Parameter& parameter = parameters_[std::size_t(i)];
    z_[i] = parameter.start;
    lower_[i] = parameter.lower;
    upper_[i] = parameter.upper;
  }
  z_.template tail<n>() = x0;
  if (options_.window > 0) startSd_ = options_.startSd;
  inputs_.reserve(options_.capacity);
  outputs_.reserve(options_.capacity);
}

template <StepMap M>
void OnlineLeastSquares<M>::add(const InputOf<M>& input, const OutputOf<M>& output) {
  if (!input.allFinite()) throw std::domain_error("on-line sample: the input is not finite");
  inputs_.push_back(input);
  outputs_.push_back(output);
}

// Moves the start of the window, with the state of the model at the present estimate.
template <StepMap M>
void OnlineLeastSquares<M>::slideWindow() {
  if (options_.window == 0 || inputs_.size() <= options_.window) return;
  const std::size_t shift = inputs_.size() - options_.window;
  StateOf<M> x = z_.template tail<n>();
  const ParametersOf<M> theta = z_.template head<p>();
  for (std::size_t k = 0; k < shift; ++k)
    x = info::solve(map_, x, inputs_[k], inputs_[k + 1], theta).x1;
  const auto count = static_cast<std::ptrdiff_t>(shift);
  inputs_.erase(inputs_.begin(), inputs_.begin() + count);
  outputs_.erase(outputs_.begin(), outputs_.begin() + count);
  dropped_ += shift;
  startMean_ = x;
  z_.template tail<n>() = x;
}

template <StepMap M>
typename OnlineLeastSquares<M>::Linearised OnlineLeastSquares<M>::linearise(
    const Unknowns& z) const {
  const ParametersOf<M> theta = z.template head<p>();
  Linearised at;
  at.x = z.template tail<n>();
  at.sensitivity.template leftCols<p>().setZero();
  at.sensitivity.template rightCols<n>().setIdentity();
  Vector<double, n + p> xTheta;
  for (std::size_t k = 0; k < inputs_.size(); ++k) {
    // y and its derivatives in the unknowns
    xTheta << at.x, theta;
    const auto g = differentiate(detail::outputOfStateAndParameters(map_, inputs_[k]), xTheta);
    Matrix<double, l, q> gamma = g.jacobian.template leftCols<n>() * at.sensitivity;
    gamma.template leftCols<p>() += g.jacobian.template rightCols<p>();
    for (int i = 0; i < l; ++i) {
      const double reading = outputs_[k][i];
      if (std::isnan(reading)) continue;
      const SampleCost c = sampleCost(sensors_[std::size_t(i)], reading, g.value[i]);
      at.cost += c.value;
      at.gradient += c.slope * gamma.row(i).transpose();
      at.hessian += c.curvature * gamma.row(i).transpose() * gamma.row(i);
    }
    if (k + 1 == inputs_.size()) break;
    const auto step = info::linearise(map_, at.x, inputs_[k], inputs_[k + 1], theta);
    if (!step.solution.converged) {
      at.cost = std::numeric_limits<double>::infinity();
      break;
    }
    at.x = step.solution.x1;
    at.sensitivity = (step.dx * at.sensitivity).eval();
    at.sensitivity.template leftCols<p>() += step.dtheta;
  }
  addPriors(z, at);
  return at;
}

template <StepMap M>
void OnlineLeastSquares<M>::addPriors(const Unknowns& z, Linearised& at) const {
  const auto add = [&](int i, double mean, double sd) {
    const double off = (z[i] - mean) / sd;
    at.cost += 0.5 * off * off;
    at.gradient[i] += off / sd;
    at.hessian(i, i) += 1 / (sd * sd);
  };
  for (int i = 0; i < p; ++i)
    if (const auto& prior = parameters_[std::size_t(i)].prior) add(i, prior->mean, prior->sd);
  for (int j = 0; j < n; ++j)
    if (isFree(p + j)) add(p + j, startMean_[j], startSd_[j]);
}

template <StepMap M>
OnlineEstimate<M> OnlineLeastSquares<M>::update() {
  if (inputs_.empty())
    throw std::domain_error("on-line estimate: number of samples is 0, must be ≥ 1");
  slideWindow();
  OnlineEstimate<M> out;
  Linearised at = linearise(z_);
  double lambda = 1e-3;
  std::array<bool, q> active{};
  while (true) {
    // the free unknowns: not fixed, and not at a bound with the descent direction pointing outwards
    for (int i = 0; i < q; ++i)
      active[std::size_t(i)] =
          isFree(i) && !(i < p && ((z_[i] <= lower_[i] && at.gradient[i] > 0) ||
                                   (z_[i] >= upper_[i] && at.gradient[i] < 0)));
    Matrix<double, q, q> H = at.hessian;
    Unknowns g = at.gradient;
    for (int i = 0; i < q; ++i) {
      if (active[std::size_t(i)] && H(i, i) > 0) continue;
      H.row(i).setZero();
      H.col(i).setZero();
      H(i, i) = 1;
      g[i] = 0;
    }
    const Unknowns whole = -H.ldlt().solve(g);
    if (-0.5 * g.dot(whole) <= options_.decrementTolerance) {
      out.why = Termination::decrementSmall;
      break;
    }
    if (out.iterations >= options_.maxIterations) break;
    bool moved = false;
    for (; lambda < 1e12 && !moved; lambda *= 4) {
      Matrix<double, q, q> damped = H;
      damped.diagonal() *= 1 + lambda;
      Unknowns trial = z_ - damped.ldlt().solve(g);
      trial.template head<p>() = trial.template head<p>().cwiseMax(lower_).cwiseMin(upper_);
      const Linearised next = linearise(trial);
      if (!(next.cost < at.cost)) continue;
      z_ = trial;
      at = next;
      moved = true;
    }
    if (!moved) {
      out.why = Termination::noDescent;
      break;
    }
    lambda = std::max(1e-9, lambda / 32);
    ++out.iterations;
  }
  out.converged = out.why == Termination::decrementSmall;
  out.parameters = z_.template head<p>();
  Matrix<double, q, q> H = at.hessian;
  for (int i = 0; i < q; ++i)
    if (!isFree(i) || !(H(i, i) > 0)) {
      H.row(i).setZero();
      H.col(i).setZero();
      H(i, i) = 1;
    }
  out.covariance = H.inverse().template topLeftCorner<p, p>();
  for (int i = 0; i < p; ++i)
    if (!(at.hessian(i, i) > 0)) out.covariance(i, i) = std::numeric_limits<double>::infinity();
  out.x = at.x;
  out.psi = at.sensitivity.template leftCols<p>();
  out.samples = samples();
  out.cost = at.cost;
  return out;
}

}  // namespace info
