#include "info/estimation/least_squares.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace info {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

LeastSquares::LeastSquares(Predictor predictor, Measurements measurements,
                           std::vector<Parameter> parameters)
    : predictor_(std::move(predictor)),
      measurements_(std::move(measurements)),
      parameters_(std::move(parameters)) {
  checkParameters(parameters_);
  if (parameters_.empty())
    throw std::invalid_argument("least squares: must have at least one parameter to estimate");
  if (!predictor_.outputs || !predictor_.withSensitivities)
    throw std::invalid_argument("least squares: the predictor must give outputs and sensitivities");
  const MatrixXd& data = measurements_.outputs;
  const OutputCovariance& covariance = measurements_.covariance;
  const ObservationMask& observed = measurements_.observed;
  if (data.cols() == 0 || data.rows() != covariance.outputs())
    throw std::invalid_argument(
        fmt::format("measurements: {} outputs × {} samples, must have {} outputs as the covariance "
                    "and at least one sample",
                    data.rows(), data.cols(), covariance.outputs()));
  if (observed.size() != 0 && (observed.rows() != data.rows() || observed.cols() != data.cols()))
    throw std::invalid_argument(fmt::format("measurements: observed is {} × {}, must be {} × {}",
                                            observed.rows(), observed.cols(), data.rows(),
                                            data.cols()));
  for (Index k = 0; k < data.cols(); ++k)
    for (Index i = 0; i < data.rows(); ++i)
      if ((observed.size() == 0 || observed(i, k)) && !std::isfinite(data(i, k)))
        throw std::domain_error(
            fmt::format("measurements: output {} of sample {} is {}, must be finite (mark a "
                        "missing one as not observed)",
                        i, k, data(i, k)));
}

VectorXd LeastSquares::start() const {
  VectorXd theta(static_cast<Index>(parameters_.size()));
  for (Index i = 0; i < theta.size(); ++i)
    theta[i] = parameters_[static_cast<std::size_t>(i)].start;
  return theta;
}

Index LeastSquares::observations() const {
  return measurements_.observed.size() == 0 ? measurements_.outputs.size()
                                            : measurements_.observed.count();
}

MatrixXd LeastSquares::residuals(const MatrixXd& outputs) const {
  if (outputs.rows() != measurements_.outputs.rows() ||
      outputs.cols() != measurements_.outputs.cols())
    throw std::invalid_argument(
        fmt::format("prediction is {} × {}, must be {} × {} as the measurements", outputs.rows(),
                    outputs.cols(), measurements_.outputs.rows(), measurements_.outputs.cols()));
  if (measurements_.observed.size() == 0) return measurements_.outputs - outputs;
  return measurements_.observed.select(measurements_.outputs - outputs,
                                       MatrixXd::Zero(outputs.rows(), outputs.cols()));
}

void LeastSquares::requireSize(const VectorXd& theta) const {
  if (theta.size() != static_cast<Index>(parameters_.size()))
    throw std::invalid_argument(fmt::format("least squares: {} parameter values for {} parameters",
                                            theta.size(), parameters_.size()));
}

double LeastSquares::cost(const VectorXd& theta) const {
  requireSize(theta);
  const MatrixXd r = residuals(predictor_.outputs(theta));
  const MatrixXd white = measurements_.covariance.whiten(r.reshaped(), measurements_.observed);
  double cost = 0;
  for (Index k = 0; k < r.cols(); ++k) {
    const double squared = white.middleRows(k * r.rows(), r.rows()).squaredNorm();
    cost += 0.5 * evaluate(measurements_.loss, squared, r.rows()).value;
  }
  for (Index i = 0; i < theta.size(); ++i)
    if (const auto& prior = parameters_[static_cast<std::size_t>(i)].prior)
      cost += 0.5 * std::pow((theta[i] - prior->mean) / prior->sd, 2);
  return std::isfinite(cost) ? cost : std::numeric_limits<double>::infinity();
}

LeastSquares::Linearised LeastSquares::linearise(const VectorXd& theta) const {
  requireSize(theta);
  const Index p = theta.size();
  const Prediction prediction = predictor_.withSensitivities(theta);
  Linearised at;
  at.residuals = residuals(prediction.outputs);
  if (prediction.gamma.rows() != at.residuals.size() || prediction.gamma.cols() != p)
    throw std::invalid_argument(fmt::format("sensitivities are {} × {}, must be {} × {} parameters",
                                            prediction.gamma.rows(), prediction.gamma.cols(),
                                            at.residuals.size(), p));
  const OutputCovariance& covariance = measurements_.covariance;
  MatrixXd r = covariance.whiten(at.residuals.reshaped(), measurements_.observed);
  MatrixXd gamma = covariance.whiten(prediction.gamma, measurements_.observed);
  at.cost = 0;
  const Index h = at.residuals.rows();
  for (Index k = 0; k < at.residuals.cols(); ++k) {
    const LossValue loss = evaluate(measurements_.loss, r.middleRows(k * h, h).squaredNorm(), h);
    at.cost += 0.5 * loss.value;
    if (loss.slope == 1) continue;
    const double root = std::sqrt(loss.slope);
    r.middleRows(k * h, h) *= root;
    gamma.middleRows(k * h, h) *= root;
  }
  at.gradient = -gamma.transpose() * r;
  at.information = gamma.transpose() * gamma;
  for (Index i = 0; i < p; ++i)
    if (const auto& prior = parameters_[static_cast<std::size_t>(i)].prior) {
      const double weight = 1 / (prior->sd * prior->sd);
      at.cost += 0.5 * weight * std::pow(theta[i] - prior->mean, 2);
      at.gradient[i] += weight * (theta[i] - prior->mean);
      at.information(i, i) += weight;
    }
  if (!std::isfinite(at.cost) || !at.gradient.allFinite() || !at.information.allFinite())
    at.cost = std::numeric_limits<double>::infinity();
  return at;
}

MatrixXd LeastSquares::hessian(const VectorXd& theta, const Linearised& at) const {
  if (!hasCurvature())
    throw std::logic_error(
        "least squares: second derivatives require a predictor that has them and no robust loss");
  // w_k = Σ_k⁻¹ r_k, by whitening the identity: Σ⁻¹ = L⁻ᵀL⁻¹ of what was observed
  const Index h = at.residuals.rows();
  MatrixXd w(h, at.residuals.cols());
  const OutputCovariance& covariance = measurements_.covariance;
  const ObservationMask& observed = measurements_.observed;
  const MatrixXd roots =
      covariance.whiten(MatrixXd::Identity(h, h).replicate(w.cols(), 1), observed);
  const MatrixXd r = covariance.whiten(at.residuals.reshaped(), observed);
  for (Index k = 0; k < w.cols(); ++k)
    w.col(k) = roots.middleRows(k * h, h).transpose() * r.middleRows(k * h, h);
  const MatrixXd curvature = predictor_.contractedCurvature(theta, w);
  return at.information - 0.5 * (curvature + curvature.transpose());
}

}  // namespace info
