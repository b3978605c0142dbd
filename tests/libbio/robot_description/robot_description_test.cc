#include "bio/robot_description/robot_description.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bio/analysis/replay.h"
#include "bio/opensim/osim_file.h"
#include "bio/tables/trial.h"
#include "libbio/robot_description/double_pendulum_urdf.h"
#include "support/scratch_folder.h"

// One mechanism in three formats.
namespace bio {
namespace {

using testing::StartsWith;

// The first tensor is turned by 0.3 about z, the second one's frame by 0.5.
std::string asMjcf() {
  const double c = std::cos(0.3), s = std::sin(0.3);
  const double xx = 0.02 * c * c + 0.015 * s * s - 2 * c * s * 0.001,
               yy = 0.02 * s * s + 0.015 * c * c + 2 * c * s * 0.001,
               xy = c * s * (0.02 - 0.015) + 0.001 * (c * c - s * s);
  return fmt::format(R"(<mujoco model="double"><compiler angle="radian"/><worldbody>
    <body name="upper" pos="0 0 1"><joint name="q1" axis="0 1 0" damping="0.02" frictionloss="0.03"/>
      <inertial pos="0 0 -0.2" mass="0.6" fullinertia="{} {} 0.004 {} 0 0"/>
      <body name="lower" pos="0 0 -0.3" euler="0 0 0.5"><joint name="q2" axis="0 1 0" range="-3 3" damping="0.01"/>
        <inertial pos="0.01 0 -0.25" mass="0.4" fullinertia="0.01 0.012 0.003 0 0.0005 0"/></body>
    </body></worldbody></mujoco>)",
                     xx, yy, xy);
}

// By hand: pins turn about z, so their frames are turned by −90° about x on both sides.
std::string asOsim() {
  const double right = std::acos(0.0), c = std::cos(0.3), s = std::sin(0.3);
  const double xx = 0.02 * c * c + 0.015 * s * s - 2 * c * s * 0.001,
               yy = 0.02 * s * s + 0.015 * c * c + 2 * c * s * 0.001,
               xy = c * s * (0.02 - 0.015) + 0.001 * (c * c - s * s);
  // R_z(0.5) R_x(−90°) as turns about x, y, z: −90°, 0.5, 0
  return fmt::format(
      R"(<OpenSimDocument Version="40000"><Model name="double"><gravity>0 0 -9.81</gravity>
<BodySet><objects>
<Body name="upper"><mass>0.6</mass><mass_center>0 0 -0.2</mass_center><inertia>{0} {1} 0.004 {2} 0 0</inertia></Body>
<Body name="lower"><mass>0.4</mass><mass_center>0.01 0 -0.25</mass_center><inertia>0.01 0.012 0.003 0 0.0005 0</inertia></Body>
</objects></BodySet><JointSet><objects>
<PinJoint name="q1"><socket_parent_frame>p</socket_parent_frame><socket_child_frame>c</socket_child_frame>
<coordinates><Coordinate name="q1"/></coordinates><frames>
<PhysicalOffsetFrame name="p"><socket_parent>/ground</socket_parent><translation>0 0 1</translation><orientation>{3} 0 0</orientation></PhysicalOffsetFrame>
<PhysicalOffsetFrame name="c"><socket_parent>/bodyset/upper</socket_parent><orientation>{3} 0 0</orientation></PhysicalOffsetFrame></frames></PinJoint>
<PinJoint name="q2"><socket_parent_frame>p</socket_parent_frame><socket_child_frame>c</socket_child_frame>
<coordinates><Coordinate name="q2"><range>-3 3</range></Coordinate></coordinates><frames>
<PhysicalOffsetFrame name="p"><socket_parent>/bodyset/upper</socket_parent><translation>0 0 -0.3</translation><orientation>{3} 0.5 0</orientation></PhysicalOffsetFrame>
<PhysicalOffsetFrame name="c"><socket_parent>/bodyset/lower</socket_parent><orientation>{3} 0 0</orientation></PhysicalOffsetFrame></frames></PinJoint>
</objects></JointSet><ForceSet><objects>
<SpringGeneralizedForce name="d1"><coordinate>q1</coordinate><viscosity>0.02</viscosity></SpringGeneralizedForce>
<SpringGeneralizedForce name="d2"><coordinate>q2</coordinate><viscosity>0.01</viscosity></SpringGeneralizedForce>
<ExpressionBasedCoordinateForce name="f1"><coordinate>q1</coordinate><expression>-0.03*tanh(qdot/0.05)</expression></ExpressionBasedCoordinateForce>
</objects></ForceSet></Model></OpenSimDocument>)",
      xx, yy, xy, -right);
}

class RobotDescriptions : public testing::Test {
 protected:
  support::ScratchFolder folder_;
};

TEST_F(RobotDescriptions, OneMechanismMovesAlikeInThreeFormats) {
  const auto swing = [&](const std::string& text) {
    const Model model = readOsim(folder_.file("model.xml", text));
    EXPECT_TRUE(model.warnings.empty());
    const Trial trial =
        readTrial(folder_.file("t.csv", "time,q1,q2\n0,1.2,-0.7\n1.5,,\n"), model, {});
    SystemOptions compiled;
    compiled.skeleton.freeCoordinates = {"q1", "q2"};
    const MusculoskeletalSystem system(model, compiled);
    SimulationOptions options;
    options.integrator = Integrator::rungeKutta4;
    options.step = 1e-3;
    const RecordedTrial recorded = recordedTrial(trial, system, options);
    const SystemState start = recorded.startAt(system, beginningOf(trial, model, system, {}).point);
    const Trajectory motion = simulate(system, recorded.excitation, start, recorded.simulation);
    EXPECT_EQ(motion.outcome, Outcome::completed) << motion.why;
    Eigen::Vector4d end;
    end << motion.q.rightCols(1), motion.qDot.rightCols(1);
    return end;
  };
  const Eigen::Vector4d osim = swing(asOsim()), urdf = swing(doublePendulumUrdf),
                        mjcf = swing(asMjcf());
  EXPECT_GT((osim.head(2) - Eigen::Vector2d(1.2, -0.7)).norm(), 0.3);  // it has moved
  // measured 3e-15 of both
  EXPECT_LT((urdf - osim).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((mjcf - osim).cwiseAbs().maxCoeff(), 1e-9);
}

TEST_F(RobotDescriptions, SayWhatBecameOfThem) {
  const auto lines =
      translationOf(readOsim(folder_.file("r.xml", doublePendulumUrdf)), ModelFormat::urdf);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(
      lines[0],
      "URDF of “double”, translated to 2 bodies (0 without mass) and 2 coordinates of 2 joints, "
      "and to 2 dampers, 0 springs, 1 force of dry friction and 0 motors");
  EXPECT_THAT(lines[1], StartsWith("gravity 0 0 -9.81 m/s²; limits of joints are ranges"));
}

}  // namespace
}  // namespace bio
