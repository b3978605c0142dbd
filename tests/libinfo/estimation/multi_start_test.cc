#include "info/estimation/multi_start.h"

#include <gtest/gtest.h>

#include <cmath>

namespace info {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// y = (θ² − 1, 0.3 θ) against (0, −0.3): two valleys, the deeper one at θ = −1;
/// undefined beyond |θ| = 3.
Predictor twoValleys() {
  Predictor predictor;
  predictor.outputs = [](const VectorXd& theta) -> MatrixXd {
    const double x = theta[0];
    const double y = std::abs(x) > 3 ? std::nan("") : x * x - 1;
    return Eigen::RowVector2d(y, 0.3 * x);
  };
  predictor.withSensitivities = [outputs = predictor.outputs](const VectorXd& theta) {
    return Prediction{outputs(theta), Eigen::Vector2d(2 * theta[0], 0.3)};
  };
  return predictor;
}

LeastSquares problem(double start) {
  return {twoValleys(),
          {Eigen::RowVector2d(0, -0.3), OutputCovariance(MatrixXd::Constant(1, 1, 0.01))},
          {{.name = "x", .start = start, .lower = -5, .upper = 5}}};
}

TEST(MultiStart, FindsTheDeeperValleyThatOneStartMisses) {
  const LeastSquares least = problem(1.2);
  EXPECT_GT(estimate(least).parameters[0], 0);
  const MultiStart found = estimateFromStarts(least, VectorXd::Constant(1, 1.5), {.starts = 12});
  EXPECT_NEAR(found.best.parameters[0], -1, 1e-6);
  EXPECT_EQ(found.outcomes.size(), 12u);
  EXPECT_GT(found.agreeing, 1);
  EXPECT_LT(found.agreeing, 12);
  EXPECT_GT(found.outcomes[0].cost, found.best.cost + 1);
}

TEST(MultiStart, TellsOfStartsAtWhichTheModelIsUndefined) {
  const MultiStart found =
      estimateFromStarts(problem(2.5), VectorXd::Constant(1, 2), {.starts = 16});
  int undefined = 0;
  for (const StartOutcome& outcome : found.outcomes) {
    if (std::isfinite(outcome.cost)) continue;
    ++undefined;
    EXPECT_GT(std::abs(outcome.start[0]), 3);
    EXPECT_EQ(outcome.why, "estimate: the prediction at the start is not finite");
  }
  EXPECT_GT(undefined, 0);
  EXPECT_THROW(estimateFromStarts(problem(4), VectorXd::Zero(1), {.starts = 3}), std::domain_error);
}

TEST(MultiStart, StartsStayWithinTheBounds) {
  const MultiStart found =
      estimateFromStarts(problem(1), VectorXd::Constant(1, 1000), {.starts = 20});
  for (const StartOutcome& outcome : found.outcomes) EXPECT_LE(std::abs(outcome.start[0]), 5);
}

TEST(MultiStart, IsTheSameForAnyNumberOfThreads) {
  const auto run = [](int threads, int starts) {
    return estimateFromStarts(problem(1.2), VectorXd::Ones(1),
                              {.starts = starts, .seed = 5, .threads = threads});
  };
  const MultiStart a = run(1, 6), b = run(2, 6), c = run(2, 3);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(a.outcomes[i].parameters, b.outcomes[i].parameters);
  }
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(a.outcomes[i].start, c.outcomes[i].start);
}

TEST(MultiStart, RefusesOptionsOutOfRange) {
  const LeastSquares least = problem(1);
  EXPECT_THROW(estimateFromStarts(least, VectorXd::Ones(1), {.starts = 0}), std::invalid_argument);
  EXPECT_THROW(estimateFromStarts(least, VectorXd::Ones(2)), std::invalid_argument);
  EXPECT_THROW(estimateFromStarts(least, VectorXd::Constant(1, -1)), std::invalid_argument);
  EXPECT_THROW(estimateFromStarts(least, VectorXd::Ones(1), {.spread = 0}), std::invalid_argument);
}

}  // namespace
}  // namespace info
