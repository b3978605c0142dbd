// Models made elsewhere, which lie beside the project and are not part of it. CMake leaves this
// program out where they are not there; osim_file_test.cc asks the same of documents of our own.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <numbers>

#include "bio/opensim/osim_file.h"
#include "libbio/opensim/osim_round_trips.h"
#include "support/throws_saying.h"

namespace bio {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

const std::filesystem::path shared = std::filesystem::path(FISHERHILL_SOURCE_DIR) / "../shared";

std::vector<std::string> coordinateNames(const Model& model) {
  std::vector<std::string> names;
  for (const Joint& joint : model.joints) {
    for (const Coordinate& c : joint.coordinates) names.push_back(c.name);
  }
  return names;
}

template <class Items>
auto& findItem(Items& items, const std::string& name) {
  for (auto& item : items) {
    if (item.name == name) return item;
  }
  throw std::invalid_argument("no item called " + name);
}

TEST(SharedModel, ElbowReferenceIsReadWhole) {
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
  EXPECT_EQ(triceps.schutte->passiveForceLength->x.size(), 18u);  // with 1.15 twice
  EXPECT_EQ(triceps.path.wraps.at(0).firstPoint, 4);
  EXPECT_EQ(triceps.path.wraps.at(0).lastPoint, 5);
  EXPECT_EQ(model.remarks.size(), 8u);
  const WrapObject& cylinder = findWrapObject(model, "BIC_BRD");
  EXPECT_EQ(cylinder.shape, WrapShape::cylinder);
  EXPECT_DOUBLE_EQ(cylinder.radius, 0.015);
  EXPECT_TRUE(findMuscle(model, "BRA").path.points.at(1).condition);
}

TEST(SharedModel, OpenSim3ArmIsReadWhole) {
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

TEST(SharedModel, OpenSim3ArmHasTheNumbersOfItsFile) {
  const Model model = readOsim(shared / "data/models/MoBL_ARMS_v3_schutte.osim");
  const Body& ulna = findBody(model, "ulna");
  EXPECT_EQ(ulna.mass, 1.1053);
  EXPECT_EQ(ulna.massCenter, Eigen::Vector3d(0.00971783, -0.0959509, 0.024286));
  EXPECT_THAT(ulna.inertia,
              ElementsAre(0.00541309, 0.00115318, 0.00494361, 0.00031686, -7.615e-5, 0.00109169));
  const auto elbow = std::find_if(model.joints.begin(), model.joints.end(),
                                  [](const Joint& j) { return j.name == "elbow"; });
  ASSERT_NE(elbow, model.joints.end());
  EXPECT_EQ(elbow->parentBody, "humerus");
  EXPECT_EQ(elbow->childBody, "ulna");
  EXPECT_EQ(elbow->parentFrame.translation, Eigen::Vector3d(0.0061, -0.2904, -0.0123));
  EXPECT_EQ(elbow->axes[0].axis, Eigen::Vector3d(0.04940001, 0.03660001, 0.99810825));
  EXPECT_EQ(elbow->axes[0].coordinate, "elbow_flexion");
  EXPECT_EQ(findCoordinate(model, "elbow_flexion").rangeMax, 2.26892803);
  EXPECT_TRUE(findCoordinate(model, "r_z").locked);
  EXPECT_EQ(findCoordinate(model, "shoulder_elv").defaultValue, 0.52359878);
  const WrapObject& ellipsoid = findWrapObject(model, "Elbow_BIC_BRD");
  EXPECT_EQ(ellipsoid.body, "humerus");
  EXPECT_EQ(ellipsoid.semiAxes, Eigen::Vector3d(0.015, 0.015, 0.1));
  EXPECT_EQ(ellipsoid.frame.translation, Eigen::Vector3d(0.0019, -0.289, -0.014));
  EXPECT_EQ(ellipsoid.frame.orientation, Eigen::Vector3d(-0.128631, 0.137532, 0.0307178));
  EXPECT_EQ(ellipsoid.quadrant, "x");
  const PathPoint& moving = findMuscle(model, "BIClong").path.points.at(8);
  ASSERT_TRUE(moving.motion);
  EXPECT_EQ(moving.body, "radius");
  EXPECT_EQ(moving.motion->coordinate[2], "pro_sup");
  EXPECT_EQ(moving.motion->location[2].low, findCoordinate(model, "pro_sup").rangeMin);
  EXPECT_EQ(moving.motion->location[2].high, findCoordinate(model, "pro_sup").rangeMax);
  EXPECT_THAT(std::get<SplineFunction>(moving.motion->location[2].shape).y,
              ElementsAre(-0.01, -0.01358, -0.01083));
  EXPECT_THAT(std::get<PiecewiseLinearFunction>(moving.motion->location[1].shape).x,
              ElementsAre(-1.57561, 0, 1.57561));
  const PathPoint& conditional = findMuscle(model, "BRA").path.points.at(2);
  ASSERT_TRUE(conditional.condition);
  EXPECT_EQ(conditional.condition->coordinate, "elbow_flexion");
  EXPECT_EQ(conditional.condition->upper, 0.813149);
  EXPECT_EQ(findMuscle(model, "BIClong").path.wraps.at(1).lastPoint, 5);
  EXPECT_EQ(findItem(model.couplers, "wrist_hand_r3_con").independent, "flexion");
  const double degree = std::numbers::pi / 180;
  const CoordinateLimitForce& ligaments = findItem(model.limitForces, "elbow_flexion_ligaments");
  EXPECT_DOUBLE_EQ(ligaments.upperLimit, 85 * degree);
  EXPECT_DOUBLE_EQ(ligaments.lowerStiffness, 100 / degree);
  EXPECT_DOUBLE_EQ(ligaments.transition, 139.5813 * degree);
  EXPECT_EQ(ligaments.damping, 0);
}

// OpenSim itself turned the bodies, wrap objects and muscles of one file into those of the other.
TEST(SharedModel, BothFormatsAreReadAsTheSameArm) {
  const Model three = readOsim(shared / "data/models/MoBL_ARMS_v3_schutte.osim");
  const Model four = readOsim(shared / "reference/elbow8_reference.osim");
  for (const Body& body : four.bodies) {
    const Body& same = findBody(three, body.name);
    EXPECT_EQ(body.mass, same.mass);
    EXPECT_EQ(body.massCenter, same.massCenter);
    // OpenSim rounds inertias to six digits.
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(body.inertia[i], same.inertia[i], 1e-7);
    EXPECT_EQ(body.geometry, same.geometry) << body.name;
  }
  for (const WrapObject& wrap : four.wrapObjects) {
    if (wrap.name == "BIC_BRD") continue;
    EXPECT_EQ(wrap, findWrapObject(three, wrap.name)) << wrap.name;
  }
  for (const Muscle& muscle : four.muscles) {
    const Muscle& same = findMuscle(three, muscle.name);
    EXPECT_EQ(muscle.schutte, same.schutte);
    ASSERT_EQ(muscle.path.points.size(), same.path.points.size());
    for (std::size_t i = 0; i < muscle.path.points.size(); ++i) {
      if (same.path.points[i].motion) continue;
      EXPECT_EQ(muscle.path.points[i], same.path.points[i]);
    }
  }
}

TEST(SharedModel, OpenSim4ArmIsReadWhole) {
  const Model model = readOsim(shared / "data/models/MoBL_ARMS_v4_millard.osim");
  EXPECT_EQ(model.bodies.size(), 12u);
  EXPECT_EQ(coordinateNames(model).size(), 26u);
  EXPECT_EQ(model.muscles.size(), 50u);
  EXPECT_THAT(model.warnings, ElementsAre());
  ASSERT_EQ(model.elasticPaths.size(), 4u);
  EXPECT_EQ(model.elasticPaths[3].name, "coracohum");
  EXPECT_EQ(model.elasticPaths[3].kind, ElasticPathKind::ligament);
  for (const Muscle& muscle : model.muscles) EXPECT_TRUE(muscle.canBeSimulated()) << muscle.name;
}

TEST(SharedModel, OpenSimsArm26IsReadWhole) {
  const Model model = readOsim(shared / "data/models/arm26_v4_thelen.osim");
  EXPECT_EQ(model.bodies.size(), 3u);
  EXPECT_EQ(model.muscles.size(), 6u);
  EXPECT_EQ(model.wrapObjects.size(), 4u);
  EXPECT_THAT(model.warnings, ElementsAre());
  for (const Muscle& muscle : model.muscles) EXPECT_TRUE(muscle.canBeSimulated()) << muscle.name;
}

// Reading, writing and reading again
// ------------------------------------------------------------------

const char* const sharedModels[] = {
    "reference/elbow8_reference.osim", "data/models/MoBL_ARMS_v3_schutte.osim",
    "data/models/MoBL_ARMS_v4_millard.osim", "data/models/arm26_v4_thelen.osim"};

TEST(SharedModel, WrittenBackUnchangedIsTheSameFile) {
  for (const char* name : sharedModels) osim_round_trips::writesTheSameFile(shared / name);
}

TEST(SharedModel, OneChangedNumberLeavesAllElseAsItWas) {
  for (const char* name : sharedModels) osim_round_trips::leavesAllElseAsItWas(shared / name);
}

TEST(SharedModel, EveryKindOfChangeIsWrittenToBothFormats) {
  for (const char* name :
       {"reference/elbow8_reference.osim", "data/models/MoBL_ARMS_v3_schutte.osim"}) {
    osim_round_trips::writesEveryKindOfChange(shared / name, "elbow_flexion");
  }
}

TEST(SharedModel, AFreshDocumentSaysTheSame) {
  for (const char* name :
       {"reference/elbow8_reference.osim", "data/models/MoBL_ARMS_v3_schutte.osim"}) {
    osim_round_trips::aFreshDocumentSaysTheSame(shared / name);
  }
}

TEST(SharedModel, MusclesOfOtherClassesAreNotWrittenAfresh) {
  const support::ScratchFolder folder;
  Model model = readOsim(shared / "data/models/arm26_v4_thelen.osim");
  model.muscles[0].hill.reset();
  model.muscles[0].className = "Delp1990Muscle_Deprecated";
  support::throwsSaying([&] { writeOsim(model, folder / "fresh.osim"); },
                        "Delp1990Muscle_Deprecated");
  EXPECT_FALSE(std::filesystem::exists(folder / "fresh.osim"));
}

}  // namespace
}  // namespace bio
