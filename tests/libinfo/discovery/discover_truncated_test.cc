#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "info/discovery/likelihood/truncated.h"

namespace {

using namespace info::discover;

TEST(Truncated, MassesAgreeWithQuadrature) {
  EXPECT_NEAR(logNormalWithin(-1, 2), std::log(0.818594614120364), 1e-12);
  EXPECT_NEAR(logNormalWithin(30, 31), -454.321243956343, 1e-9);
  EXPECT_EQ(logNormalWithin(1, -1), -HUGE_VAL);
  EXPECT_EQ(logNormalWithin(HUGE_VAL, -HUGE_VAL), -HUGE_VAL);
  double sum = 0;
  for (int i = 0; i < 200000; ++i) {
    const double x = (i + 0.5) * 1e-5;
    sum += 1e-5 * std::exp(-3 * x - 0.5 * 4 * x * x);
  }
  EXPECT_NEAR(logMassAtBound(3, 4, 2), std::log(sum / std::sqrt(2 * std::numbers::pi)), 1e-8);
}

}  // namespace
