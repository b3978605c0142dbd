#include "info/estimation/estimate.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "support/closed_forms.h"

namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;
using info::estimate;
using info::EstimateOptions;
using info::LeastSquares;
using info::Method;
using info::Parameter;
using info::Termination;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

const std::vector<Method> kAll = {Method::gradientDescent, Method::iteratedLeastSquares,
                                  Method::newtonRaphson, Method::levenbergMarquardt};
const info::OutputCovariance kNoise(MatrixXd::Constant(1, 1, 0.01));

// The oscillation measured exactly, or with a disturbance that no (c, ω) explains.
LeastSquares oscillation(std::vector<Parameter> parameters, double disturbance = 0,
                         const Vector2d& truth = {0.5, 3}) {
  const auto model = support::DampedOscillation{VectorXd::LinSpaced(60, 0, 5)}.predictor();
  MatrixXd data = model.outputs(truth);
  for (Eigen::Index k = 0; k < data.cols(); ++k)
    data(0, k) += disturbance * std::sin(11.0 * double(k));
  return LeastSquares(model, {data, kNoise}, std::move(parameters));
}
const std::vector<Parameter> kStart = {{.name = "c", .unit = "1/s", .start = 0.8},
                                       {.name = "w", .unit = "rad/s", .start = 3.3}};

LeastSquares line(std::vector<Parameter> parameters) {
  const VectorXd t = VectorXd::LinSpaced(9, -1, 1);
  const MatrixXd data = ((2 - 0.7 * t.array()) + 0.1 * (5 * t.array()).cos()).matrix().transpose();
  return LeastSquares(support::straightLine(t), {data, kNoise}, std::move(parameters));
}

TEST(Estimate, FindsTheTruthFromExactDataByEveryMethod) {
  for (Method method : kAll) {
    EstimateOptions options;
    options.method = method;
    options.maxIterations = 2000;
    const auto result = estimate(oscillation(kStart), options);
    EXPECT_TRUE(result.converged) << describe(result.why);
    EXPECT_LT((result.parameters - Vector2d(0.5, 3)).norm(), 1e-5) << int(method);
    EXPECT_EQ(result.costHistory.size(), std::size_t(result.iterations) + 1);
    for (std::size_t i = 1; i < result.costHistory.size(); ++i)
      EXPECT_LE(result.costHistory[i], result.costHistory[i - 1]);
  }
}

// Regression on a line is solved by one step, and has the textbook's covariance and intervals.
TEST(Estimate, SolvesALinearModelInOneStep) {
  for (Method method : {Method::iteratedLeastSquares, Method::newtonRaphson}) {
    EstimateOptions options;
    options.method = method;
    const auto result = estimate(line({{.name = "a"}, {.name = "b"}}), options);
    EXPECT_EQ(result.iterations, 1);
    const VectorXd t = VectorXd::LinSpaced(9, -1, 1);
    const VectorXd y = (2 - 0.7 * t.array()) + 0.1 * (5 * t.array()).cos();
    EXPECT_NEAR(result.parameters[0], y.mean(), 1e-14);
    EXPECT_NEAR(result.parameters[1], t.dot(y) / t.squaredNorm(), 1e-14);
    EXPECT_NEAR(result.covariance(1, 1), 0.01 / t.squaredNorm(), 1e-16);
    EXPECT_NEAR(result.intervals(0, 1) - result.parameters[0], 1.959963984540054 * 0.1 / 3, 1e-12);
    const VectorXd r = y - VectorXd::Constant(9, result.parameters[0]) - result.parameters[1] * t;
    EXPECT_NEAR(result.reducedChiSquare, r.squaredNorm() / 0.01 / 7, 1e-12);
  }
}

