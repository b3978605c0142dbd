#include "bio/muscle/curves/force_velocity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "bio/muscle/schutte_muscle.h"

namespace bio {
namespace {

TEST(ForceVelocity, HasItsKnownValues) {
  EXPECT_EQ(schutte::forceVelocity(-1.5), 0);
  EXPECT_EQ(schutte::forceVelocity(-1.0), 0);
  EXPECT_EQ(schutte::forceVelocity(0.0), 1);
  EXPECT_NEAR(schutte::forceVelocity(-0.5), 0.15 * 0.5 / 0.65, 1e-15);
  EXPECT_NEAR(schutte::forceVelocity(1e12), 1.4, 1e-10);
  EXPECT_NEAR(schutte::forceVelocity(1e-9), 1, 1e-7);
  // slopes on both sides of the kink: (1+k_v)/k_v and 0.4/σ
  EXPECT_NEAR((1 - schutte::forceVelocity(-1e-7)) / 1e-7, 1.15 / 0.15, 1e-4);
  EXPECT_NEAR((schutte::forceVelocity(1e-7) - 1) / 1e-7, 0.4 * 1.15 / (0.13 * 0.15), 1e-3);
}

TEST(ForceVelocity, InverseGivesTheForceBack) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 20000; ++i) {
    const double A = i % 10 == 0 ? 0 : std::pow(10.0, -6 + 6 * unit(random));
    const double B = std::pow(10.0, -4 + 4 * unit(random));
    const double P = -2 * B + 3 * unit(random);
    const double v = schutte::velocityFromForce(P, A, B);
    const double force = A * schutte::forceVelocity(v) + B * v;
    EXPECT_NEAR(force, P, 1e-12 * (1 + std::abs(P))) << A << ' ' << B << ' ' << v;
  }
}

// Just beside v = 0 the textbook root loses all digits; the stable one keeps them.
TEST(ForceVelocity, InverseHasNoCancellationNearIsometric) {
  const double A = 0.8, B = 0.017;
  for (const double step : {1e-6, 1e-9, 1e-12}) {
    const double P = A - step;
    const double exactStep = A - P;  // what the double holds
    const double expected = -exactStep / (A * 1.15 / 0.15 + B);
    EXPECT_NEAR(schutte::velocityFromForce(P, A, B) / expected, 1, 10 * step + 1e-14);
  }
  EXPECT_EQ(schutte::velocityFromForce(A, A, B), 0);
}

}  // namespace
}  // namespace bio
