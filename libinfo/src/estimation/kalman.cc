#include "info/estimation/kalman.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "info/information/symmetric_eigen.h"

namespace info {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd symmetric(const MatrixXd& matrix) {
  return 0.5 * (matrix + matrix.transpose());
}

void require(bool fits, const char* what) {
  if (!fits) throw std::invalid_argument(fmt::format("Kalman filter: {}", what));
}

void requireCovariance(const MatrixXd& covariance, Index size, const char* what) {
  require(covariance.rows() == size && covariance.cols() == size, what);
  const double largest = covariance.cwiseAbs().maxCoeff();
  const bool isSymmetric =
      (covariance - covariance.transpose()).cwiseAbs().maxCoeff() <= 1e-9 * largest;
  if (!covariance.allFinite() || !isSymmetric ||
      !(symmetricEigenvalues(covariance)[0] >= -1e-12 * largest))
    throw std::domain_error(
        fmt::format("Kalman filter: {} must be symmetric and positive semidefinite", what));
}

}  // namespace

Gaussian minimumMeanSquareEstimate(const Gaussian& x, const MatrixXd& covariance_xy,
                                   const Gaussian& y, const VectorXd& measured) {
  require(covariance_xy.rows() == x.mean.size() && covariance_xy.cols() == y.mean.size() &&
              measured.size() == y.mean.size() && y.covariance.rows() == y.mean.size() &&
              x.covariance.rows() == x.mean.size() && x.covariance.cols() == x.mean.size(),
          "sizes of x, y and their covariances must fit");
  // Σ_y = LLᵀ: with A = L⁻¹Σ_yx the reduction is AᵀA
  const OutputCovariance covariance_y(y.covariance);
  const MatrixXd a = covariance_y.whiten(covariance_xy.transpose());
  return {x.mean + a.transpose() * covariance_y.whiten(measured - y.mean),
          symmetric(x.covariance - a.transpose() * a)};
}

FilterStep updateWithMeasurement(const Gaussian& predicted, const LinearisedMap& output,
                                 const VectorXd& measured, const MatrixXd& noise) {
  const Index n = predicted.mean.size(), h = measured.size();
  const MatrixXd& H = output.jacobian;
  const MatrixXd& P = predicted.covariance;
  require(H.rows() == h && H.cols() == n && output.value.size() == h && noise.rows() == h &&
              noise.cols() == h && P.rows() == n && P.cols() == n,
          "sizes of state, output, Jacobian and noise must fit");
  FilterStep step{predicted, predicted, {}, measured - output.value, {}};
  step.innovationCovariance = symmetric(H * P * H.transpose() + noise);
  const MatrixXd gain = step.innovationCovariance.ldlt().solve(H * P).transpose();
  const MatrixXd left = MatrixXd::Identity(n, n) - gain * H;
  step.filtered.mean += gain * step.innovation;
  step.filtered.covariance =
      symmetric(left * P * left.transpose() + gain * noise * gain.transpose());
  return step;
}

FilterResult extendedKalmanFilter(const NoisySystem& system, const Gaussian& prior,
                                  const MatrixXd& outputs, const ObservationMask& observed) {
  const Index n = prior.mean.size(), h = outputs.rows();
  requireCovariance(prior.covariance, n, "covariance of the prior");
  require(system.outputNoise.outputs() == h,
          "output noise and measurements must have as many outputs");
  require(system.outputNoise.isConstant() || system.outputNoise.samples() == outputs.cols(),
          "output noise must be given for every sample");
  require(observed.size() == 0 || (observed.rows() == h && observed.cols() == outputs.cols()),
          "observed must be outputs × samples");
  FilterResult result;
  Gaussian next = prior;
  MatrixXd transition;
  for (Index k = 0; k < outputs.cols(); ++k) {
    // the outputs that are there
    std::vector<Index> there;
    for (Index i = 0; i < h; ++i)
      if (observed.size() == 0 || observed(i, k)) {
        if (!std::isfinite(outputs(i, k)))
          throw std::domain_error(fmt::format(
              "Kalman filter: output {} of sample {} is {}, must be finite", i, k, outputs(i, k)));
        there.push_back(i);
      }
    const LinearisedMap output = system.output(k, next.mean);
    require(output.value.size() == h && output.jacobian.rows() == h && output.jacobian.cols() == n,
            "output and its Jacobian must fit state and measurements");
    FilterStep step =
        updateWithMeasurement(next, {output.value(there), output.jacobian(there, Eigen::all)},
                              outputs(there, k), system.outputNoise.at(k)(there, there));
    step.transition = transition;
    if (!there.empty()) {
      const Eigen::LDLT<MatrixXd> factor(step.innovationCovariance);
      result.logLikelihood -=
          0.5 * (step.innovation.dot(factor.solve(step.innovation)) +
                 factor.vectorD().array().log().sum() +
                 static_cast<double>(there.size()) * std::log(2 * std::numbers::pi));
    }
    result.steps.push_back(step);

    // on to the next sample
    if (k + 1 == outputs.cols()) break;
    const LinearisedMap moved = system.step(k, step.filtered.mean);
    const MatrixXd noise = system.processNoise(k);
    require(moved.value.size() == n && moved.jacobian.rows() == n && moved.jacobian.cols() == n &&
                noise.rows() == n && noise.cols() == n,
            "step, its Jacobian and the process noise must fit the state");
    transition = moved.jacobian;
    next = {moved.value,
            symmetric(transition * step.filtered.covariance * transition.transpose() + noise)};
  }
  return result;
}

std::vector<Gaussian> smooth(const FilterResult& filtered) {
  std::vector<Gaussian> smoothed(filtered.steps.size());
  if (smoothed.empty()) return smoothed;
  smoothed.back() = filtered.steps.back().filtered;
  for (std::size_t k = smoothed.size() - 1; k-- > 0;) {
    const Gaussian& here = filtered.steps[k].filtered;
    const FilterStep& after = filtered.steps[k + 1];
    const MatrixXd gain = after.predicted.covariance.completeOrthogonalDecomposition()
                              .solve(after.transition * here.covariance)
                              .transpose();
    smoothed[k].mean = here.mean + gain * (smoothed[k + 1].mean - after.predicted.mean);
    smoothed[k].covariance = symmetric(
        here.covariance +
        gain * (smoothed[k + 1].covariance - after.predicted.covariance) * gain.transpose());
  }
  return smoothed;
}

}  // namespace info