// A prior counts as a measurement of the parameter: precision-weighted mean, variances add
// inversely.
TEST(Estimate, WeighsAPriorAgainstTheData) {
  Parameter offset{.name = "a", .start = 1, .prior = info::GaussianPrior{1.0, 0.05}};
  const auto result = estimate(line({offset, {.name = "b"}}));
  const VectorXd t = VectorXd::LinSpaced(9, -1, 1);
  const double mean = ((2 - 0.7 * t.array()) + 0.1 * (5 * t.array()).cos()).mean();
  EXPECT_NEAR(result.parameters[0], (mean * 900 + 1.0 * 400) / 1300, 1e-9);
  EXPECT_NEAR(result.covariance(0, 0), 1.0 / 1300, 1e-15);
}

TEST(Estimate, StopsOnABoundWhereTheCostStillFalls) {
  for (Method method : kAll) {
    std::vector<Parameter> parameters = kStart;
    parameters[0].lower = 0.7;  // the free minimum is at 0.5
    EstimateOptions options;
    options.method = method;
    options.maxIterations = 2000;
    const auto result = estimate(oscillation(parameters), options);
    EXPECT_TRUE(result.converged) << describe(result.why) << int(method);
    EXPECT_EQ(result.parameters[0], 0.7);
    EXPECT_TRUE(result.atBound[0]);
    EXPECT_FALSE(result.atBound[1]);
    EXPECT_GT(result.gradient[0], 0);
    // the other parameter is at its optimum given the bound
    parameters[0] = {.name = "c", .start = 0.7, .lower = 0.7, .upper = 0.7};
    const auto conditional = estimate(oscillation(parameters));
    EXPECT_NEAR(result.parameters[1], conditional.parameters[1], 1e-6);
    EXPECT_EQ(conditional.covariance(0, 0), 0);
  }
}

TEST(Estimate, LeavesABoundThatItOnlyPassesBy) {
  std::vector<Parameter> parameters = kStart;
  parameters[0].start = parameters[0].upper = 0.9;
  const auto result = estimate(oscillation(parameters));
  EXPECT_NEAR(result.parameters[0], 0.5, 1e-6);
}

// Orders of convergence, from the errors of successive iterates against the same minimum.
TEST(Estimate, ConvergesLinearlySuperlinearlyAndQuadratically) {
  const auto problem = oscillation(kStart, 0.4);
  EstimateOptions options;
  options.method = Method::newtonRaphson;
  options.decrementTolerance = 0;
  options.gradientTolerance = 1e-8;
  const VectorXd minimum = estimate(problem, options).parameters;
  const auto errors = [&](Method method) {
    options.method = method;
    options.maxIterations = 3000;
    std::vector<double> list;
    for (const VectorXd& theta : estimate(problem, options).parameterHistory)
      list.push_back((theta - minimum).norm());
    return list;
  };
  // Newton: e_{k+1}/e_k² settles (measured 2.6, 3.4, 3.6)
  const auto newton = errors(Method::newtonRaphson);
  std::vector<double> overSquare;
  for (std::size_t k = 0; k + 1 < newton.size(); ++k)
    if (newton[k] < 0.1 && newton[k + 1] > 1e-12)
      overSquare.push_back(newton[k + 1] / (newton[k] * newton[k]));
  ASSERT_GE(overSquare.size(), 3u);
  EXPECT_NEAR(overSquare.back() / overSquare[overSquare.size() - 2], 1, 0.2);
  // iterated least squares: e_{k+1}/e_k falls until the residuals' curvature shows (measured 0.014)
  const auto iterated = errors(Method::iteratedLeastSquares);
  ASSERT_GE(iterated.size(), 5u);
  EXPECT_LT(iterated[4] / iterated[3], 0.3 * iterated[2] / iterated[1]);
  EXPECT_LT(iterated.back() / iterated[iterated.size() - 2], 0.05);
  EXPECT_GT(iterated.size(), newton.size());
  // gradient descent: hundreds of steps (measured 1733), each a few per cent of the way
  const auto descent = errors(Method::gradientDescent);
  EXPECT_GT(descent.size(), 500u);
  EXPECT_NEAR(std::pow(descent[600] / descent[100], 1.0 / 500), 0.99, 0.0099);
}

