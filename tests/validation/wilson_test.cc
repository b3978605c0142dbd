#include "score/wilson.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace hidden {
namespace {

// Values of Newcombe (Statistics in Medicine 17, 1998), Wilson's method without correction.
TEST(Wilson, AgreesWithPublishedIntervals) {
  const struct {
    int k, n;
    double low, high;
  } published[] = {
      {81, 263, 0.2553, 0.3662}, {15, 148, 0.0624, 0.1605}, {0, 20, 0.0, 0.1611},
      {1, 29, 0.0061, 0.1718},   {20, 20, 0.8389, 1.0},
  };
  for (const auto& p : published) {
    const Interval i = wilson(p.k, p.n);
    EXPECT_NEAR(i.low, p.low, 5e-5) << p.k << " of " << p.n;
    EXPECT_NEAR(i.high, p.high, 5e-5) << p.k << " of " << p.n;
  }
}

TEST(Wilson, NeedsAProportion) {
  EXPECT_THROW(wilson(3, 2), std::invalid_argument);
  EXPECT_THROW(wilson(-1, 2), std::invalid_argument);
  EXPECT_EQ(wilson(0, 0).high, 1);
}

}  // namespace
}  // namespace hidden
