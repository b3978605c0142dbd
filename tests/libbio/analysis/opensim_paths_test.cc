#include "bio/analysis/opensim_paths.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "bio/path/opensim_rule.h"
#include "bio/path/path_lengths.h"
#include "bio/path/posture_samples.h"
#include "libbio/path/arm_paths.h"
#include "support/elbow_model.h"

namespace bio {
namespace {

using fixtures::extensor;

/// The arm of path_test.cc with one extensor over an ellipsoid, and the flexion free.
struct EllipsoidArm {
  Model model = fixtures::system();
  Skeleton skeleton;

  explicit EllipsoidArm(const Eigen::Vector3d& semiAxes)
      : skeleton((prepare(semiAxes), model), {.freeCoordinates = {"flexion"}, .lockedValues = {}}) {
  }
  void prepare(const Eigen::Vector3d& semiAxes) {
    for (WrapObject& wrap : model.wrapObjects) {
      if (wrap.name == "ellipsoid") wrap.semiAxes = semiAxes;
    }
    model.muscles = {extensor({"ellipsoid"})};
    model.muscles[0].name = "ext";
  }
  struct Lengths {
    double ours, theirs;
    bool wrapped;
  };
  Lengths at(double flexion) const {
    const MusclePath path(model, skeleton, model.muscles[0], {});
    PathLengths lengths(skeleton);
    lengths.add(model.muscles[0], path);
    lengths.moveTo(Eigen::VectorXd::Constant(1, flexion));
    const auto along = lengths.along(0);
    return {along.length, openSimLength(path.compiled(), postureOf(skeleton, {flexion})).value(),
            along.wrapped};
  }
};

// The plane through both ends and the closest points is one through the centre, whose section is
// the great circle; a sum of chords of 1 mm on 16 mm is shorter than its arc by (1/16)²/24.
TEST(OpenSimPaths, OverABallAreTautButForTheirChords) {
  const EllipsoidArm arm({0.016, 0.016, 0.016});
  int wrapped = 0;
  for (double q = 0.1; q < 2.3; q += 0.2) {
    const auto lengths = arm.at(q);
    EXPECT_LE(lengths.theirs, lengths.ours + 1e-9) << q;
    EXPECT_GE(lengths.theirs, lengths.ours - 0.03 * 2e-4) << q;
    wrapped += lengths.wrapped ? 1 : 0;
  }
  EXPECT_GE(wrapped, 5);
  EXPECT_TRUE(openSimDifferences(arm.model).empty());
}

/// The elbow with an ellipsoid, askew to the triceps, in place of its cylinder.
Model elbowOver(const Eigen::Vector3d& semiAxes) {
  Model model = fixtures::elbowModel();
  for (WrapObject& wrap : model.wrapObjects) {
    if (wrap.name != "TRI") continue;
    wrap.shape = WrapShape::ellipsoid;
    wrap.semiAxes = semiAxes;
    wrap.frame.orientation = {0.8, 0, 0.155};
  }
  return model;
}

// A plane section is no shorter than the geodesic on the same side.
TEST(OpenSimPaths, OverALyingEllipsoidAreLonger) {
  const Model model = elbowOver({0.02, 0.012, 0.012});
  const auto found = openSimDifferences(model);
  ASSERT_EQ(found.size(), 3u);  // the heads of the triceps
  for (const OpenSimDifference& one : found) {
    EXPECT_EQ(one.muscle.substr(0, 3), "TRI");
    EXPECT_EQ(one.coordinate, "elbow_flexion");
    EXPECT_THAT(one.ellipsoids, testing::ElementsAre("TRI"));
    EXPECT_GT(one.length, 1e-3);
    EXPECT_TRUE(one.jumps.empty());
    ASSERT_EQ(one.apart.size(), 1u);
    EXPECT_LE(one.apart[0].from, one.lengthAt);
    EXPECT_GE(one.apart[0].to, one.lengthAt);

    // both numbers, evaluated again
    const Skeleton skeleton(model, {.freeCoordinates = {"elbow_flexion"}, .lockedValues = {}});
    const Muscle& muscle = *std::find_if(model.muscles.begin(), model.muscles.end(),
                                         [&](const Muscle& m) { return m.name == one.muscle; });
    const MusclePath path(model, skeleton, muscle, {});
    PathLengths lengths(skeleton);
    lengths.add(muscle, path);
    const auto difference = [&](double q) {
      lengths.moveTo(Eigen::VectorXd::Constant(1, q));
      return openSimLength(path.compiled(), postureOf(skeleton, {q})).value() -
             lengths.along(0).length;
    };
    EXPECT_NEAR(one.length, difference(one.lengthAt), 1e-9);
    const double slope = (difference(one.armAt + 1e-4) - difference(one.armAt - 1e-4)) / 2e-4;
    EXPECT_NEAR(one.arm, -slope, 1e-4);
    EXPECT_THAT(describe(one), testing::HasSubstr(one.muscle + " over TRI differs from the taut"));
  }
}

// OpenSim's length jumps where its path takes hold of the ellipsoid; just before it is ours.
TEST(OpenSimPaths, JumpWhereOpenSimTakesHold) {
  const Model model = elbowOver({0.03, 0.016, 0.016});
  const Skeleton skeleton(model, {.freeCoordinates = {"elbow_flexion"}, .lockedValues = {}});
  const auto found = openSimDifferences(model);
  ASSERT_EQ(found.size(), 3u);
  for (const OpenSimDifference& one : found) {
    ASSERT_EQ(one.jumps.size(), 1u);
    const auto muscle = std::find_if(model.muscles.begin(), model.muscles.end(),
                                     [&](const Muscle& m) { return m.name == one.muscle; });
    const MusclePath path(model, skeleton, *muscle, {});
    const auto theirs = [&](double q) {
      return openSimLength(path.compiled(), postureOf(skeleton, {q})).value();
    };
    const auto [at, size] = one.jumps[0];
    EXPECT_NEAR(size, theirs(at + 2e-7) - theirs(at - 2e-7), 1e-7);
    EXPECT_GT(std::abs(size), 1e-4);
    EXPECT_NEAR(one.apart[0].from, at, 0.02);  // within a step of the search
  }
}

}  // namespace
}  // namespace bio
