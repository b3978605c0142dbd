#include "robots/laboratory_estimates.h"

#include <gtest/gtest.h>

namespace {

using namespace info;
using Eigen::Vector2d;

// Without effects only the noise is left, and the bound says how far it goes.
TEST(LaboratoryEstimates, WithoutEffectsAreAsGoodAsTheNoiseAllows) {
  const auto lab = robot::suspendedMassInLaboratory({});
  const CartMotion motion = suspendedMassLively();
  const robot::LaboratoryEstimates found = robot::estimateInLaboratory(lab, motion, 9, 3, 2);
  EXPECT_TRUE(found.first.converged);
  const Vector2d sd = found.first.covariance.diagonal().cwiseSqrt();
  for (Eigen::Index i : {0, 1}) {
    EXPECT_LT(std::abs(found.first.parameters[i] - lab.truth[i]), 4 * sd[i]);
    EXPECT_LT(found.medianError[i] * lab.truth[i], 2 * sd[i]);  // of a normal law: 0.67
  }
  EXPECT_EQ(robot::estimateInLaboratory(lab, motion, 9, 3, 1).medianError, found.medianError);
}

TEST(LaboratoryEstimates, CompareTwoMotionsWithTheSameEffects) {
  const LaboratoryEffects effects{.controlNoise = 0.02};
  const auto lab = robot::suspendedMassInLaboratory(effects);
  const CartMotion lively = suspendedMassLively(), quiet = suspendedMassStart();
  const robot::LaboratoryComparison found =
      robot::compareInLaboratory(lab, effects, quiet, lively, 3, 2);
  EXPECT_EQ(found.start, Vector2d(0.10, 0.60));
  EXPECT_EQ(found.truth, lab.truth);
  EXPECT_LT(found.after.medianError[1], 0.1 * found.before.medianError[1]);
}

}  // namespace
