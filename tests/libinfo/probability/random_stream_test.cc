#include "info/probability/random_stream.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using info::RandomStream;

TEST(RandomStream, IsAFunctionOfSeedStreamAndCounter) {
  RandomStream a(7, 3), b(7, 3), otherSeed(8, 3), otherStream(7, 4);
  for (int i = 0; i < 100; ++i) {
    const auto bits = a.bits();
    EXPECT_EQ(bits, b.bits());
    EXPECT_NE(bits, otherSeed.bits());
    EXPECT_NE(bits, otherStream.bits());
  }
}

TEST(RandomStream, UniformNumbersFillTheUnitInterval) {
  RandomStream random(1, 0);
  const int n = 100000;
  double sum = 0, squares = 0;
  for (int i = 0; i < n; ++i) {
    const double x = random.uniform();
    ASSERT_GE(x, 0);
    ASSERT_LT(x, 1);
    sum += x;
    squares += x * x;
  }
  // four standard errors
  EXPECT_NEAR(sum / n, 0.5, 4 * std::sqrt(1.0 / 12 / n));
  EXPECT_NEAR(squares / n, 1.0 / 3, 4 * std::sqrt(4.0 / 45 / n));
}

// Moments of the normal distribution, and neighbouring streams do not know of each other.
TEST(RandomStream, NormalNumbersHaveTheirMomentsAcrossStreams) {
  const int n = 100000;
  double sum = 0, squares = 0, fourth = 0, neighbours = 0, tail = 0;
  for (int i = 0; i < n; ++i) {
    RandomStream a(5, std::uint64_t(i)), b(5, std::uint64_t(i) + 1);
    const double x = a.normal(), next = a.normal();
    sum += x;
    squares += x * x;
    fourth += x * x * x * x;
    neighbours += x * b.normal() + x * next;
    tail += std::abs(x) > 1.959963984540054;
  }
  EXPECT_NEAR(sum / n, 0, 4 / std::sqrt(n));
  EXPECT_NEAR(squares / n, 1, 4 * std::sqrt(2.0 / n));
  EXPECT_NEAR(fourth / n, 3, 4 * std::sqrt(96.0 / n));
  EXPECT_NEAR(neighbours / n, 0, 4 * std::sqrt(2.0 / n));
  EXPECT_NEAR(tail / n, 0.05, 4 * std::sqrt(0.05 * 0.95 / n));
}

}  // namespace
