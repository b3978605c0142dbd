#include "info/estimation/residuals.h"

#include <gtest/gtest.h>

#include <cmath>

#include "info/probability/random_stream.h"

namespace info {
namespace {

Eigen::VectorXd firstOrder(double memory, Eigen::Index n, std::uint64_t stream) {
  RandomStream random(7, stream);
  Eigen::VectorXd r(n);
  r[0] = random.normal();
  for (Eigen::Index k = 1; k < n; ++k) {
    r[k] = memory * r[k - 1] + std::sqrt(1 - memory * memory) * random.normal();
  }
  return r;
}

TEST(Autocorrelation, IsThatOfAKnownSequence) {
  const auto rho = autocorrelation({Eigen::Vector4d(1, -1, 1, -1)}, 3);
  ASSERT_EQ(rho.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_DOUBLE_EQ(rho[k], k % 2 ? -1 : 1);
}

TEST(Autocorrelation, DoesNotReachFromOneSeriesToTheNext) {
  const auto rho = autocorrelation({Eigen::Vector2d(1, 0), Eigen::Vector2d(0, 1)}, 5);
  ASSERT_EQ(rho.size(), 2u);
  EXPECT_EQ(rho[1], 0);
}

TEST(Autocorrelation, OfAConstantOffsetIsOne) {
  const auto rho = autocorrelation({Eigen::VectorXd::Constant(50, 3)}, 20);
  for (const double value : rho) EXPECT_DOUBLE_EQ(value, 1);
}

// ρ_k = 0.8^k has 1 + 2·0.8/0.2 = 9 samples per independent value.
TEST(AutocorrelationTime, IsThatOfAFirstOrderProcess) {
  const Eigen::Index n = 40000;
  EXPECT_NEAR(autocorrelationTime(autocorrelation({firstOrder(0.8, n, 0)}, 500), n), 9, 0.7);
}

TEST(AutocorrelationTime, OfWhiteNoiseIsOne) {
  int one = 0;
  for (std::uint64_t i = 0; i < 200; ++i) {
    const double time = autocorrelationTime(autocorrelation({firstOrder(0, 400, i)}, 100), 400);
    EXPECT_GE(time, 1);
    one += time == 1;
  }
  EXPECT_GE(one, 185);  // measured 195
}

TEST(RobustDeviation, IsThatOfNormalNoiseWithOutliers) {
  Eigen::VectorXd r = firstOrder(0, 20001, 1);
  EXPECT_NEAR(robustSd(r), 1, 0.02);
  r.head(1000).setConstant(1e3);
  EXPECT_NEAR(robustSd(r), 1.07, 0.03);
  EXPECT_DOUBLE_EQ(robustSd(Eigen::Vector2d(-1, 3)), 2 * 1.482602218505602);
}

TEST(Residuals, RefuseNothingAtAll) {
  EXPECT_THROW(autocorrelation({}, 3), std::invalid_argument);
  EXPECT_THROW(autocorrelation({Eigen::VectorXd::Zero(3)}, 3), std::invalid_argument);
  EXPECT_THROW(robustSd(Eigen::VectorXd()), std::invalid_argument);
}

}  // namespace
}  // namespace info
