#include "info/estimation/convergence.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

info::Estimate history(const std::vector<double>& theta) {
  info::Estimate estimate;
  for (double value : theta) {
    estimate.parameterHistory.push_back(Eigen::VectorXd::Constant(1, value));
    estimate.costHistory.push_back(0.5 * value * value);
  }
  return estimate;
}

TEST(ConvergenceTable, RecognisesLinearAndQuadraticSequences) {
  const auto linear =
      info::convergenceTable(history({2.8, 2.4, 2.2, 2.1}), Eigen::VectorXd::Constant(1, 2));
  EXPECT_NEAR(linear[0].error, 0.4, 1e-15);
  EXPECT_TRUE(std::isnan(linear[0].ratio));
  EXPECT_TRUE(std::isnan(linear[1].order));
  EXPECT_NEAR(linear[3].ratio, 0.5, 1e-12);
  EXPECT_NEAR(linear[3].order, 1, 1e-12);
  const auto quadratic =
      info::convergenceTable(history({1e-1, 1e-2, 1e-4, 1e-8, 0}), Eigen::VectorXd::Zero(1));
  EXPECT_NEAR(quadratic[3].order, 2, 1e-12);
  EXPECT_EQ(quadratic[4].error, 0);
  EXPECT_TRUE(std::isnan(quadratic[4].order));
  EXPECT_EQ(quadratic[3].iteration, 3);
  EXPECT_DOUBLE_EQ(quadratic[1].cost, 0.5e-4);
}

TEST(ConvergenceTable, RefusesAnotherSize) {
  EXPECT_THROW(info::convergenceTable(history({1}), Eigen::VectorXd::Zero(2)),
               std::invalid_argument);
}

}  // namespace
