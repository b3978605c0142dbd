#include "info/estimation/kalman.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "info/estimation/estimate.h"
#include "info/information/symmetric_eigen.h"
#include "support/closed_forms.h"

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using info::Gaussian;
using info::LinearisedMap;
using info::NoisySystem;

// A linear system x_{k+1} = F x + v, y = H x + w.
NoisySystem linear(const MatrixXd& F, const MatrixXd& H, const MatrixXd& Q, const MatrixXd& R) {
  return {[F](Index, const VectorXd& x) {
            return LinearisedMap{F * x, F};
          },
          [H](Index, const VectorXd& x) {
            return LinearisedMap{H * x, H};
          },
          [Q](Index) { return Q; }, info::OutputCovariance(R)};
}
const MatrixXd kF = (Eigen::Matrix2d() << 1, 0.1, -0.3, 0.95).finished();
const MatrixXd kH = (MatrixXd(1, 2) << 1, 0.5).finished();
const MatrixXd kQ = (Eigen::Matrix2d() << 0.02, 0.005, 0.005, 0.03).finished();
const MatrixXd kR = MatrixXd::Constant(1, 1, 0.2);
const Gaussian kPrior{Eigen::Vector2d(1, -1), (Eigen::Matrix2d() << 2, 0.3, 0.3, 1).finished()};
const int kSamples = 12;
MatrixXd data() {
  MatrixXd y(1, kSamples);
  for (int k = 0; k < kSamples; ++k) y(0, k) = std::sin(0.9 * k) + 0.2 * k;
  return y;
}

// The joint distribution of (x_0 … x_N, y_0 … y_N) of the linear system, written out without
// recursion.
struct Joint {
  Gaussian x, y;
  MatrixXd xy;
};
Joint joint() {
  const Index n = 2 * kSamples;
  MatrixXd A = MatrixXd::Zero(n, n);  // x = A (x_0, v_0, …, v_{N−1})
  for (int k = 0; k < kSamples; ++k)
    for (int j = 0; j <= k; ++j) {
      MatrixXd power = Eigen::Matrix2d::Identity();
      for (int i = 0; i < k - j; ++i) power = (power * kF).eval();
      A.block(2 * k, 2 * j, 2, 2) = power;
    }
  MatrixXd sources = MatrixXd::Zero(n, n), H = MatrixXd::Zero(kSamples, n);
  for (int k = 0; k < kSamples; ++k) {
    sources.block(2 * k, 2 * k, 2, 2) = k == 0 ? kPrior.covariance : kQ;
    H.block(k, 2 * k, 1, 2) = kH;
  }
  VectorXd mean = VectorXd::Zero(n);
  mean.head(2) = kPrior.mean;
  Joint all;
  all.x = {A * mean, A * sources * A.transpose()};
  all.y = {H * all.x.mean,
           H * all.x.covariance * H.transpose() + 0.2 * MatrixXd::Identity(kSamples, kSamples)};
  all.xy = all.x.covariance * H.transpose();
  return all;
}

// Section 2.2.3: the recursion gives what (2.12), (2.13) give for all samples at once.
TEST(Kalman, FilterIsTheMinimumMeanSquareEstimateOfTheLastState) {
  const Joint all = joint();
  const auto filtered = info::extendedKalmanFilter(linear(kF, kH, kQ, kR), kPrior, data());
  const Gaussian batch = info::minimumMeanSquareEstimate(all.x, all.xy, all.y, data().transpose());
  const Gaussian& last = filtered.steps.back().filtered;
  EXPECT_LT((last.mean - batch.mean.tail(2)).norm(), 1e-12);
  EXPECT_LT((last.covariance - batch.covariance.bottomRightCorner(2, 2)).norm(), 1e-12);
}

TEST(Kalman, SmootherIsTheMinimumMeanSquareEstimateOfEveryState) {
  const Joint all = joint();
  const auto smoothed =
      info::smooth(info::extendedKalmanFilter(linear(kF, kH, kQ, kR), kPrior, data()));
  const Gaussian batch = info::minimumMeanSquareEstimate(all.x, all.xy, all.y, data().transpose());
  for (Index k = 0; k < kSamples; ++k) {
    EXPECT_LT((smoothed[std::size_t(k)].mean - batch.mean.segment(2 * k, 2)).norm(), 1e-12);
    EXPECT_LT(
        (smoothed[std::size_t(k)].covariance - batch.covariance.block(2 * k, 2 * k, 2, 2)).norm(),
        1e-12);
  }
}

