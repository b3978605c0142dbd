#include "calibration/checked_intervals.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bio/analysis/path_postures.h"
#include "calibration/like_paths.h"
#include "support/synthetic_elbow.h"

namespace bio {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using fixtures::SyntheticElbow;

using Function = double (*)(double);

/// One output f(θ), measured as `data` with a standard deviation of 0.1.
info::LeastSquares scalarProblem(Function f, Function slope, double data, double start) {
  info::Predictor predictor;
  predictor.outputs = [f](const VectorXd& theta) { return MatrixXd::Constant(1, 1, f(theta[0])); };
  predictor.withSensitivities = [f, slope](const VectorXd& theta) {
    return info::Prediction{MatrixXd::Constant(1, 1, f(theta[0])),
                            MatrixXd::Constant(1, 1, slope(theta[0]))};
  };
  const info::OutputCovariance noise(MatrixXd::Constant(1, 1, 0.01));
  return {predictor,
          {MatrixXd::Constant(1, 1, data), noise},
          {{.name = "x", .start = start, .lower = -20, .upper = 20}}};
}

/// As a judgement by the Fisher matrix leaves it.
CalibratedParameter fisherInterval(const info::Estimate& at) {
  CalibratedParameter one{};
  one.asked = {.name = "x", .unit = "m", .start = 0, .lower = -20, .upper = 20};
  one.value = at.parameters[0];
  one.identifiable = true;
  one.sd = std::sqrt(at.covariance(0, 0));
  one.lower = one.value - 1.959964 * one.sd;
  one.upper = one.value + 1.959964 * one.sd;
  return one;
}

TEST(CheckedIntervals, AreLeftWhereTheCostIsAParabola) {
  const auto least =
      scalarProblem([](double x) { return 3 * x; }, [](double) { return 3.0; }, 6, 0);
  const info::Estimate at = info::estimate(least);
  std::vector<CalibratedParameter> all = {fisherInterval(at)};
  checkIntervals(least, at, at.covariance, 1, {}, all);
  EXPECT_FALSE(all[0].byLikelihood);
  EXPECT_EQ(all[0].lower, fisherInterval(at).lower);
  EXPECT_EQ(all[0].upper, fisherInterval(at).upper);
}

// y = x³ at 1: the interval is that of y, its cube roots.
TEST(CheckedIntervals, AreThoseOfTheLikelihoodWhereItIsNot) {
  const auto least = scalarProblem([](double x) { return x * x * x / 8; },
                                   [](double x) { return 3 * x * x / 8; }, 0.25, 1);
  const info::Estimate at = info::estimate(least);
  std::vector<CalibratedParameter> all = {fisherInterval(at)};
  checkIntervals(least, at, at.covariance, 1, {}, all);
  EXPECT_TRUE(all[0].byLikelihood);
  const double lower = std::cbrt(8 * (0.25 - 0.1959964)), upper = std::cbrt(8 * (0.25 + 0.1959964));
  EXPECT_NEAR(all[0].lower, lower, 0.01 * at.parameters[0]);
  EXPECT_NEAR(all[0].upper, upper, 0.01 * at.parameters[0]);
  EXPECT_NEAR(all[0].sd, (upper - lower) / (2 * 1.959964), 0.01);
  EXPECT_TRUE(all[0].identifiable);
}

// However well the cost agrees with its curvature: it is not known what lies further down.
TEST(CheckedIntervals, AreNoneWhereASearchDidNotConverge) {
  const auto least =
      scalarProblem([](double x) { return 3 * x; }, [](double) { return 3.0; }, 6, 0);
  info::Estimate at = info::estimate(least);
  at.converged = false;
  at.why = info::Termination::noDescent;
  std::vector<CalibratedParameter> all = {fisherInterval(at)};
  checkIntervals(least, at, at.covariance, 1, {}, all);
  EXPECT_TRUE(std::isnan(all[0].lower) && std::isnan(all[0].upper) && std::isnan(all[0].sd));
  EXPECT_FALSE(all[0].identifiable);
  EXPECT_NE(all[0].why.find("no interval of x: the search did not converge (stopped: no step lowers"), std::string::npos)
      << all[0].why;
}

// y = x² = 4: a search that stopped at 1.9 goes on to 2.
TEST(CheckedIntervals, ASearchGoesOnWhereAnEndFitsBetter) {
  const auto least =
      scalarProblem([](double x) { return x * x; }, [](double x) { return 2 * x; }, 4, 1);
  info::Estimate stopped = info::estimate(least);
  stopped.parameters[0] = 1.9;
  stopped.cost = least.cost(stopped.parameters);
  stopped.covariance(0, 0) = 0.0025;
  const info::Estimate better = betterBeside(least, stopped, 1, {});
  EXPECT_NEAR(better.parameters[0], 2, 1e-6);
  EXPECT_LT(better.cost, 1e-9);
  // from the minimum itself it does not move
  const info::Estimate same = betterBeside(least, better, 1, {});
  EXPECT_EQ(same.parameters[0], better.parameters[0]);
}

TEST(CheckedIntervals, EncloseOtherMinima) {
  const auto least =
      scalarProblem([](double x) { return x * x; }, [](double x) { return 2 * x; }, 4, 1);
  std::vector<CalibratedParameter> all = {fisherInterval(info::estimate(least))};
  OtherMinimum mirrored;
  mirrored.values = VectorXd::Constant(1, -2);
  mirrored.sd = VectorXd::Constant(1, 0.025);
  const double upper = all[0].upper;
  encloseMinima({mirrored}, 1, 0.95, all);
  EXPECT_NEAR(all[0].lower, -2 - 1.959964 * 0.025, 1e-6);
  EXPECT_EQ(all[0].upper, upper);
  EXPECT_TRUE(std::isnan(all[0].sd));
  EXPECT_FALSE(all[0].identifiable);
  EXPECT_NE(all[0].why.find("fits as well as"), std::string::npos);
}

/// The shipped elbow with the mirrored insertion of a biceps head.
struct MirroredInsertion {
  SyntheticElbow elbow;
  std::vector<Trial> trials;
  explicit MirroredInsertion(double insertion) {
    for (const char* name : {"curl_slow", "curl_fast"}) {
      trials.push_back(SyntheticElbow::noisy(
          elbow.trial(name, 3, {{"BICshort.point7.x", insertion}}, 40), 0.5, 5, trials.size()));
    }
  }
  TrialSet set() const {
    TrialSetOptions options;
    options.parameters = {"hand.mass", "BICshort.point7.x"};
    return {elbow.model, SyntheticElbow::options(), trials, options};
  }
};

TEST(LikePaths, AMirroredInsertionHasNearlyTheSameLengths) {
  const MirroredInsertion one(0.0097);
  const TrialSet set = one.set();
  VectorXd estimate(2);
  estimate << set.parameters()[0].start, -0.0044;
  const std::vector<VectorXd> starts = startsAtLikePaths(set, set.parameters(), estimate);
  ASSERT_EQ(starts.size(), 1u);  // a mass has no path
  EXPECT_EQ(starts[0][0], estimate[0]);
  EXPECT_NEAR(starts[0][1], 0.0097, 0.001);
  // and there and back
  const std::vector<VectorXd> back = startsAtLikePaths(set, set.parameters(), starts[0]);
  ASSERT_EQ(back.size(), 1u);
  EXPECT_NEAR(back[0][1], estimate[1], 2e-4);
}

// The prior prefers the insertion that is nearer to the model's, and the truth is the other one.
TEST(LikePaths, AnIntervalEnclosesTheMirroredInsertion) {
  const double truth = 0.0097;
  const MirroredInsertion one(truth);
  CalibrationOptions options;
  options.trials.parameters = {"BICshort.point7.x"};
  const TrialSet set(one.elbow.model, SyntheticElbow::options(), one.trials, options.trials);
  const Calibration found = calibrate(set, nullptr, options);
  ASSERT_FALSE(found.otherMinima.empty());
  const CalibratedParameter& point = found.parameters.front();
  EXPECT_LT(point.value, 0);
  EXPECT_NEAR(found.otherMinima.front().values[0], truth, 0.001);
  EXPECT_LE(point.lower, truth);
  EXPECT_GE(point.upper, truth);
  EXPECT_FALSE(point.identifiable);
}

}  // namespace
}  // namespace bio
