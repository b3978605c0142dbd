// The shipped elbow is a whole arm of twelve bodies with one free coordinate. What the program
// makes of it is compared with Simbody on all of it; tests/beside asks the same of MoBL-ARMS.
#include <gtest/gtest.h>

#include "bio/analysis/replay.h"
#include "bio/opensim/osim_file.h"
#include "second_ways/simbody_tree.h"
#include "support/shipped_elbow.h"

namespace bio {
namespace {

TEST(ShippedForearm, InertiaAndGravityMomentAreThoseOfSimbodyOnTheWholeArm) {
  const Model model = fixtures::ShippedElbow().model;
  ASSERT_EQ(model.bodies.size(), 12u);
  const Skeleton skeleton(model, {{"elbow_flexion"}, {}});
  EXPECT_TRUE(skeleton.hasConstantInertia());
  const SimbodyTree tree(model);
  std::vector<RigidMotion<double, 1>> moved(skeleton.numSegments());
  for (double q = 0; q < 2.3; q += 0.1) {
    const Eigen::Matrix<double, 1, 1> at(q);
    skeleton.motions<double, 1>(at, moved.data());
    const auto jet = skeleton.inertia<1>(at, moved.data());
    const auto reference = tree.reducedTo({"elbow_flexion"}, {{"elbow_flexion", q}});
    EXPECT_NEAR(jet.massMatrix(0, 0), reference.massMatrix(0, 0), 1e-13);
    EXPECT_NEAR(-jet.dV[0], reference.gravityForce[0], 1e-12);
  }
}

}  // namespace
}  // namespace bio