TEST(Kalman, LikelihoodIsThatOfAllSamplesAtOnce) {
  const Joint all = joint();
  const VectorXd r = data().transpose() - all.y.mean;
  const double expected =
      -0.5 * (r.dot(all.y.covariance.ldlt().solve(r)) + std::log(all.y.covariance.determinant()) +
              kSamples * std::log(2 * std::numbers::pi));
  EXPECT_NEAR(info::extendedKalmanFilter(linear(kF, kH, kQ, kR), kPrior, data()).logLikelihood,
              expected, 1e-11);
}

// Section 2.2.3, the other way round: parameters as static states. One sample after another, the
// filter reaches what batch least squares with the prior reaches, in mean and covariance.
TEST(Kalman, RecursionOverStaticStatesIsBatchLeastSquares) {
  const VectorXd t = VectorXd::LinSpaced(kSamples, 0, 2);
  MatrixXd rows(kSamples, 2);
  rows << VectorXd::Ones(kSamples), t;
  NoisySystem still = linear(Eigen::Matrix2d::Identity(), kH, MatrixXd::Zero(2, 2), kR);
  still.output = [rows](Index k, const VectorXd& x) {
    return LinearisedMap{rows.row(k) * x, rows.row(k)};
  };
  const Gaussian prior{Eigen::Vector2d(0.5, 0), Eigen::Vector2d(4, 9).asDiagonal()};
  const auto filtered = info::extendedKalmanFilter(still, prior, data());

  std::vector<info::Parameter> parameters = {
      {.name = "a", .start = 0.5, .prior = info::GaussianPrior{0.5, 2}},
      {.name = "b", .start = 0, .prior = info::GaussianPrior{0, 3}}};
  info::EstimateOptions options;
  options.method = info::Method::iteratedLeastSquares;
  const auto batch =
      info::estimate(info::LeastSquares(support::straightLine(t),
                                        {data(), info::OutputCovariance(kR)}, parameters),
                     options);
  EXPECT_EQ(batch.iterations, 1);
  EXPECT_LT((filtered.steps.back().filtered.mean - batch.parameters).norm(), 1e-12);
  EXPECT_LT((filtered.steps.back().filtered.covariance - batch.covariance).norm(), 1e-12);
  // a static state is smoothed to the same value at every time
  for (const Gaussian& state : info::smooth(filtered))
    EXPECT_LT((state.mean - batch.parameters).norm(), 1e-9);
}

// Section 2.2.2, (2.14): with a prior of unit covariance in the units of the noise and one weak
// sample, the estimate moves along ΓᵀΣ⁻¹(ỹ − y), the gradient step of least squares.
TEST(Kalman, WeakSampleMovesTheEstimateAlongTheLeastSquaresGradient) {
  const MatrixXd gamma = (MatrixXd(1, 2) << 3, -1).finished();
  const Gaussian theta{Eigen::Vector2d(0.2, 0.7), MatrixXd::Identity(2, 2)};
  const double y = 1.9, sigma = 1e8;
  const Gaussian predicted{gamma * theta.mean,
                           gamma * gamma.transpose() + MatrixXd::Constant(1, 1, sigma)};
  const auto moved = info::minimumMeanSquareEstimate(theta, gamma.transpose(), predicted,
                                                     VectorXd::Constant(1, y));
  const VectorXd step = gamma.transpose() / sigma * (y - (gamma * theta.mean)[0]);
  EXPECT_LT((moved.mean - theta.mean - step).norm(), 1e-6 * step.norm());
}

TEST(Kalman, PredictsAcrossGaps) {
  info::ObservationMask observed = info::ObservationMask::Constant(1, kSamples, true);
  observed(0, 5) = false;
  MatrixXd y = data();
  y(0, 5) = std::nan("");
  const auto filtered = info::extendedKalmanFilter(linear(kF, kH, kQ, kR), kPrior, y, observed);
  EXPECT_EQ(filtered.steps[5].innovation.size(), 0);
  EXPECT_EQ(filtered.steps[5].filtered.mean, filtered.steps[5].predicted.mean);
  // the same as a sample with hardly any weight
  auto weak = linear(kF, kH, kQ, kR);
  std::vector<MatrixXd> noise(kSamples, kR);
  noise[5] *= 1e14;
  weak.outputNoise = info::OutputCovariance::perSample(noise);
  y(0, 5) = 0;
  const auto other = info::extendedKalmanFilter(weak, kPrior, y);
  EXPECT_LT((other.steps.back().filtered.mean - filtered.steps.back().filtered.mean).norm(), 1e-9);
}

