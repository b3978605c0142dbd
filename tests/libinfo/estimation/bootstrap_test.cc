#include "info/estimation/bootstrap.h"

#include <gtest/gtest.h>

#include <cmath>

#include "info/probability/random_stream.h"
#include "support/closed_forms.h"

namespace info {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

const VectorXd kTimes = VectorXd::LinSpaced(400, -1, 1);

/// 1 + 2t with noise of memory `memory`.
MatrixXd data(double memory, double sd = 0.1) {
  RandomStream random(11, 0);
  MatrixXd y(1, kTimes.size());
  double noise = random.normal();
  for (Index k = 0; k < kTimes.size(); ++k) {
    noise = memory * noise + std::sqrt(1 - memory * memory) * random.normal();
    y(0, k) = 1 + 2 * kTimes[k] + sd * noise;
  }
  return y;
}

LeastSquares line(const MatrixXd& y, std::optional<GaussianPrior> prior = {}) {
  return {support::straightLine(kTimes),
          {y, OutputCovariance(MatrixXd::Constant(1, 1, 0.01))},
          {{.name = "a", .prior = prior}, {.name = "b"}}};
}

TEST(Bootstrap, SpreadsAsTheBoundSaysOnWhiteNoise) {
  const LeastSquares problem = line(data(0));
  const Estimate best = estimate(problem);
  const BootstrapResult spread = bootstrap(problem, best, {}, {.replicates = 800});
  EXPECT_EQ(spread.converged, 800);
  for (Index i = 0; i < 2; ++i) {
    const double bound = std::sqrt(best.covariance(i, i));
    EXPECT_NEAR(spread.sd[i] / bound, 1, 0.12);
    EXPECT_NEAR(spread.intervals(i, 0), best.parameters[i] - 1.96 * bound, 0.35 * bound);
    EXPECT_NEAR(spread.intervals(i, 1), best.parameters[i] + 1.96 * bound, 0.35 * bound);
  }
}

// A memory of 0.9 makes 19 samples one: the mean spreads √19 times more, and single samples drawn
// anew know nothing of it.
TEST(Bootstrap, BlocksKeepTheCorrelation) {
  const LeastSquares problem = line(data(0.9));
  const Estimate best = estimate(problem);
  const double white = bootstrap(problem, best, {}, {.replicates = 400}).sd[0];
  const double blocks = bootstrap(problem, best, {}, {.replicates = 400, .blockLength = 40}).sd[0];
  EXPECT_NEAR(white, 0.1 / std::sqrt(400.0), 0.002);
  EXPECT_GT(blocks, 2.5 * white);
  EXPECT_LT(blocks, 6 * white);
}

// Without information in the data the spread is the prior's.
TEST(Bootstrap, DrawsPriorsAnew) {
  const LeastSquares problem = line(data(0), GaussianPrior{1, 1e-4});
  const BootstrapResult spread = bootstrap(problem, estimate(problem), {}, {.replicates = 600});
  EXPECT_NEAR(spread.sd[0], 1e-4, 1e-5);
}

TEST(Bootstrap, IsTheSameForAnyNumberOfThreads) {
  const LeastSquares problem = line(data(0.5));
  const Estimate best = estimate(problem);
  const auto one = bootstrap(problem, best, {150, 250}, {.replicates = 30, .threads = 1});
  const auto two = bootstrap(problem, best, {150, 250}, {.replicates = 30, .threads = 2});
  EXPECT_EQ(one.parameters, two.parameters);
}

TEST(Bootstrap, StopsWhenToldTo) {
  const LeastSquares problem = line(data(0));
  const auto stopped = bootstrap(
      problem, estimate(problem), {},
      {.replicates = 500, .threads = 1, .progress = [](int done, int) { return done < 5; }});
  EXPECT_FALSE(stopped.complete);
  EXPECT_EQ(stopped.converged, 5);
}

TEST(Bootstrap, RefusesWhatDoesNotAddUp) {
  const LeastSquares problem = line(data(0));
  const Estimate best = estimate(problem);
  EXPECT_THROW(bootstrap(problem, best, {100, 200}), std::invalid_argument);
  EXPECT_THROW(bootstrap(problem, best, {}, {.replicates = 1}), std::invalid_argument);
  EXPECT_THROW(bootstrap(problem, best, {}, {.blockLength = 0}), std::invalid_argument);
}

}  // namespace
}  // namespace info
