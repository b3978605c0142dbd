#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "bio/opensim/osim_file.h"
#include "bio/review/model_review.h"
#include "libbio/path/arm_paths.h"

namespace bio {
namespace {

using fixtures::V;
using testing::ElementsAre;
using testing::IsEmpty;

/// Upper arm, ulna and radius, and a wrap object of each shape at the humerus' origin, whose centre
/// the default posture places at (0.1, 0.5, 0) in the ground.
Model armWith(WrapShape shape) {
  Model model = fixtures::system();
  WrapObject object;
  object.name = "object";
  object.body = "humerus";
  object.shape = shape;
  object.radius = shape == WrapShape::torus ? 0.01 : 0.02;  // of a torus: of its tube
  object.outerRadius = 0.04;
  object.length = 0.1;
  object.semiAxes = {0.02, 0.03, 0.04};
  model.wrapObjects = {object};
  Muscle muscle = fixtures::muscle(
      {fixtures::point("ground", {0.1, 0.8, 0}), fixtures::point("humerus", {0, 0.1, 0.1}),
       fixtures::point("ulna", {0, -0.1, 0})},
      {"object"});
  muscle.path.points[0].name = "origin";
  muscle.path.points[1].name = "via";
  muscle.path.points[2].name = "insertion";
  muscle.name = "test";
  model.muscles = {muscle};
  return model;
}

std::vector<std::string> linesOf(const Model& model) {
  std::vector<std::string> lines;
  for (const Remark& r : reviewPathPoints(model)) lines.push_back(r.subject + ": " + r.message);
  return lines;
}

std::string lineOf(const std::string& point) {
  return "muscle 'test': its point '" + point +
         "' lies inside its wrap object 'object' in the default posture: next to it the path is a "
         "straight line through the object, as in OpenSim";
}

/// The lines with the path's second point at a place in the object's frame.
std::vector<std::string> withViaAt(Model model, const V& place) {
  model.muscles[0].path.points[1].location = place;
  return linesOf(model);
}

// Each shape a tenth of a millimetre to both sides of its surface.
TEST(PointsInsideWraps, AreThoseOfEachShape) {
  const Model cylinder = armWith(WrapShape::cylinder), sphere = armWith(WrapShape::sphere),
              ellipsoid = armWith(WrapShape::ellipsoid), torus = armWith(WrapShape::torus);
  const auto isInside = [](const Model& model, const V& place) {
    const auto lines = withViaAt(model, place);
    if (lines.empty()) return false;
    EXPECT_THAT(lines, ElementsAre(lineOf("via")));
    return true;
  };
  EXPECT_TRUE(isInside(cylinder, {0.0199, 0, 0.049}));
  EXPECT_FALSE(isInside(cylinder, {0.0201, 0, 0.049}));
  EXPECT_FALSE(isInside(cylinder, {0.0199, 0, 0.051})) << "beyond its end";
  EXPECT_TRUE(isInside(sphere, {0, 0, -0.0199}));
  EXPECT_FALSE(isInside(sphere, {0, 0, -0.0201}));
  EXPECT_TRUE(isInside(ellipsoid, {0, 0.0299, 0}));
  EXPECT_FALSE(isInside(ellipsoid, {0, 0.0301, 0}));
  EXPECT_FALSE(isInside(ellipsoid, {0.0201, 0, 0}));
  EXPECT_TRUE(isInside(torus, {0.0301, 0, 0}));
  EXPECT_FALSE(isInside(torus, {0.0299, 0, 0})) << "in its hole";
  EXPECT_FALSE(isInside(torus, {0, 0, 0})) << "in its hole";
  EXPECT_TRUE(isInside(sphere, {0, 0, 0}));
  EXPECT_FALSE(isInside(sphere, {0.02, 0, 0})) << "on it";
}

TEST(PointsInsideWraps, AreNamedWhereverTheyLieInThePath) {
  const Model model = armWith(WrapShape::sphere);
  EXPECT_THAT(linesOf(model), IsEmpty());
  // in the ground's frame, in which the humerus is at (0.1, 0.5, 0)
  Model first = model;
  first.muscles[0].path.points[0].location = {0.11, 0.5, 0};
  EXPECT_THAT(linesOf(first), ElementsAre(lineOf("origin")));
  first.joints[0].coordinates[0].defaultValue = 1.0;  // about its own origin
  EXPECT_THAT(linesOf(first), ElementsAre(lineOf("origin")));
  first.joints[0].parentFrame.translation.x() = 0.2;
  EXPECT_THAT(linesOf(first), IsEmpty());
  // the elbow in the object's body
  Model last = model;
  last.wrapObjects[0].frame.translation = {0.006, -0.29, -0.012};
  last.muscles[0].path.points[2].location = {0, -0.01, 0};
  EXPECT_THAT(linesOf(last), ElementsAre(lineOf("insertion")));
  Model both = last;
  both.muscles[0].path.points[1].location = {0.006, -0.29, -0.012};
  EXPECT_THAT(linesOf(both), ElementsAre(lineOf("via"), lineOf("insertion")));
}

// What takes no part says nothing.
TEST(PointsInsideWraps, AreOfActiveObjectsPointsAndMuscles) {
  Model model = armWith(WrapShape::sphere);
  PathPoint& via = model.muscles[0].path.points[1];
  via.location.setZero();
  ASSERT_THAT(linesOf(model), ElementsAre(lineOf("via")));
  Model changed = model;
  changed.wrapObjects[0].active = false;
  EXPECT_THAT(linesOf(changed), IsEmpty());
  changed = model;
  changed.muscles[0].enabled = false;
  EXPECT_THAT(linesOf(changed), IsEmpty());
  changed = model;
  changed.muscles[0].path.wraps[0].firstPoint = 3;
  EXPECT_THAT(linesOf(changed), IsEmpty());
  changed.muscles[0].path.wraps[0] = {"object", 1, 2};
  EXPECT_THAT(linesOf(changed), ElementsAre(lineOf("via")));
  changed = model;
  changed.wrapObjects[0].radius = 20;  // in millimetres, of which the review tells
  EXPECT_THAT(linesOf(changed), IsEmpty());
  changed.muscles[0].path.wraps.clear();
  EXPECT_THAT(linesOf(changed), IsEmpty());
  changed = model;
  changed.muscles[0].path.points[1].condition = PointCondition{"flexion", 0.5, 1};
  EXPECT_THAT(linesOf(changed), IsEmpty());
  changed.joints[1].coordinates[0].defaultValue = 0.7;
  EXPECT_THAT(linesOf(changed), ElementsAre(lineOf("via")));
}

// A point that moves along x with the elbow, out of the sphere at 0.02 rad.
TEST(PointsInsideWraps, AreWhereTheDefaultPostureMovesThem) {
  Model model = armWith(WrapShape::sphere);
  PointMotion motion;
  motion.coordinate = {"flexion", "", ""};
  motion.location = {Function{1, LinearFunction{1, 0}}, Function{1, ConstantFunction{0}},
                     Function{1, ConstantFunction{0}}};
  model.muscles[0].path.points[1].location.setZero();
  model.muscles[0].path.points[1].motion = motion;
  Coordinate& flexion = model.joints[1].coordinates[0];
  for (const double value : {0.0, 0.019, 0.021}) {
    flexion.defaultValue = value;
    EXPECT_EQ(linesOf(model).size(), value < 0.02 ? 1u : 0u) << value;
  }
}

// The review of a model lists them as well, and a good model has none.
TEST(PointsInsideWraps, StandInTheReview) {
  Model model = armWith(WrapShape::sphere);
  const std::size_t before = reviewModel(model).size();
  model.muscles[0].path.points[1].location.setZero();
  const std::vector<Remark> remarks = reviewModel(model);
  ASSERT_EQ(remarks.size(), before + 1);
  EXPECT_EQ(remarks.back().subject + ": " + remarks.back().message, lineOf("via"));
  EXPECT_EQ(remarks.back().weight, Weight::unusual);
  const std::filesystem::path models = std::filesystem::path(FISHERHILL_SOURCE_DIR) / "models";
  EXPECT_THAT(linesOf(readOsim(models / "elbow8.osim")), IsEmpty());
}

}  // namespace
}  // namespace bio
