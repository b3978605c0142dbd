#include "info/design/trajectory_search.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace info;
using Eigen::MatrixXd;

TEST(InformationCost, FollowsTheInformation) {
  const MatrixXd I{{3.0, 0.7}, {0.7, 1.2}}, D{{0.4, -0.3}, {-0.3, 0.9}};
  for (const InformationWeights weights :
       {InformationWeights{.e = 2}, {.a = 3}, {.d = 0.5}, {.condition = 1.5}}) {
    const double h = 1e-6;
    const double central = (informationCost(weights, I + h * D, 1e-9).value -
                            informationCost(weights, I - h * D, 1e-9).value) /
                           (2 * h);
    EXPECT_NEAR(informationCost(weights, I, 1e-9).dvalue_dI.cwiseProduct(D).sum(), central,
                1e-8 * std::abs(central));
  }
  const MatrixXd diagonal{{4.0, 0.0}, {0.0, 0.5}};
  EXPECT_DOUBLE_EQ(informationCost({.e = 3}, diagonal, 1e-9).value, 6);
  EXPECT_DOUBLE_EQ(informationCost({.condition = 2}, diagonal, 1e-9).value, 16);
  EXPECT_DOUBLE_EQ(informationCost({.a = 1}, diagonal, 1e-9).value, 2.25);
  EXPECT_DOUBLE_EQ(informationCost({.d = 1}, diagonal, 1e-9).value, -std::log(2.0));
}

TEST(InformationCost, DescendsAtARepeatedEigenvalue) {
  const MatrixXd I = 2 * MatrixXd::Identity(2, 2);
  const MatrixXd gradient = informationCost({.e = 1}, I, 1e-9).dvalue_dI;
  EXPECT_LT(informationCost({.e = 1}, I - 0.1 * gradient, 1e-9).value, 0.5);
}

TEST(InformationCost, RefusesAMotionWithoutInformation) {
  EXPECT_THROW(informationCost({.e = 1}, MatrixXd{{1.0, 0.0}, {0.0, 0.0}}, 1e-9), NoInformation);
  EXPECT_THROW(informationCost({.e = 1}, MatrixXd{{NAN, 0.0}, {0.0, 1.0}}, 1e-9), NoInformation);
  EXPECT_NO_THROW(informationCost({}, MatrixXd::Zero(2, 2), 1e-9));
}

TEST(InputBarrier, IsSmoothAndRisesOutwards) {
  const auto value = [](double u) { return inputBarrier(u, -1, 3, 0.5).value; };
  double last = value(1);
  EXPECT_NEAR(last, 0, 1e-15);
  for (double u = 1; u < 4; u += 0.01) {
    const double h = 1e-6;
    EXPECT_NEAR(inputBarrier(u, -1, 3, 0.5).slope, (value(u + h) - value(u - h)) / (2 * h), 1e-5);
    EXPECT_GE(value(u), last);
    last = value(u);
  }
  EXPECT_NEAR(value(3), 0.5 * (1.5 - std::log(0.1)), 1e-12);
}

/// J = 2 max(x, y) + (x + y)/10 on the plane, stuck at x = y without the guard.
class Kink : public SearchProblem {
 public:
  double cost() const override { return value(x_, y_); }
  const MatrixXd& information() const override { return information_; }
  Direction findDirection(double tolerance) override {
    const bool together = std::abs(x_ - y_) <= tolerance;
    const double gx = together ? 1.1 : (x_ > y_ ? 2.1 : 0.1), gy = 2.2 - gx;
    dx_ = -gx;
    dy_ = -gy;
    return {-gx * gx - gy * gy, 2.1};
  }
  double trial(double step) override {
    tx_ = x_ + step * dx_;
    ty_ = y_ + step * dy_;
    return value(tx_, ty_);
  }
  void accept() override {
    x_ = tx_;
    y_ = ty_;
  }
  double x_ = 1, y_ = 1 + 1e-13;

 private:
  static double value(double x, double y) {
    return 2 * std::max(x, y) + 0.1 * (x + y) + 0.01 * (x * x + y * y);
  }
  double dx_ = 0, dy_ = 0, tx_ = 0, ty_ = 0;
  MatrixXd information_ = MatrixXd::Identity(2, 2);
};

TEST(Search, TakesMeetingEigenvaluesTogetherBeforeItGivesUp) {
  SearchOptions options{.maxIterations = 5, .maxShrinks = 20, .repeatedTolerance = 1e-15};
  Kink guarded;
  EXPECT_GT(search(guarded, options).iterations, 0);
  options.stuckTolerance = 0;
  Kink plain;
  const SearchResult stuck = search(plain, options);
  EXPECT_EQ(stuck.why, SearchEnd::noProgress);
  EXPECT_FALSE(stuck.converged);
}

TEST(Search, StopsWhereItIsToldAndSaysWhy) {
  Kink problem;
  SearchOptions options{.maxIterations = 3};
  EXPECT_EQ(search(problem, options).why, SearchEnd::iterationLimit);
  options.progress = [](const SearchProgress& p) { return p.iteration < 2; };
  const SearchResult stopped = search(problem, options);
  EXPECT_EQ(stopped.why, SearchEnd::stopped);
  EXPECT_EQ(stopped.iterations, 2);
  EXPECT_EQ(stopped.costs.size(), 3u);
  options.slopeTolerance = 1e9;
  EXPECT_EQ(search(problem, options).why, SearchEnd::slopeSmall);
}

TEST(Search, CapsTheFirstTrialStep) {
  Kink problem;
  SearchOptions options{.maxIterations = 1, .largestMove = 0.021};
  EXPECT_NEAR(search(problem, options).steps[0], 0.01, 1e-12);
}

TEST(Search, RefusesOptionsOutOfRange) {
  Kink problem;
  EXPECT_THROW(search(problem, {.armijoSlope = 1}), std::invalid_argument);
  EXPECT_THROW(search(problem, {.armijoShrink = 0}), std::invalid_argument);
  EXPECT_THROW(search(problem, {.largestMove = NAN}), std::invalid_argument);
  EXPECT_THROW(search(problem, {.slopeTolerance = -1}), std::invalid_argument);
}

}  // namespace
