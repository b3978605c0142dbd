#include "info/probability/quadratic_form.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "info/probability/random_stream.h"

namespace {

using Eigen::VectorXd;
using info::tailOfSquares;

// One square: 1 − P(|z| < √q); two equal ones: e^{−q/2}; four: e^{−q/2}(1 + q/2).
TEST(TailOfSquares, HasTheClosedFormsOfChiSquare) {
  for (const double q : {0.3, 1.0, 4.0, 15.0, 40.0}) {
    const double one = std::erfc(std::sqrt(q / 2)), two = std::exp(-q / 2);
    EXPECT_NEAR(tailOfSquares(VectorXd::Ones(1), q) / one, 1, 0.12) << q;
    EXPECT_NEAR(tailOfSquares(VectorXd::Ones(2), q) / two, 1, 0.08) << q;
    EXPECT_NEAR(tailOfSquares(VectorXd::Ones(4), q) / (two * (1 + q / 2)), 1, 0.04) << q;
    // a unit is only a unit
    EXPECT_NEAR(
        tailOfSquares(VectorXd::Constant(4, 1e-6), 1e-6 * q) / tailOfSquares(VectorXd::Ones(4), q),
        1, 1e-9);
  }
}

// A few large variances above many small ones, as held-out errors have them.
TEST(TailOfSquares, AgreesWithDraws) {
  VectorXd variances = VectorXd::Constant(450, 1.0);
  variances.head(3) << 200, 60, 12;
  info::RandomStream random(4, 0);
  constexpr int kDraws = 20000;
  std::vector<double> sums;
  for (int i = 0; i < kDraws; ++i) {
    double sum = 0;
    for (const double v : variances) {
      const double z = random.normal();
      sum += v * z * z;
    }
    sums.push_back(sum);
  }
  std::sort(sums.begin(), sums.end());
  for (const double tail : {0.9, 0.5, 0.1, 0.02, 0.005}) {
    const auto n = static_cast<double>(sums.size());
    const double q = sums[static_cast<std::size_t>((1 - tail) * n)];
    const double sd = std::sqrt(tail * (1 - tail) / n);
    EXPECT_NEAR(tailOfSquares(variances, q), tail, 4 * sd + 0.05 * tail) << tail;
  }
}

TEST(TailOfSquares, FallsAllTheWayAndPassesItsMean) {
  VectorXd variances(4);
  variances << 3, 1, 0.5, 0;
  double before = 1;
  for (double q = 0.01; q < 60; q += 0.005) {
    const double now = tailOfSquares(variances, q);
    EXPECT_LE(now, 1.02 * before) << q;
    EXPECT_GE(now, 0);
    before = now;
  }
  EXPECT_EQ(tailOfSquares(variances, 0), 1);
  EXPECT_EQ(tailOfSquares(variances, HUGE_VAL), 0);
  EXPECT_THROW(tailOfSquares(VectorXd(), 1), std::invalid_argument);
  EXPECT_THROW(tailOfSquares(VectorXd::Zero(3), 1), std::invalid_argument);
  EXPECT_THROW(tailOfSquares(VectorXd::Constant(3, -1), 1), std::invalid_argument);
}

}  // namespace
