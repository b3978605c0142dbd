#include "info/estimation/profile_likelihood.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/closed_forms.h"

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

const info::OutputCovariance kLineNoise(MatrixXd::Constant(1, 1, 0.01));

// A linear model's profile is the parabola of its marginal variance, and meets the threshold where
// the Cramér–Rao interval ends (to the 2e-7 at which estimation stops).
TEST(ProfileLikelihood, OfALinearModelIsTheParabolaOfTheBound) {
  const VectorXd t = VectorXd::LinSpaced(9, 0, 2);
  const MatrixXd data = (1 + 2 * t.array() + 0.1 * (7 * t.array()).sin()).matrix().transpose();
  const info::LeastSquares problem(support::straightLine(t), {data, kLineNoise},
                                   {{.name = "a"}, {.name = "b"}});
  const auto best = info::estimate(problem);
  const double centre = best.parameters[1];
  const auto profile = info::profileLikelihood(
      problem, best, 1,
      {best.intervals(1, 0), centre - 0.01, centre, centre + 0.3, best.intervals(1, 1)});
  for (const auto& point : profile.points) {
    EXPECT_TRUE(point.converged);
    EXPECT_NEAR(point.cost,
                best.cost + 0.5 * std::pow(point.value - centre, 2) / best.covariance(1, 1), 1e-6);
    EXPECT_EQ(point.parameters[1], point.value);
  }
  EXPECT_NEAR(profile.points.front().cost, profile.threshold, 1e-6);
  EXPECT_NEAR(profile.points.back().cost, profile.threshold, 1e-6);
}

TEST(ProfileLikelihood, IsFlatAlongAValley) {
  info::Predictor sum;
  sum.outputs = [](const VectorXd& theta) -> MatrixXd {
    return MatrixXd::Constant(1, 3, theta.sum());
  };
  sum.withSensitivities = [sum](const VectorXd& theta) {
    return info::Prediction{sum.outputs(theta), MatrixXd::Ones(3, 2)};
  };
  const info::LeastSquares problem(sum, {MatrixXd::Constant(1, 3, 5.0), kLineNoise},
                                   {{.name = "a", .start = 1}, {.name = "b", .start = 2}});
  const auto profile = info::profileLikelihood(problem, info::estimate(problem), 0, {-50, 0, 50});
  for (const auto& point : profile.points) EXPECT_LT(point.cost, profile.threshold);
}

TEST(ProfileLikelihood, RefusesWhatIsNoParameterOrOutOfBounds) {
  const VectorXd t = VectorXd::LinSpaced(9, 0, 2);
  const info::LeastSquares problem(support::straightLine(t), {t.transpose(), kLineNoise},
                                   {{.name = "a", .lower = -1}, {.name = "b"}});
  const auto best = info::estimate(problem);
  EXPECT_THROW(info::profileLikelihood(problem, best, 2, {0}), std::invalid_argument);
  EXPECT_THROW(info::profileLikelihood(problem, best, 0, {-2}), std::invalid_argument);
  EXPECT_THROW(info::profileLikelihood(problem, best, 0, {std::nan("")}), std::invalid_argument);
}

TEST(ProfileInterval, OfALinearModelIsTheCramerRaoInterval) {
  const VectorXd t = VectorXd::LinSpaced(9, 0, 2);
  const MatrixXd data = (1 + 2 * t.array() + 0.1 * (7 * t.array()).sin()).matrix().transpose();
  const info::LeastSquares problem(support::straightLine(t), {data, kLineNoise},
                                   {{.name = "a"}, {.name = "b"}});
  const auto best = info::estimate(problem);
  const double sd = std::sqrt(best.covariance(1, 1));
  for (const double tried : {0.3 * sd, sd, 2.5 * sd}) {
    const auto interval = info::profileInterval(problem, best, 1, tried);
    EXPECT_NEAR(interval.lower, best.intervals(1, 0), 0.02 * sd);
    EXPECT_NEAR(interval.upper, best.intervals(1, 1), 0.02 * sd);
  }
}

// y = e^θ: the profile interval is that of y, carried over; the Cramér–Rao one is symmetric.
TEST(ProfileInterval, IsSkewWhereTheModelIs) {
  info::Predictor exponential;
  exponential.outputs = [](const VectorXd& theta) -> MatrixXd {
    return MatrixXd::Constant(1, 1, std::exp(theta[0]));
  };
  exponential.withSensitivities = [exponential](const VectorXd& theta) {
    return info::Prediction{exponential.outputs(theta), exponential.outputs(theta)};
  };
  const info::LeastSquares problem(exponential, {MatrixXd::Constant(1, 1, 0.5), kLineNoise},
                                   {{.name = "a"}});
  const auto best = info::estimate(problem);
  const auto interval = info::profileInterval(problem, best, 0, 0.2);
  EXPECT_NEAR(interval.lower, std::log(0.5 - 0.195996), 0.004);
  EXPECT_NEAR(interval.upper, std::log(0.5 + 0.195996), 0.004);
}

