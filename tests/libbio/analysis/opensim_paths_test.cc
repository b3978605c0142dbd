#include "bio/analysis/opensim_paths.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bio/path/opensim_rule.h"
#include "bio/path/path_lengths.h"
#include "bio/path/posture_samples.h"
#include "path/arm_paths.h"

namespace bio {
namespace {

using fixtures::extensor;

/// The arm of path_test.cc with one extensor over an ellipsoid, and the flexion free.
struct EllipsoidArm {
  Model model = fixtures::arm();
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

// A plane section is no shorter than the geodesic on the same side.
TEST(OpenSimPaths, OverALongEllipsoidAreLonger) {
  const EllipsoidArm arm({0.016, 0.02, 0.06});
  double most = 0;
  for (double q = 0.1; q < 2.3; q += 0.05) {
    const auto lengths = arm.at(q);
    EXPECT_GE(lengths.theirs, lengths.ours - 1e-5) << q;
    most = std::max(most, lengths.theirs - lengths.ours);
  }
  const auto found = openSimDifferences(arm.model, arm.skeleton, {}, 0.1, 2.3);
  ASSERT_EQ(found.size(), most >= leastOpenSimDifference ? 1u : 0u);
  std::printf("most %g\n", most);
  for (const auto& one : found) std::printf("%s\n", describe(one).c_str());
}

}  // namespace
}  // namespace bio
