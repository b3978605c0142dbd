#include "info/estimation/monte_carlo.h"

#include <gmock/gmock.h>

#include <atomic>
#include <cmath>
#include <cstring>

#include "support/closed_forms.h"

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using info::monteCarlo;
using info::MonteCarloOptions;

const info::OutputCovariance kTrialNoise(MatrixXd::Constant(1, 1, 1e-4));
const info::Predictor kModel =
    support::DampedOscillation{VectorXd::LinSpaced(50, 0.1, 5)}.predictor();
const VectorXd kTruth = (VectorXd(2) << 0.5, 3).finished();
const std::vector<info::Parameter> kParameters = {{.name = "c", .lower = 0}, {.name = "w"}};

bool sameBits(const MatrixXd& a, const MatrixXd& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), sizeof(double) * std::size_t(a.size())) == 0;
}

// With n trials a variance is known to √(2/(n−1)) of itself: four of these.
TEST(MonteCarlo, AttainsTheCramerRaoBoundAtLowNoise) {
  MonteCarloOptions options;
  options.trials = 1000;
  options.startSpread = 0.05;
  const auto result = monteCarlo(kModel, kTruth, kTrialNoise, kParameters, options);
  EXPECT_EQ(result.converged, 1000);
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(result.covariance(i, i) / result.bound(i, i), 1, 4 * std::sqrt(2.0 / 999));
    EXPECT_NEAR(result.mean[i], kTruth[i], 4 * std::sqrt(result.bound(i, i) / 1000));
  }
}

TEST(MonteCarlo, IsBitwiseTheSameForAnyNumberOfThreads) {
  MonteCarloOptions options;
  options.trials = 40;
  options.startSpread = 0.1;
  options.threads = 1;
  const auto alone = monteCarlo(kModel, kTruth, kTrialNoise, kParameters, options);
  for (int threads : {2, 5, 0}) {
    options.threads = threads;
    const auto together = monteCarlo(kModel, kTruth, kTrialNoise, kParameters, options);
    ASSERT_EQ(together.trials.size(), alone.trials.size());
    for (std::size_t i = 0; i < alone.trials.size(); ++i) {
      EXPECT_TRUE(sameBits(alone.trials[i].start, together.trials[i].start));
      EXPECT_TRUE(sameBits(alone.trials[i].parameters, together.trials[i].parameters));
    }
    EXPECT_TRUE(sameBits(alone.covariance, together.covariance));
  }
  // trial i does not depend on how many there are; another seed gives other trials
  options.trials = 3;
  EXPECT_TRUE(
      sameBits(monteCarlo(kModel, kTruth, kTrialNoise, kParameters, options).trials[2].parameters,
               alone.trials[2].parameters));
  options.seed = 2;
  EXPECT_FALSE(
      sameBits(monteCarlo(kModel, kTruth, kTrialNoise, kParameters, options).trials[2].parameters,
               alone.trials[2].parameters));
}

// Correlated outputs: the noise drawn has the covariance asked for, so that the bound is attained.
TEST(MonteCarlo, DrawsCorrelatedNoise) {
  info::Predictor pair;  // two outputs, θ and 2θ, of one sample
  pair.outputs = [](const VectorXd& theta) -> MatrixXd {
    return Eigen::Vector2d(theta[0], 2 * theta[0]);
  };
  pair.withSensitivities = [pair](const VectorXd& theta) {
    return info::Prediction{pair.outputs(theta), Eigen::Vector2d(1, 2)};
  };
  const MatrixXd sigma = (Eigen::Matrix2d() << 1, 1.5, 1.5, 4).finished();
  MonteCarloOptions options;
  options.trials = 2000;
  const auto result =
      monteCarlo(pair, VectorXd::Ones(1), info::OutputCovariance(sigma), {{.name = "a"}}, options);
  EXPECT_NEAR(result.bound(0, 0),
              1 / Eigen::Vector2d(1, 2).dot(sigma.inverse() * Eigen::Vector2d(1, 2)), 1e-14);
  EXPECT_NEAR(result.covariance(0, 0) / result.bound(0, 0), 1, 4 * std::sqrt(2.0 / 1999));
}

TEST(MonteCarlo, StartsWithinSpreadAndBounds) {
  MonteCarloOptions options;
  options.trials = 200;
  options.startSpread = 1;
  options.estimate.maxIterations = 0;
  std::vector<info::Parameter> parameters = kParameters;
  parameters[1].upper = 4;
  const auto result = monteCarlo(kModel, kTruth, kTrialNoise, parameters, options);
  double least = 9, most = 0;
  for (const auto& trial : result.trials) {
    EXPECT_LE(trial.start[1], 4);
    least = std::min(least, trial.start[0]);
    most = std::max(most, trial.start[0]);
  }
  EXPECT_GE(least, 0);
  EXPECT_LT(least, 0.05);
  EXPECT_GT(most, 0.95);
  EXPECT_LE(most, 1);
  EXPECT_EQ(result.converged, 0);
  EXPECT_TRUE(std::isnan(result.covariance(0, 0)));
}

TEST(MonteCarlo, TellsProgressOnceATrialAndStopsWhenTold) {
  MonteCarloOptions options;
  options.trials = 30;
  std::atomic<int> calls = 0;
  options.progress = [&](int done, int trials) {
    EXPECT_EQ(done, ++calls);
    EXPECT_EQ(trials, 30);
    return true;
  };
  EXPECT_TRUE(monteCarlo(kModel, kTruth, kTrialNoise, kParameters, options).complete);
  EXPECT_EQ(calls, 30);
  options.threads = 1;
  options.progress = [](int done, int) { return done < 4; };
  const auto stopped = monteCarlo(kModel, kTruth, kTrialNoise, kParameters, options);
  EXPECT_FALSE(stopped.complete);
  EXPECT_EQ(stopped.trials.size(), 4u);
}

TEST(MonteCarlo, RefusesWhatItCannotRun) {
  const auto refused = [](auto change) {
    MonteCarloOptions options;
    change(options);
    EXPECT_THROW(monteCarlo(kModel, kTruth, kTrialNoise, kParameters, options),
                 std::invalid_argument);
  };
  refused([](auto& o) { o.trials = 0; });
  refused([](auto& o) { o.threads = -1; });
  refused([](auto& o) { o.startSpread = -0.1; });
  refused([](auto& o) { o.startSpread = std::nan(""); });
  EXPECT_THROW(monteCarlo(kModel, VectorXd::Ones(3), kTrialNoise, kParameters),
               std::invalid_argument);
  EXPECT_THROW(monteCarlo(kModel, VectorXd::Constant(2, -1), kTrialNoise, kParameters),
               std::invalid_argument);
}

}  // namespace
