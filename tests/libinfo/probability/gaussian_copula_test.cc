#include "info/probability/gaussian_copula.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "info/probability/marginal.h"
#include "info/probability/random_stream.h"
#include "support/throws_saying.h"

namespace info {
namespace {

Eigen::MatrixXd threeCorrelations() {
  Eigen::MatrixXd r(3, 3);
  r << 1, 0.8, -0.3, 0.8, 1, 0.1, -0.3, 0.1, 1;
  return r;
}

TEST(GaussianCopula, DrawsOfNormalLawsHaveTheCovarianceWithinFourStandardErrors) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  const Eigen::Vector3d mean(2, -1, 30), sd(0.1, 3, 7);
  const Eigen::MatrixXd wanted = sd.asDiagonal() * threeCorrelations() * sd.asDiagonal();
  const GaussianCopula together(threeCorrelations());
  constexpr int n = 20000;
  Eigen::MatrixXd draws(3, n);
  for (int k = 0; k < n; ++k) {
    RandomStream random(7, static_cast<std::uint64_t>(k));
    Eigen::VectorXd u(3);
    for (double& one : u) one = random.uniform();
    const Eigen::VectorXd shares = together.shares(u);
    for (int i = 0; i < 3; ++i) {
      const Marginal law{Marginal::Shape::normal, mean[i], sd[i], -inf, inf};
      draws(i, k) = law.quantile(shares[i]);
    }
  }
  const Eigen::VectorXd middle = draws.rowwise().mean();
  const Eigen::MatrixXd off = draws.colwise() - middle;
  const Eigen::MatrixXd sample = off * off.transpose() / (n - 1);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(middle[i], mean[i], 4 * sd[i] / std::sqrt(n));
    for (int j = 0; j < 3; ++j) {
      // the variance of a sample covariance of normal numbers
      const double error =
          std::sqrt((wanted(i, i) * wanted(j, j) + wanted(i, j) * wanted(i, j)) / n);
      EXPECT_NEAR(sample(i, j), wanted(i, j), 4 * error) << i << ' ' << j;
    }
  }
}

// Sheppard's theorem: both of two normal numbers lie below their means with probability
// ¼ + arcsin(ρ)/2π.
TEST(GaussianCopula, SharesLieTogetherBelowTheHalfAsSheppardSays) {
  const GaussianCopula together(threeCorrelations());
  constexpr int n = 20000;
  int both = 0, first = 0;
  for (int k = 0; k < n; ++k) {
    RandomStream random(3, static_cast<std::uint64_t>(k));
    Eigen::VectorXd u(3);
    for (double& one : u) one = random.uniform();
    const Eigen::VectorXd shares = together.shares(u);
    first += shares[1] < 0.25;
    both += shares[0] < 0.5 && shares[1] < 0.5;
  }
  const double p = 0.25 + std::asin(0.8) / (2 * std::numbers::pi);
  EXPECT_NEAR(both / double{n}, p, 4 * std::sqrt(p * (1 - p) / n));
  EXPECT_NEAR(first / double{n}, 0.25, 4 * std::sqrt(0.25 * 0.75 / n));
}

TEST(GaussianCopula, LeavesIndependentSharesAsTheyAreAndEndsFinite) {
  const GaussianCopula alone(Eigen::MatrixXd::Identity(3, 3));
  const Eigen::VectorXd u = Eigen::Vector3d(0.25, 0.5, 0.999);
  EXPECT_LT((alone.shares(u) - u).cwiseAbs().maxCoeff(), 1e-15);
  const Eigen::VectorXd ends = GaussianCopula(threeCorrelations()).shares(Eigen::Vector3d(0, 1, 0));
  EXPECT_TRUE(ends.allFinite());
  EXPECT_GE(ends.minCoeff(), 0);
  EXPECT_LE(ends.maxCoeff(), 1);
}

TEST(GaussianCopula, RefusesWhatIsNoCorrelation) {
  const auto made = [](double a, double b, double c, double diagonal) {
    Eigen::MatrixXd r(3, 3);
    r << 1, a, b, a, 1, c, b, c, diagonal;
    return [r] { GaussianCopula one(r); };
  };
  // a and b nearly the same, a and c too, but b and c the opposite
  support::throwsSaying(made(0.9, 0.9, -0.9, 1), "not positive definite");
  support::throwsSaying(made(1, 0, 0, 1), "not positive definite");
  support::throwsSaying(made(0, 0, 0, 0.9), "diagonal");
  support::throwsSaying(made(0, 0, std::nan(""), 1), "asymmetric");
  Eigen::MatrixXd skew = threeCorrelations();
  skew(0, 1) = 0.7;
  support::throwsSaying([&] { GaussianCopula one(skew); }, "asymmetric");
}

}  // namespace
}  // namespace info
