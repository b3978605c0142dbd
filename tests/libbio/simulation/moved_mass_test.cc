#include "simulation/moved_mass.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bio/opensim/osim_file.h"
#include "bio/review/model_review.h"
#include "support/scratch_folder.h"

namespace {

using namespace bio;
using testing::Contains;
using testing::HasSubstr;

// A shoulder of three turns: about Y, about the given axis, about Y again.
Model shoulder(const char* middleAxis) {
  const auto turn = [](int number, const char* coordinate, const char* axis) {
    return "<TransformAxis name=\"rotation" + std::to_string(number) + "\"><coordinates>" +
           coordinate + "</coordinates><axis>" + axis +
           "</axis><function><LinearFunction><coefficients>1 0</coefficients></LinearFunction>"
           "</function></TransformAxis>";
  };
  const auto coordinate = [](const char* name) {
    return std::string("<Coordinate name=\"") + name +
           "\"><default_value>0</default_value><range>-3 3</range></Coordinate>";
  };
  const std::string text =
      "<OpenSimDocument Version=\"30000\"><Model name=\"m\"><gravity>0 -9.81 0</gravity><BodySet>"
      "<objects><Body name=\"ground\"><mass>0</mass></Body><Body name=\"arm\"><mass>2</mass>"
      "<mass_center>0 -0.2 0</mass_center><inertia_xx>0.02</inertia_xx><inertia_yy>0.005"
      "</inertia_yy><inertia_zz>0.02</inertia_zz><inertia_xy>0</inertia_xy><inertia_xz>0"
      "</inertia_xz><inertia_yz>0</inertia_yz><Joint><CustomJoint name=\"gh\"><parent_body>ground"
      "</parent_body><SpatialTransform>" +
      turn(1, "y1", "0 1 0") + turn(2, "z", middleAxis) + turn(3, "y2", "0 1 0") +
      "</SpatialTransform><CoordinateSet><objects>" + coordinate("y1") + coordinate("z") +
      coordinate("y2") +
      "</objects></CoordinateSet></CustomJoint></Joint></Body></objects></BodySet></Model>"
      "</OpenSimDocument>";
  const support::ScratchFolder folder;
  return readOsim(folder.file("shoulder.osim", text));
}

TEST(MovedMass, IsJudgedWhereAMotionStarts) {
  const Model model = shoulder("0 0 1");
  const Skeleton skeleton(model, {{"y1", "z", "y2"}, {}});
  EXPECT_EQ(whatMovesNoMass(skeleton), "");
  EXPECT_EQ(whatMovesNoMassAt(skeleton, Eigen::Vector3d(0.3, 0, 0.1)),
            "coordinates 'y1', 'y2' can move together without moving any mass");
  EXPECT_EQ(whatMovesNoMassAt(skeleton, Eigen::Vector3d(0.3, 0.7, 0.1)), "");
  EXPECT_FALSE(requireMovedMass(model, skeleton));  // not in the default posture
}

TEST(MovedMass, IsMissingWhereTwoAxesAreOneInEveryPosture) {
  const Model model = shoulder("0 1 0");
  const Skeleton skeleton(model, {{"y1", "z", "y2"}, {}});
  EXPECT_THAT(whatMovesNoMass(skeleton), HasSubstr("one of them has to be locked"));
  EXPECT_THROW(requireMovedMass(model, skeleton), std::invalid_argument);
}

TEST(MovedMass, IsReviewedForAllCoordinatesTogether) {
  const auto linesOf = [](const Model& model) {
    std::vector<std::string> lines;
    for (const Remark& remark : reviewModel(model)) lines.push_back(remark.message);
    return lines;
  };
  EXPECT_THAT(linesOf(shoulder("0 0 1")),
              Contains("coordinates 'y1', 'y2' can move together without moving any mass in the "
                       "default posture: a motion must start in another, or one of them be "
                       "locked"));
  Model held = shoulder("0 0 1");
  held.joints.front().coordinates[2].locked = true;
  EXPECT_THAT(linesOf(held), testing::Not(Contains(HasSubstr("together"))));
}

}  // namespace