/// y = a + b·max(0, a); no value below `end`.
info::Predictor endingAt(double end) {
  info::Predictor model;
  model.outputs = [end](const VectorXd& theta) -> MatrixXd {
    const double y = theta[0] + theta[1] * std::max(0.0, theta[0]);
    return MatrixXd::Constant(1, 1, theta[0] < end ? std::nan("") : y);
  };
  model.withSensitivities = [model](const VectorXd& theta) {
    const bool rises = theta[0] > 0;
    return info::Prediction{model.outputs(theta),
                            Eigen::RowVector2d(1 + (rises ? theta[1] : 0), rises ? theta[0] : 0)};
  };
  model.whyUndefined = [end](const VectorXd& theta) -> std::string {
    return theta[0] < end ? "a is too small" : "";
  };
  return model;
}

TEST(ProfileInterval, EndsWhereTheModelEnds) {
  const info::LeastSquares problem(
      endingAt(0.93), {MatrixXd::Constant(1, 1, 1.0), kLineNoise},
      {{.name = "a", .start = 1}, {.name = "b", .lower = 0, .upper = 0}});
  const auto best = info::estimate(problem);
  const double sd = std::sqrt(best.covariance(0, 0));
  const auto interval = info::profileInterval(problem, best, 0, sd);
  EXPECT_NEAR(interval.lower, 0.93, 0.02 * sd);
  EXPECT_NEAR(interval.upper, best.intervals(0, 1), 0.02 * sd);
  EXPECT_FALSE(interval.lowerAtBound);
  for (const info::ProfilePoint& point : interval.profile.points)
    EXPECT_EQ(std::isinf(point.cost), point.value < 0.93) << point.value;
}

// At a = 0 the other parameter has no effect: it stays, and the profile goes on.
TEST(ProfileLikelihood, GoesOnWhereAnotherParameterLosesItsEffect) {
  const info::LeastSquares problem(endingAt(-9), {MatrixXd::Constant(1, 1, 1.0), kLineNoise},
                                   {{.name = "a", .start = 0.5}, {.name = "b", .start = 0.5}});
  const auto best = info::estimate(problem);
  const auto profile = info::profileLikelihood(problem, best, 0, {-1, 0.4});
  EXPECT_NEAR(profile.points[0].cost, 0.5 * std::pow(2 / 0.1, 2), 1e-9);
  EXPECT_NEAR(profile.points[1].cost, 0, 1e-9);
}

TEST(Estimate, SaysWhyThePredictionAtTheStartIsNotFinite) {
  const info::LeastSquares problem(
      endingAt(2), {MatrixXd::Constant(1, 1, 1.0), kLineNoise},
      {{.name = "a", .start = 1}, {.name = "b", .lower = 0, .upper = 0}});
  try {
    info::estimate(problem);
    FAIL() << "must throw";
  } catch (const std::domain_error& error) {
    EXPECT_STREQ(error.what(),
                 "estimate: the prediction at the start is not finite: a is too small");
  }
  EXPECT_FALSE(info::estimateIfDefined(problem, problem.start(), {}));
}

TEST(ProfileInterval, SaysWhereItIsOpenAndWhereABoundEndsIt) {
  info::Predictor sum;
  sum.outputs = [](const VectorXd& theta) -> MatrixXd {
    return MatrixXd::Constant(1, 3, theta.sum());
  };
  sum.withSensitivities = [sum](const VectorXd& theta) {
    return info::Prediction{sum.outputs(theta), MatrixXd::Ones(3, 2)};
  };
  const info::LeastSquares problem(
      sum, {MatrixXd::Constant(1, 3, 5.0), kLineNoise},
      {{.name = "a", .start = 1, .lower = -2}, {.name = "b", .start = 2}});
  const auto interval = info::profileInterval(problem, info::estimate(problem), 0, 1);
  EXPECT_EQ(interval.lower, -2);
  EXPECT_TRUE(interval.lowerAtBound);
  EXPECT_EQ(interval.upper, std::numeric_limits<double>::infinity());
  EXPECT_THROW(info::profileInterval(problem, info::estimate(problem), 0, 0),
               std::invalid_argument);
}

}  // namespace