TEST(Estimate, IteratesNewtonThroughAnIndefiniteHessian) {
  std::vector<Parameter> far = kStart;
  far[1].start = 4.1;  // past the inflexion of β in ω
  EstimateOptions options;
  options.method = Method::newtonRaphson;
  const auto result = estimate(oscillation(far), options);
  EXPECT_GT(result.indefiniteHessians, 0);
  EXPECT_TRUE(result.converged) << describe(result.why);
}

TEST(Estimate, StopsForTheReasonGiven) {
  EstimateOptions options;
  options.method = Method::gradientDescent;
  options.maxIterations = 3;
  EXPECT_EQ(estimate(oscillation(kStart), options).why, Termination::iterationLimit);
  EXPECT_FALSE(estimate(oscillation(kStart), options).converged);
  options.maxIterations = 1000;
  options.costTolerance = 1;
  EXPECT_EQ(estimate(oscillation(kStart), options).why, Termination::costSmall);
  options.costTolerance = 0;
  options.progress = [](const info::EstimateProgress& at) { return at.iteration < 2; };
  const auto stopped = estimate(oscillation(kStart), options);
  EXPECT_EQ(stopped.why, Termination::stopped);
  EXPECT_EQ(stopped.iterations, 2);
  for (int i = 0; i <= int(Termination::stopped); ++i)
    EXPECT_NE(describe(Termination(i)), "unknown");
}

// Two parameters that enter as a sum: damped steps still reach the valley, plain ones cannot start.
TEST(Estimate, ReportsInfiniteVarianceAlongAValley) {
  info::Predictor sum;
  sum.outputs = [](const VectorXd& theta) -> MatrixXd {
    return MatrixXd::Constant(1, 3, theta.sum());
  };
  sum.withSensitivities = [sum](const VectorXd& theta) {
    return info::Prediction{sum.outputs(theta), MatrixXd::Ones(3, 2)};
  };
  const LeastSquares problem(sum, {MatrixXd::Constant(1, 3, 5.0), kNoise},
                             {{.name = "a", .start = 1}, {.name = "b", .start = 2}});
  EstimateOptions options;
  options.method = Method::iteratedLeastSquares;
  EXPECT_EQ(estimate(problem, options).why, Termination::singular);
  const auto damped = estimate(problem);
  EXPECT_NEAR(damped.parameters.sum(), 5, 1e-6);
  EXPECT_TRUE(std::isinf(damped.covariance(0, 0)));
  EXPECT_TRUE(std::isinf(damped.intervals(1, 1)));
}

TEST(Estimate, TakesAShorterStepWhereTheModelIsUndefined) {
  auto problem = oscillation(kStart);
  info::Predictor walled = problem.predictor();
  // undefined for ω below 2.9
  walled.outputs = [f = walled.outputs](const VectorXd& theta) -> MatrixXd {
    return theta[1] < 2.9 ? MatrixXd::Constant(1, 60, std::nan("")) : f(theta);
  };
  walled.withSensitivities = [f = walled.withSensitivities](const VectorXd& theta) {
    auto prediction = f(theta);
    if (theta[1] < 2.9) prediction.outputs.setConstant(std::nan(""));
    return prediction;
  };
  std::vector<Parameter> far = kStart;
  far[1].start = 3.7;
  for (Method method : kAll) {
    EstimateOptions options;
    options.method = method;
    options.maxIterations = 2000;
    const auto result = estimate(LeastSquares(walled, problem.measurements(), far), options);
    EXPECT_NEAR(result.parameters[1], 3, 1e-4) << int(method) << describe(result.why);
  }
  EXPECT_THROW(estimate(LeastSquares(walled, problem.measurements(), far), Vector2d(0.5, 2), {}),
               std::domain_error);
}

