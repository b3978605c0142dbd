#include "info/estimation/robust_loss.h"

#include <gtest/gtest.h>

#include <cmath>

#include "info/probability/random_stream.h"

namespace info {
namespace {

using Kind = RobustLoss::Kind;

TEST(RobustLoss, OfSmallResidualsIsTheSquare) {
  EXPECT_EQ(evaluate({Kind::gaussian}, 9).value, 9);
  EXPECT_EQ(evaluate({Kind::huber}, 1.8).value, 1.8);
  EXPECT_NEAR(evaluate({Kind::student, 1, 1e9}, 2).value, 2, 1e-6);
}

TEST(RobustLoss, OfLargeResidualsGrowsSlower) {
  EXPECT_DOUBLE_EQ(evaluate({Kind::huber, 2}, 100).value, 2 * 2 * 10 - 4);
  EXPECT_NEAR(evaluate({Kind::student, 1, 4}, 100).value, 5 * std::log(26.0), 1e-12);
  EXPECT_NEAR(evaluate({Kind::student, 1, 4}, 100, 3).value, 7 * std::log(26.0), 1e-12);
}

TEST(RobustLoss, SlopeAndCurvatureAreDerivatives) {
  for (const RobustLoss& loss :
       {RobustLoss{Kind::gaussian}, RobustLoss{Kind::huber}, RobustLoss{Kind::student}}) {
    for (const double s : {0.3, 1.2, 2.5, 30.0}) {
      const double h = 1e-5;
      const auto at = [&](double x) { return evaluate(loss, x); };
      EXPECT_NEAR(at(s).slope, (at(s + h).value - at(s - h).value) / (2 * h), 1e-8);
      EXPECT_NEAR(at(s).curvature, (at(s + h).slope - at(s - h).slope) / (2 * h), 1e-8);
    }
  }
}

// Known of Huber's estimator of location at k = 1.345: 95 % efficient; of Student's M-estimator
// with ν = 4 at the normal distribution: about 93 %.
TEST(RobustLoss, LosesTheKnownShareOfEfficiencyOnNormalNoise) {
  RandomStream random(3, 0);
  Eigen::VectorXd z(200000);
  for (double& value : z) value = random.normal();
  EXPECT_NEAR(varianceFactor({Kind::gaussian}, z), 1, 0.01);
  EXPECT_NEAR(varianceFactor({Kind::huber}, z), 1 / 0.95, 0.01);
  const double student = varianceFactor({Kind::student}, z);
  EXPECT_GT(student, 1.02);
  EXPECT_LT(student, 1.12);
}

TEST(RobustLoss, RefusesThresholdsThatAreNotPositive) {
  EXPECT_THROW(evaluate({Kind::huber, 0}, 1), std::invalid_argument);
  EXPECT_THROW(evaluate({Kind::huber, std::nan("")}, 1), std::invalid_argument);
  EXPECT_THROW(evaluate({Kind::student, 1, -1}, 1), std::invalid_argument);
  EXPECT_THROW(varianceFactor({}, Eigen::VectorXd()), std::invalid_argument);
}

}  // namespace
}  // namespace info
