#include "view/system_shape.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "bio/tables/unknown_column.h"
#include "support/elbow_model.h"
#include "support/scratch_folder.h"
#include "view/system_motion.h"

namespace {

using namespace bio;
using namespace bio::view;
using Eigen::Vector3d;
using ::testing::HasSubstr;

constexpr double degree = std::numbers::pi / 180;

const SkeletonOptions flexion = {{"elbow_flexion"}, {}};

/// The least distance of a polyline, between its points as well, from a wrap's axis [m].
double leastDistance(const WrapObject& wrap, const Placement<double>& body,
                     const std::vector<Vector3d>& line) {
  double least = 1;
  for (std::size_t k = 1; k < line.size(); ++k) {
    for (double s = 0; s <= 1; s += 0.1) {
      least =
          std::min(least, distanceFromWrap(wrap, body, line[k - 1] + s * (line[k] - line[k - 1])));
    }
  }
  return least;
}

// Over the whole range of the joint, what is drawn of a muscle that wraps stays outside the
// surface: also between the points of the polyline.
TEST(SystemPoser, MusclesNeverCutThroughTheSurfacesTheyWrap) {
  const Model model = bio::fixtures::elbowModel();
  const SystemPoser poser(model, flexion, {});
  const std::vector<double> radii(poser.muscles().size(), 0.003);
  int lying = 0;
  for (double angle = 0; angle <= 130; angle += 5) {
    const auto posture = poser.pose(Eigen::VectorXd::Constant(1, angle * degree), radii);
    for (std::size_t i = 0; i < poser.muscles().size(); ++i) {
      for (const PathWrap& used : findMuscle(model, poser.muscles()[i]).path.wraps) {
        const WrapObject& wrap = findWrapObject(model, used.wrapObject);
        const double distance =
            leastDistance(wrap, posture.bodies.at(wrap.body), posture.muscles[i].points);
        EXPECT_GE(distance, wrap.radius)
            << poser.muscles()[i] << " on " << wrap.name << " at " << angle << " deg";
        if (distance < wrap.radius + 0.0031) ++lying;
      }
    }
  }
  EXPECT_GT(lying, 50) << "no muscle lies on a surface: the test says nothing";
}

// A tube of radius b that rests on a cylinder of radius r has its centre line at r + b.
TEST(LiftedOff, PutsTheArcOneTubeRadiusAboveTheSurfaceAndLeavesTheEnds) {
  WrapObject wrap;
  wrap.radius = 0.02;
  wrap.length = 0.1;
  wrap.frame = {{0.1, 0.2, 0.3}, {0, 0.5 * std::numbers::pi, 0}};  // axis along x
  std::vector<Vector3d> line = {{0.1, 0.15, 0.32}};
  for (double angle = 0; angle <= 90; angle += 3) {
    line.push_back(Vector3d(0.1, 0.2 + 0.02 * std::sin(angle * degree),
                            0.3 + 0.02 * std::cos(angle * degree)));
  }
  line.push_back({0.1, 0.22, 0.25});
  const Placement<double> body;
  ASSERT_LT(leastDistance(wrap, body, line), 0.02);  // chords dip below the surface
  const auto lifted = liftedOff(wrap, body, line, 0.004);
  EXPECT_TRUE(lifted.front().isApprox(line.front(), 1e-12));
  EXPECT_TRUE(lifted.back().isApprox(line.back(), 1e-12));
  EXPECT_NEAR(leastDistance(wrap, body, lifted), 0.024, 1e-4);
}

TEST(LiftedOff, LeavesALineThatGoesThroughTheSurfaceAsItIs) {
  WrapObject wrap;
  wrap.radius = 0.02;
  const std::vector<Vector3d> line = {{-0.05, 0.01, 0}, {0.05, 0.01, 0}};
  EXPECT_EQ(liftedOff(wrap, {}, line, 0.004), line);
}

TEST(TubeRadius, AreaGrowsByOneSquareMillimetrePerFiveNewtons) {
  const auto area = [](double force) { return std::numbers::pi * std::pow(tubeRadius(force), 2); };
  EXPECT_DOUBLE_EQ(tubeRadius(0), 0.0025);
  EXPECT_DOUBLE_EQ(tubeRadius(-20), 0.0025);
  EXPECT_NEAR(area(5) - area(0), 1e-6, 1e-15);
  EXPECT_NEAR(area(500) - area(0), 1e-4, 1e-15);
}

// The elbow sits where the model's joint says, and the hand moves round it.
TEST(SystemPoser, PutsBodiesWhereTheJointsAre) {
  const Model model = bio::fixtures::elbowModel();
  const SystemPoser poser(model, flexion, {});
  const std::vector<double> radii(poser.muscles().size(), 0.003);
  const auto at = [&](double angle) {
    return poser.pose(Eigen::VectorXd::Constant(1, angle * degree), radii);
  };
  const auto straight = at(0), bent = at(90);
  const Vector3d elbow = straight.bodies.at("humerus").R * Vector3d(0.0061, -0.2904, -0.0123) +
                         straight.bodies.at("humerus").p;
  EXPECT_NEAR((straight.bodies.at("ulna").p - elbow).norm(), 0, 1e-12);
  EXPECT_NEAR((bent.bodies.at("ulna").p - elbow).norm(), 0, 1e-12);
  const Vector3d before = straight.bodies.at("hand").p - elbow;
  const Vector3d after = bent.bodies.at("hand").p - elbow;
  EXPECT_NEAR(before.norm(), after.norm(), 1e-12);
  EXPECT_NEAR(std::acos(before.dot(after) / before.squaredNorm()), 90 * degree, 0.1);
}

TEST(BodyShapes, ABoneReachesFromItsFrameToTheNextJoint) {
  for (const BodyShape& shape : bodyShapes(bio::fixtures::elbowModel())) {
    if (shape.name == "humerus") {
      ASSERT_EQ(shape.bones.size(), 1u);
      EXPECT_EQ(shape.bones[0].to, Vector3d(0.0061, -0.2904, -0.0123));
      EXPECT_GT(shape.bones[0].fromRadius, shape.bones[0].shaftRadius);
      EXPECT_EQ(shape.joints.size(), 1u);
    }
    if (shape.name == "clavphant") {
      EXPECT_TRUE(shape.bones.empty());
    }
  }
}

class MotionFile : public ::testing::Test {
 protected:
  SystemMotion read(const std::string& text, bool ignoreExtra = false) const {
    return readSystemMotion(scratch.file("motion.csv", text), bio::fixtures::elbowModel(),
                            ignoreExtra);
  }
  support::ScratchFolder scratch;
};

TEST_F(MotionFile, GivesStatesInRadiansAndMeasuredAnglesInDegrees) {
  const SystemMotion states = read(
      "time,/jointset/elbow/elbow_flexion/value,/jointset/elbow/elbow_flexion/speed,"
      "/forceset/BRA/activation,/forceset/BRA/fiber_length\n0,0.5,9,0.1,0.07\n1,1.5,9,0.3,0.08\n");
  EXPECT_DOUBLE_EQ(valueAt(states.time, states.coordinates.at("elbow_flexion"), 0.25), 0.75);
  EXPECT_DOUBLE_EQ(valueAt(states.time, states.activations.at("BRA"), 2), 0.3);
  EXPECT_DOUBLE_EQ(states.fibreLengths.at("BRA")[1], 0.08);
  const SystemMotion measured = read("time,BRA,elbow_flexion_deg\n0,0.1,90\n1,0.1,\n2,0.1,30\n");
  EXPECT_NEAR(measured.coordinates.at("elbow_flexion")[1], 60 * degree, 1e-12);
  EXPECT_TRUE(measured.activations.empty()) << "excitations are no activations";
}

TEST_F(MotionFile, UnderstandsTheNamesOfOpenSim3AndUnitsBehindThem) {
  const SystemMotion old = read(
      "time,elbow_flexion,elbow_flexion_u,BRA.activation,BRA.fiber_length\n0,0.5,9,0.1,0.07\n"
      "1,1.5,9,0.3,0.08\n");
  EXPECT_DOUBLE_EQ(old.coordinates.at("elbow_flexion")[1], 1.5);
  EXPECT_DOUBLE_EQ(old.activations.at("BRA")[1], 0.3);
  EXPECT_DOUBLE_EQ(old.fibreLengths.at("BRA")[1], 0.08);
  const SystemMotion paths =
      read("time,elbow/elbow_flexion/value,BRA/activation\n0,0.5,0.1\n1,1.5,0.3\n");
  EXPECT_DOUBLE_EQ(paths.coordinates.at("elbow_flexion")[1], 1.5);
  EXPECT_DOUBLE_EQ(paths.activations.at("BRA")[1], 0.3);
  const SystemMotion units = read(
      "time_s,elbow_flexion_rad,elbow_flexion_speed_rad_s,BRA.fiber_length_m,BRA.tendon_force_N\n"
      "0,0.5,9,0.07,1\n1,1.5,9,0.08,1\n");
  EXPECT_DOUBLE_EQ(units.coordinates.at("elbow_flexion")[1], 1.5);
  EXPECT_DOUBLE_EQ(units.fibreLengths.at("BRA")[1], 0.08);
}

TEST_F(MotionFile, ColumnsOfAnotherModelAreNamed) {
  const std::string knee = "time,elbow_flexion,/jointset/knee/knee_angle/value\n0,1,2\n1,1,2\n";
  try {
    read(knee);
    FAIL() << "taken";
  } catch (const bio::UnknownColumn& error) {
    EXPECT_THAT(error.what(), HasSubstr("'/jointset/knee/knee_angle/value'"));
    EXPECT_THAT(error.what(), testing::Not(HasSubstr("--"))) << "the command line is the program's";
    EXPECT_EQ(error.column(), "/jointset/knee/knee_angle/value");
  }
  EXPECT_EQ(read(knee, true).coordinates.size(), 1u);
  EXPECT_THROW(read("time,BRA\n0,0.1\n1,0.1\n"), std::invalid_argument) << "no coordinate";
}

TEST_F(MotionFile, CoordinatesThatMoveAreFreeAndTheOthersHeldWhereTheyAre) {
  const SystemMotion motion = read("time,elbow_flexion,pro_sup\n0,0.2,0.4\n1,0.9,0.4\n");
  const SkeletonOptions options =
      skeletonFor(bio::fixtures::elbowModel(), {&motion}, {{"elbow_flexion"}, {}});
  EXPECT_THAT(options.freeCoordinates, ::testing::ElementsAre("elbow_flexion"));
  EXPECT_THAT(options.lockedValues, ::testing::ElementsAre(::testing::Pair("pro_sup", 0.4)));
}

// The tendon's force comes from the muscle itself: none at a length where the tendon is slack.
TEST_F(MotionFile, TendonForcesFollowTheFibreLengths) {
  std::string header = "time,/jointset/elbow/elbow_flexion/value", row = ",1.0";
  const Model model = bio::fixtures::elbowModel();
  std::string slack = row, taut = row;
  for (const Muscle& muscle : model.muscles) {
    header += ",/forceset/" + muscle.name + "/fiber_length";
    slack += ",0.5";
    taut += ",0.02";
  }
  const SystemMotion motion = read(header + "\n0" + slack + "\n1" + taut + "\n");
  const TendonForces forces =
      tendonForces(model, {flexion, {}, {}}, motion, Eigen::Vector2d(0.0, 1.0));
  ASSERT_EQ(forces.whyNone, "");
  EXPECT_LE(forces.byMuscle.at("BRA")[0], 0);
  EXPECT_GT(forces.byMuscle.at("BRA")[1], 10);
  const SystemMotion bare = read("time,elbow_flexion\n0,1\n1,1\n");
  EXPECT_NE(tendonForces(model, {flexion, {}, {}}, bare, Eigen::Vector2d(0.0, 1.0)).whyNone, "");
}

}  // namespace