TEST(Estimate, NamesAParameterWithoutInformation) {
  info::Predictor constant;
  constant.outputs = [](const VectorXd& theta) -> MatrixXd {
    return MatrixXd::Constant(1, 3, theta[0]);
  };
  constant.withSensitivities = [constant](const VectorXd& theta) {
    MatrixXd gamma = MatrixXd::Zero(3, 2);
    gamma.col(0).setOnes();
    return info::Prediction{constant.outputs(theta), gamma};
  };
  std::vector<Parameter> two = {{.name = "a"}, {.name = "idle", .unit = "kg"}};
  const auto problem = [&] { return LeastSquares(constant, {MatrixXd::Ones(1, 3), kNoise}, two); };
  EXPECT_THAT([&] { estimate(problem()); },
              ThrowsMessage<std::domain_error>(
                  AllOf(HasSubstr("zero information"), HasSubstr("idle [kg]"))));
  two[1].prior = info::GaussianPrior{0, 2};
  EXPECT_NEAR(estimate(problem()).covariance(1, 1), 4, 1e-12);
}

TEST(Estimate, RefusesOptionsAndStartsOutOfRange) {
  const auto refused = [](auto change) {
    EstimateOptions options;
    change(options);
    EXPECT_THROW(estimate(oscillation(kStart), options), std::invalid_argument);
  };
  refused([](EstimateOptions& o) { o.maxIterations = -1; });
  refused([](EstimateOptions& o) { o.armijoSlope = 0; });
  refused([](EstimateOptions& o) { o.armijoShrink = 1; });
  refused([](EstimateOptions& o) { o.confidence = std::nan(""); });
  refused([](EstimateOptions& o) { o.gradientTolerance = std::nan(""); });
  refused([](EstimateOptions& o) { o.decrementTolerance = -1; });
  refused([](EstimateOptions& o) { o.costTolerance = -1; });
  std::vector<Parameter> bounded = kStart;
  bounded[0].upper = 1;
  EXPECT_THAT([&] { estimate(oscillation(bounded), Vector2d(2, 3), {}); },
              ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr("c [1/s]"), HasSubstr("2"))));
  EXPECT_THROW(estimate(oscillation(kStart), VectorXd::Zero(3), {}), std::invalid_argument);
  auto problem = oscillation(kStart);
  info::Predictor first = problem.predictor();
  first.contractedCurvature = nullptr;
  EstimateOptions newton;
  newton.method = Method::newtonRaphson;
  EXPECT_THROW(estimate(LeastSquares(first, problem.measurements(), kStart), newton),
               std::invalid_argument);
}

// y = (θ, 0.1·|θ|) against (0, −0.05): the least cost is at the kink, with a slope of 0.005.
TEST(Estimate, KnowsAMinimumAtAKinkIfToldHowFlat) {
  info::Predictor kinked;
  kinked.outputs = [](const VectorXd& theta) -> MatrixXd {
    return Eigen::RowVector2d(theta[0], 0.1 * std::abs(theta[0]));
  };
  kinked.withSensitivities = [kinked](const VectorXd& theta) {
    return info::Prediction{kinked.outputs(theta), Eigen::Vector2d(1, theta[0] < 0 ? -0.1 : 0.1)};
  };
  const info::LeastSquares problem(
      kinked, {Eigen::RowVector2d(0, -0.05), info::OutputCovariance(MatrixXd::Identity(1, 1))},
      {{.name = "x", .start = 0.7}});
  EXPECT_FALSE(info::estimate(problem).converged);
  info::EstimateOptions options;
  options.kinkTolerance = 0.01;
  const info::Estimate found = info::estimate(problem, options);
  EXPECT_EQ(found.why, info::Termination::kinkReached) << info::describe(found.why);
  EXPECT_TRUE(found.converged);
  EXPECT_NEAR(found.parameters[0], 0, 1e-6);
  options.kinkTolerance = -1;
  EXPECT_THROW(info::estimate(problem, options), std::invalid_argument);
}

TEST(Estimate, KnowsTheNormalDistribution) {
  EXPECT_NEAR(info::normalQuantile(0.95), 1.959963984540054, 1e-12);
  EXPECT_NEAR(info::normalQuantile(0.6826894921370859), 1, 1e-12);
  EXPECT_THROW(info::normalQuantile(1), std::invalid_argument);
}

}  // namespace
