#include "bio/path/length_jumps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/elbow_model.h"

namespace bio {
namespace {

using fixtures::elbowModel;
constexpr double inDegrees = 180 / std::numbers::pi;

// The brachialis loses its first conditional point at 0: OpenSim's lengths there are 0.140678 m
// just below (0.140622 at −1°) and 0.145932 m.
TEST(LengthJumps, FindsTheConditionalPointOfTheBrachialisAlone) {
  const auto jumps = lengthJumps(elbowModel());
  ASSERT_EQ(jumps.size(), 1u);
  EXPECT_EQ(jumps[0].muscle, "BRA");
  EXPECT_EQ(jumps[0].coordinate, "elbow_flexion");
  EXPECT_NEAR(jumps[0].value, -1e-5, 1e-9);
  EXPECT_NEAR(jumps[0].size, 0.00526, 5e-5);
  EXPECT_TRUE(jumps[0].conditional);
  EXPECT_THAT(describe(jumps[0]), testing::StartsWith("the length of BRA jumps by 5.2"));
  EXPECT_THAT(
      describe(jumps[0]),
      testing::HasSubstr(" mm at elbow_flexion = 0 deg (a conditional point) and its moment "
                         "arm by "));
}

// With 22 mm the insertion of the triceps lies inside its cylinder at the middle of the range.
TEST(LengthJumps, FindsWhereAPointIsInsideItsCylinder) {
  Model model = elbowModel();
  for (WrapObject& wrap : model.wrapObjects) {
    if (wrap.name == "TRI") wrap.radius = 0.022;
  }
  const auto jumps = lengthJumps(model);
  int ofTriceps = 0;
  for (const LengthJump& jump : jumps) {
    if (jump.muscle != "TRIlat") continue;
    ++ofTriceps;
    EXPECT_FALSE(jump.conditional);
    EXPECT_GT(jump.value * inDegrees, 60);
    EXPECT_LT(jump.value * inDegrees, 110);
    EXPECT_GT(std::abs(jump.size), 5e-4);
  }
  EXPECT_EQ(ofTriceps, 1);
}

TEST(LengthJumps, LooksWhereItIsTold) {
  const Model model = elbowModel();
  const Skeleton skeleton(model, {.freeCoordinates = {"elbow_flexion"}, .lockedValues = {}});
  EXPECT_EQ(lengthJumps(model, skeleton, {}, -0.3, 0.3).size(), 1u);
  EXPECT_EQ(lengthJumps(model, skeleton, {}, 0.1, 2.2).size(), 0u);
  Model without = model;
  for (Muscle& muscle : without.muscles) muscle.enabled = muscle.name != "BRA";
  EXPECT_EQ(lengthJumps(without, skeleton, {}, -0.3, 0.3).size(), 0u);
}

}  // namespace
}  // namespace bio
