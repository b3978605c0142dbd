#include "bio/muscle/muscle_forces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "libbio/muscle/elbow_muscles.h"
#include "support/finite_difference.h"

namespace bio {
namespace {

using elbow_muscles::Compiled;
using elbow_muscles::elbowMuscles;
using elbow_muscles::randomState;
using elbow_muscles::State;

// What goes into the muscle is stored, lost or made by the contractile element.
TEST(MuscleForces, PowersBalanceWhereTheMuscleDoes) {
  std::mt19937 random(5);
  for (const SchutteParameters& p : elbowMuscles()) {
    const Compiled c(p, {.clampForce = false});
    for (int i = 0; i < 100; ++i) {
      const State s = randomState(random, p);
      const double v =
          c.muscle.fibreVelocity(s.activation, s.fibreLength, s.muscleTendonLength).fibreVelocity;
      const MuscleForces f =
          muscleForces(c.muscle, s.activation, s.fibreLength, s.muscleTendonLength, v, 0.3);
      const double sum = f.activePower + f.passivePower + f.dampingPower + f.tendonPower;
      EXPECT_NEAR(sum, f.muscleTendonPower,
                  1e-10 * (1 + std::abs(f.activePower)) * p.maxIsometricForce);
      EXPECT_GE(f.dampingPower, 0);
      EXPECT_NEAR((f.activeForce + f.passiveForce + f.dampingForce) * std::cos(f.pennation),
                  f.tendonForce, 1e-11 * p.maxIsometricForce);
    }
  }
}

TEST(MuscleForces, TendonPowerIsTheRateOfStoredEnergy) {
  const Compiled c(support::tricepsLongHead());
  const double v = -0.2, vMT = 0.1;
  const MuscleForces f = muscleForces(c.muscle, 0.3, 0.13, 0.278, v, vMT);
  const auto strain = [&](double t) {
    return c.muscle.tendonStrain(0.13 + v * t, 0.278 + vMT * t);
  };
  const double rate = support::centralDifference(strain, 0, 1e-5) * 0.143;
  EXPECT_NEAR(f.tendonPower, f.tendonForce * rate, 1e-6);  // of 454 W
  EXPECT_NEAR(f.tendonStrain, strain(0), 1e-16);
}

}  // namespace
}  // namespace bio
