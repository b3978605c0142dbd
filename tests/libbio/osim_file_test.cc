#include "bio/osim_file.h"

#include <gmock/gmock.h>

#include <filesystem>

#include "bio/file_error.h"

namespace bio {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::filesystem::path shared = std::filesystem::path(FISHERHILL_SOURCE_DIR) / "../shared";

std::vector<std::string> coordinateNames(const Model& model) {
  std::vector<std::string> names;
  for (const Joint& joint : model.joints) {
    for (const Coordinate& c : joint.coordinates) names.push_back(c.name);
  }
  return names;
}

// The shared models are not part of the project; without them these tests say so and stop.
class SharedModel : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(shared)) {
      GTEST_SKIP() << "the folder ../shared with models made elsewhere is not beside the sources";
    }
  }
};

TEST_F(SharedModel, ElbowReferenceIsReadWhole) {
  const Model model = readOsim(shared / "reference/elbow8_reference.osim");
  EXPECT_EQ(model.bodies.size(), 12u);
  EXPECT_EQ(model.joints.size(), 12u);
  EXPECT_EQ(model.wrapObjects.size(), 85u);
  EXPECT_EQ(model.muscles.size(), 8u);
  EXPECT_THAT(coordinateNames(model), ElementsAre("elbow_flexion"));
  EXPECT_THAT(model.warnings, IsEmpty());
  EXPECT_EQ(model.joints.front().name,
            "groundthorax");  // parents first, though the file has elbow first
  const Muscle& triceps = findMuscle(model, "TRIlong");
  ASSERT_TRUE(triceps.schutte);
  EXPECT_DOUBLE_EQ(triceps.schutte->maxIsometricForce, 771.8);
  EXPECT_DOUBLE_EQ(triceps.schutte->damping, 0.017);
  EXPECT_EQ(triceps.schutte->passiveForceLength->x.size(), 17u);  // 18 with 1.15 twice
  EXPECT_EQ(triceps.path.wraps.at(0).firstPoint, 4);
  EXPECT_EQ(triceps.path.wraps.at(0).lastPoint, 5);
  EXPECT_EQ(model.remarks.size(), 8u);
  const WrapObject& cylinder = findWrapObject(model, "BIC_BRD");
  EXPECT_EQ(cylinder.shape, WrapShape::cylinder);
  EXPECT_DOUBLE_EQ(cylinder.radius, 0.015);
  EXPECT_TRUE(findMuscle(model, "BRA").path.points.at(1).condition);
}

TEST_F(SharedModel, OpenSim3ArmIsReadWhole) {
  const Model model = readOsim(shared / "data/models/MoBL_ARMS_v3_schutte.osim");
  EXPECT_EQ(model.bodies.size(), 12u);
  EXPECT_EQ(model.joints.size(), 12u);
  EXPECT_EQ(coordinateNames(model).size(), 21u);
  EXPECT_EQ(model.couplers.size(), 13u);
  EXPECT_EQ(model.wrapObjects.size(), 84u);
  EXPECT_EQ(model.muscles.size(), 50u);
  EXPECT_EQ(model.limitForces.size(), 14u);
  EXPECT_THAT(model.warnings, IsEmpty());
}

TEST_F(SharedModel, OpenSim4ArmIsReadWhole) {
  const Model model = readOsim(shared / "data/models/MoBL_ARMS_v4_millard.osim");
  EXPECT_EQ(model.bodies.size(), 12u);
  EXPECT_EQ(coordinateNames(model).size(), 26u);
  EXPECT_EQ(model.muscles.size(), 50u);
  EXPECT_THAT(
      model.warnings,
      ElementsAre("Ligament 's_glenohum' is not simulated",
                  "Ligament 'm_glenohum' is not simulated",
                  "Ligament 'i_glenohum' is not simulated", "Ligament 'coracohum' is not simulated",
                  HasSubstr("Millard2012EquilibriumMuscle is not simulated")));
}

TEST_F(SharedModel, OpenSimsArm26IsReadWhole) {
  const Model model = readOsim(shared / "data/models/arm26_v4_thelen.osim");
  EXPECT_EQ(model.bodies.size(), 3u);
  EXPECT_EQ(model.muscles.size(), 6u);
  EXPECT_EQ(model.wrapObjects.size(), 4u);
  EXPECT_THAT(
      model.warnings,
      ElementsAre("Thelen2003Muscle is not simulated, only the paths are used: TRIlong, TRIlat, "
                  "TRImed, BIClong, BICshort, BRA"));
}

}  // namespace
}  // namespace bio
