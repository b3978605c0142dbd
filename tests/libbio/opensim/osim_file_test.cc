#include "bio/opensim/osim_file.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <numbers>

#include "bio/tables/file_error.h"
#include "support/scratch_folder.h"

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

template <class Items>
auto& findItem(Items& items, const std::string& name) {
  for (auto& item : items) {
    if (item.name == name) return item;
  }
  throw std::invalid_argument("no item called " + name);
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
  EXPECT_EQ(triceps.schutte->passiveForceLength->x.size(), 18u);  // with 1.15 twice
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

TEST_F(SharedModel, OpenSim3ArmHasTheNumbersOfItsFile) {
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
TEST_F(SharedModel, BothFormatsAreReadAsTheSameArm) {
  const Model three = readOsim(shared / "data/models/MoBL_ARMS_v3_schutte.osim");
  const Model four = readOsim(shared / "reference/elbow8_reference.osim");
  for (const Body& body : four.bodies) {
    const Body& same = findBody(three, body.name);
    EXPECT_EQ(body.mass, same.mass);
    EXPECT_EQ(body.massCenter, same.massCenter);
    // OpenSim rounds inertias to six digits.
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(body.inertia[i], same.inertia[i], 1e-7);
    EXPECT_EQ(body.geometryFiles, same.geometryFiles) << body.name;
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

TEST_F(SharedModel, OpenSim4ArmIsReadWhole) {
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

TEST_F(SharedModel, OpenSimsArm26IsReadWhole) {
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

// Number of XML elements called `tag` in the text.
std::size_t countTag(const std::string& text, const std::string& tag) {
  std::size_t count = 0;
  for (auto at = text.find("<" + tag); at != std::string::npos; at = text.find("<" + tag, at + 1)) {
    const char after = text[at + 1 + tag.size()];
    if (after == ' ' || after == '>' || after == '/') ++count;
  }
  return count;
}

TEST_F(SharedModel, WrittenBackUnchangedIsTheSameFile) {
  const support::ScratchFolder folder;
  for (const char* name : sharedModels) {
    const Model model = readOsim(shared / name);
    rewriteOsim(shared / name, model, folder / "copy.osim");
    EXPECT_EQ(support::contentOf(folder / "copy.osim"), support::contentOf(shared / name)) << name;
    EXPECT_EQ(readOsim(folder / "copy.osim"), model) << name;
  }
}

TEST_F(SharedModel, OneChangedNumberLeavesAllElseAsItWas) {
  const support::ScratchFolder folder;
  for (const char* name : sharedModels) {
    Model model = readOsim(shared / name);
    findItem(model.bodies, model.bodies.back().name).mass *= 1.25;
    rewriteOsim(shared / name, model, folder / "copy.osim");
    EXPECT_EQ(readOsim(folder / "copy.osim"), model) << name;
    // What FisherHill does not know is still there, as often as before.
    const std::string before = support::contentOf(shared / name),
                      after = support::contentOf(folder / "copy.osim");
    for (const char* tag : {"Appearance", "ControlLinear", "Ligament", "mesh_file", "VisibleObject",
                            "FrameGeometry", "TransformAxis", "prescribed_function", "Marker"}) {
      EXPECT_EQ(countTag(after, tag), countTag(before, tag)) << name << " " << tag;
    }
    EXPECT_EQ(countTag(after, "!--"), countTag(before, "!--")) << name;
  }
}

TEST_F(SharedModel, EveryKindOfChangeIsWrittenToBothFormats) {
  const support::ScratchFolder folder;
  for (const char* name :
       {"reference/elbow8_reference.osim", "data/models/MoBL_ARMS_v3_schutte.osim"}) {
    Model model = readOsim(shared / name);
    model.name = "changed";
    model.credits = "someone <else>";
    model.gravity = {0, -9.7, 0};
    findItem(model.bodies, "ulna").inertia[4] = -7.5e-5;
    findItem(model.bodies, "hand").massCenter.y() = -0.05;
    for (Joint& joint : model.joints) {
      for (Coordinate& c : joint.coordinates) {
        if (c.name == "elbow_flexion") c.locked = true, c.defaultValue = 0.7, c.rangeMax = 2.3;
      }
    }
    WrapObject& cylinder = findItem(model.wrapObjects, "TRI");
    cylinder.radius = 0.0171;
    cylinder.frame.translation.x() = 0.003;
    WrapObject& ellipsoid = findItem(model.wrapObjects, "Elbow_BIC_BRD");
    ellipsoid.shape = WrapShape::cylinder;
    ellipsoid.radius = ellipsoid.semiAxes.x();
    ellipsoid.length = 0.2;
    ellipsoid.semiAxes.setZero();
    Muscle& muscle = findItem(model.muscles, "TRIlong");
    muscle.schutte->tendonSlackLength = 0.15;
    muscle.schutte->passiveForceLength->y.back() = 2.5;
    muscle.path.points[1].location.z() = 0.01;
    muscle.path.wraps[0].firstPoint = 3;
    findItem(model.muscles, "BRD").enabled = false;
    findItem(model.muscles, "BRA").path.points[1].condition->upper = 0.8;
    model.limitForces.push_back({"stop", "elbow_flexion", 2, 100, 0.1, 50, 0.2, 0.3, true});
    model.springForces.push_back({"spring", "elbow_flexion", 1.5, 0.4, 0.2, true});
    model.expressionForces.push_back({"push", "elbow_flexion", "-0.1*q*q<2", false});
    model.fitted = {0.005, {{"curl.sto", std::string(64, 'c'), "elbow_flexion", 0.6, 0.1}}};
    rewriteOsim(shared / name, model, folder / "copy.osim");
    Model again = readOsim(folder / "copy.osim");

    // Degrees and radians round differently in the last digit; all else is exact.
    CoordinateLimitForce& stop = again.limitForces.back();
    EXPECT_EQ(stop.name, "stop");
    EXPECT_NEAR(stop.upperLimit, 2, 1e-15);
    EXPECT_NEAR(stop.upperStiffness, 100, 1e-12);
    EXPECT_NEAR(stop.damping, 0.2, 1e-15);
    stop = model.limitForces.back();
    // Rewriting the curve drops the point that was there twice, and so the remark on it.
    again.remarks = model.remarks;
    EXPECT_EQ(again, model) << name;

    // Taking the three forces away again leaves none of them behind.
    model.limitForces.pop_back();
    model.springForces.clear();
    model.expressionForces.clear();
    rewriteOsim(folder / "copy.osim", model, folder / "copy.osim");
    EXPECT_EQ(countTag(support::contentOf(folder / "copy.osim"), "SpringGeneralizedForce"), 0u);
    EXPECT_EQ(readOsim(folder / "copy.osim").limitForces.size(), model.limitForces.size());
  }
}

TEST_F(SharedModel, AFreshDocumentSaysTheSame) {
  const support::ScratchFolder folder;
  for (const char* name :
       {"reference/elbow8_reference.osim", "data/models/MoBL_ARMS_v3_schutte.osim"}) {
    const Model model = readOsim(shared / name);
    writeOsim(model, folder / "fresh.osim");
    Model again = readOsim(folder / "fresh.osim");
    ASSERT_EQ(again.limitForces.size(), model.limitForces.size());
    for (std::size_t i = 0; i < again.limitForces.size(); ++i) {
      EXPECT_NEAR(again.limitForces[i].upperStiffness / model.limitForces[i].upperStiffness, 1,
                  1e-14);
      EXPECT_NEAR(again.limitForces[i].transition / model.limitForces[i].transition, 1, 1e-14);
    }
    again.limitForces = model.limitForces;
    again.remarks = model.remarks;
    EXPECT_EQ(again, model) << name;
  }
}

TEST_F(SharedModel, MusclesOfOtherClassesAreNotWrittenAfresh) {
  const support::ScratchFolder folder;
  Model model = readOsim(shared / "data/models/arm26_v4_thelen.osim");
  model.muscles[0].hill.reset();
  model.muscles[0].className = "Delp1990Muscle_Deprecated";
  EXPECT_THROW(writeOsim(model, folder / "fresh.osim"), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(folder / "fresh.osim"));
}

}  // namespace
}  // namespace bio
