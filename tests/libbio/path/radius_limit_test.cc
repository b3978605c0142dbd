#include "bio/path/radius_limit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "bio/path/path.h"
#include "support/elbow_model.h"
#include "support/shipped_elbow.h"

namespace bio {
namespace {

using fixtures::ShippedElbow;

// The insertion of the triceps is 20.6 mm from its cylinder's axis where it is nearest; computed by
// hand from the model's numbers, hinge and cylinder.
TEST(RadiusLimit, IsWhereTheNearestPointOfAPathLies) {
  const ShippedElbow elbow;
  const auto postures = samplePostures(elbow.system.skeleton());
  int triceps = 0, others = 0;
  for (const SystemMuscle& muscle : elbow.system.muscles()) {
    const Path& path = findMuscle(elbow.model, muscle.name).path;
    for (std::size_t i = 0; i < path.wraps.size(); ++i) {
      const RadiusLimit limit = radiusLimit(muscle.path.compiled(), i, postures);
      if (path.wraps[i].wrapObject != "TRI") {
        EXPECT_GT(limit.radius, 0.045) << muscle.name;
        ++others;
        continue;
      }
      ++triceps;
      EXPECT_NEAR(limit.radius, 0.0206, 1e-5) << muscle.name;
      EXPECT_EQ(limit.point, path.points.size() - 1);
      const std::string where = describe(limit, path, elbow.system.skeleton());
      EXPECT_THAT(where, testing::StartsWith("path point " + path.points.back().name));
      EXPECT_THAT(where, testing::HasSubstr("lies inside at elbow_flexion = 5"));
    }
  }
  EXPECT_EQ(triceps, 3);
  EXPECT_EQ(others, 3);
}

// What is inside already sets no limit: nothing changes there.
TEST(RadiusLimit, LeavesOutWhatIsInsideAlready) {
  ShippedElbow elbow;
  for (WrapObject& wrap : elbow.model.wrapObjects) {
    if (wrap.name == "TRI") wrap.radius = 0.022;
  }
  const MusculoskeletalSystem system(elbow.model, ShippedElbow::options());
  const RadiusLimit limit =
      radiusLimit(system.muscles().front().path.compiled(), 0, samplePostures(system.skeleton()));
  EXPECT_NEAR(limit.radius, 0.0315, 1e-4);  // the other end of the span
}

TEST(RadiusLimit, EndsTheBoundsOfTheCatalogueAndIsRefusedBeyond) {
  const ShippedElbow elbow;
  const std::size_t radius = elbow.catalogue.find("TRI.radius");
  const ModelParameter& triceps = elbow.catalogue.parameters()[radius];
  EXPECT_NEAR(triceps.limit, 0.0206, 1e-5);
  EXPECT_NEAR(triceps.upper, 0.995 * triceps.limit, 1e-12);
  EXPECT_NEAR(triceps.lower, 0.0048, 1e-12);
  const ModelParameter& biceps =
      elbow.catalogue.parameters()[elbow.catalogue.find("BIC_BRD.radius")];
  EXPECT_NEAR(biceps.upper, 0.03, 1e-12);  // twice the radius, as before

  const auto at = [&](double value) {
    return elbow.catalogue.at({radius}, Eigen::VectorXd::Constant(1, value));
  };
  EXPECT_NO_THROW(at(triceps.upper));
  try {
    at(0.022);
    FAIL() << "22 mm was taken";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::StartsWith("TRI.radius = 0.022 m, must be below 0.020"));
    EXPECT_THAT(error.what(), testing::HasSubstr("TRIlong's path point"));
    EXPECT_THAT(error.what(), testing::HasSubstr("elbow_flexion = 5"));
  }
  EXPECT_NO_THROW(elbow.catalogue.requireBelowLimit(elbow.catalogue.find("hand.mass"), 100));
}

}  // namespace
}  // namespace bio