// Nearly exact measurements of a nearly known state: the short form P − KSKᵀ loses positivity here.
TEST(Kalman, KeepsCovariancesPositiveUnderRounding) {
  Gaussian state{VectorXd::Zero(2), (Eigen::Matrix2d() << 1e8, 0, 0, 1).finished()};
  const MatrixXd R = MatrixXd::Constant(1, 1, 1e-10);
  for (int k = 0; k < 40; ++k) {
    const MatrixXd H = (MatrixXd(1, 2) << 1, 1e-4 * (k % 3)).finished();
    state = info::updateWithMeasurement(state, {H * state.mean, H}, VectorXd::Zero(1), R).filtered;
    EXPECT_GE(info::symmetricEigenvalues(state.covariance)[0], 0);
  }
}

// x_{k+1} = x_k − Δt·θ·x_k³ with θ unknown, exact data: the extended filter learns θ.
TEST(Kalman, ExtendedFilterLearnsAParameterOfANonlinearSystem) {
  const double dt = 0.05, theta = 1.7;
  const auto step = [dt](Index, const VectorXd& z) {
    const double x = z[0];
    LinearisedMap map{Eigen::Vector2d(x - dt * z[1] * x * x * x, z[1]),
                      Eigen::Matrix2d::Identity()};
    map.jacobian(0, 0) = 1 - 3 * dt * z[1] * x * x;
    map.jacobian(0, 1) = -dt * x * x * x;
    return map;
  };
  const MatrixXd H = (MatrixXd(1, 2) << 1, 0).finished();
  NoisySystem system = linear(kF, H, MatrixXd::Zero(2, 2), MatrixXd::Constant(1, 1, 1e-6));
  system.step = step;
  MatrixXd y(1, 80);
  VectorXd z = Eigen::Vector2d(2, theta);
  for (Index k = 0; k < 80; ++k, z = step(0, z).value) y(0, k) = z[0];
  const auto result = info::extendedKalmanFilter(
      system, {Eigen::Vector2d(2, 1.2), Eigen::Vector2d(1e-6, 1).asDiagonal()}, y);
  EXPECT_NEAR(result.steps.back().filtered.mean[1], theta, 0.01);
  EXPECT_LT(std::sqrt(result.steps.back().filtered.covariance(1, 1)), 0.01);
}

TEST(Kalman, RefusesWhatDoesNotFit) {
  const auto good = linear(kF, kH, kQ, kR);
  MatrixXd y = data();
  y(0, 3) = std::nan("");
  EXPECT_THROW(info::extendedKalmanFilter(good, kPrior, y), std::domain_error);
  EXPECT_THROW(info::extendedKalmanFilter(good, kPrior, MatrixXd::Zero(2, 3)),
               std::invalid_argument);
  EXPECT_THROW(info::extendedKalmanFilter(good, {kPrior.mean, -kPrior.covariance}, data()),
               std::domain_error);
  EXPECT_THROW(info::extendedKalmanFilter(good, {VectorXd::Zero(3), kPrior.covariance}, data()),
               std::invalid_argument);
  auto wide = good;
  wide.output = [](Index, const VectorXd& x) { return LinearisedMap{x, MatrixXd::Identity(2, 2)}; };
  EXPECT_THROW(info::extendedKalmanFilter(wide, kPrior, data()), std::invalid_argument);
  EXPECT_THROW(
      info::minimumMeanSquareEstimate(kPrior, MatrixXd::Zero(2, 1), kPrior, VectorXd::Zero(2)),
      std::invalid_argument);
  EXPECT_THROW(
      info::minimumMeanSquareEstimate(kPrior, MatrixXd::Zero(2, 2),
                                      {VectorXd::Zero(2), MatrixXd::Zero(2, 2)}, VectorXd::Zero(2)),
      std::domain_error);
}

}  // namespace
