#include "bio/robot_description/robot_description.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bio/analysis/replay.h"
#include "bio/opensim/osim_file.h"
#include "bio/tables/file_error.h"
#include "bio/tables/trial.h"
#include "support/scratch_folder.h"

// One mechanism in three formats, and files that are refused.
namespace bio {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* asUrdf = R"(<robot name="double">
  <link name="world"/>
  <link name="upper"><inertial><origin xyz="0 0 -0.2" rpy="0 0 0.3"/><mass value="0.6"/>
    <inertia ixx="0.02" iyy="0.015" izz="0.004" ixy="0.001" ixz="0" iyz="0"/></inertial></link>
  <link name="lower"><inertial><origin xyz="0.01 0 -0.25"/><mass value="0.4"/>
    <inertia ixx="0.01" iyy="0.012" izz="0.003" ixy="0" ixz="0.0005" iyz="0"/></inertial></link>
  <joint name="q1" type="continuous"><origin xyz="0 0 1"/><parent link="world"/><child link="upper"/>
    <axis xyz="0 1 0"/><dynamics damping="0.02" friction="0.03"/></joint>
  <joint name="q2" type="revolute"><origin xyz="0 0 -0.3" rpy="0 0 0.5"/><parent link="upper"/><child link="lower"/>
    <axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="1" velocity="1"/><dynamics damping="0.01" friction="0"/></joint>
</robot>)";

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
  std::string refusalOf(const std::string& text) const {
    try {
      readOsim(folder_.file("r.xml", text));
    } catch (const FileError& error) {
      const std::string what = error.what();
      EXPECT_EQ(what.find('\n'), std::string::npos) << what;
      return what.substr(what.find("r.xml"));
    }
    return "no refusal";
  }
  static std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, text.npos) << from;
    return text.replace(at, from.size(), to);
  }
  support::ScratchFolder folder_;
};

TEST_F(RobotDescriptions, OneMechanismMovesAlikeInThreeFormats) {
  const auto swing = [&](const std::string& text) {
    const Model model = readOsim(folder_.file("model.xml", text));
    EXPECT_TRUE(model.warnings.empty());
    const Trial trial =
        readTrial(folder_.file("t.csv", "time,q1,q2\n0,1.2,-0.7\n1.5,,\n"), model, {});
    const MusculoskeletalSystem system(model, {{"q1", "q2"}, {}});
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
  const Eigen::Vector4d osim = swing(asOsim()), urdf = swing(asUrdf), mjcf = swing(asMjcf());
  EXPECT_GT((osim.head(2) - Eigen::Vector2d(1.2, -0.7)).norm(), 0.3);  // it has moved
  // measured 4e-14 and 3e-14
  EXPECT_LT((urdf - osim).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((mjcf - osim).cwiseAbs().maxCoeff(), 1e-9);
}

TEST_F(RobotDescriptions, SayWhatBecameOfThem) {
  const auto lines = readRobotDescription(folder_.file("r.xml", asUrdf)).translated;
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(
      lines[0],
      "URDF of “double”, translated to 2 bodies (0 without mass) and 2 coordinates of 2 joints, "
      "and to 2 dampers, 0 springs, 1 force of dry friction and 0 motors");
  EXPECT_THAT(lines[1], StartsWith("gravity 0 0 -9.81 m/s²; limits of joints are ranges"));
}

TEST_F(RobotDescriptions, AUrdfThatBreaksARuleIsRefusedInOneLine) {
  const std::string good = asUrdf;
  const std::string more = "</robot>";
  const auto with = [&](const std::string& part) { return replaced(good, more, part + more); };
  const auto without = [&](const std::string& from, const std::string& to) {
    return refusalOf(replaced(good, from, to));
  };
  EXPECT_EQ(refusalOf("<robot/>"), "r.xml:1: robot: has no link, must have one or more");
  EXPECT_EQ(
      refusalOf(with("<link name='other'/>")),
      "r.xml:12: link 'other': is a second root beside link 'world': no joint moves either, a "
      "robot must be one tree");
  EXPECT_EQ(without("parent link=\"world\"", "parent link=\"wrold\""),
            "r.xml:7: joint 'q1': parent = 'wrold', must name a link of the robot");
  EXPECT_THAT(without("parent link=\"world\"", "parent link=\"lower\""),
              HasSubstr("its links form a closed loop"));
  EXPECT_THAT(refusalOf(with("<joint name='q3' type='fixed'><parent link='world'/><child "
                             "link='upper'/></joint>")),
              HasSubstr("is a second joint that moves link 'upper' (the first is in line 7)"));
  EXPECT_THAT(
      refusalOf(with("<link name='loop'/><joint name='q3' type='fixed'><parent link='loop'/>"
                     "<child link='loop'/></joint>")),
      HasSubstr("joint 'q3': is not connected with the root link 'world'"));
  EXPECT_THAT(refusalOf(with("<link name='upper'/>")), HasSubstr("is a second link of this name"));
  EXPECT_THAT(without("joint name=\"q2\"", "joint name=\"q1\""),
              HasSubstr("is a second joint of this name (the first is in line 7)"));
  EXPECT_EQ(without("mass value=\"0.6\"", "mass value=\"-0.6\""),
            "r.xml:3: link 'upper': mass = -0.6, must be ≥ 0");
  EXPECT_THAT(without("mass value=\"0.6\"", "mass value=\"nan\""),
              HasSubstr("link 'upper': mass = 'nan', must be a finite number"));
  EXPECT_THAT(without("ixx=\"0.02\"", "ixx=\"1e999\""), HasSubstr("ixx = '1e999'"));
  EXPECT_THAT(without("ixx=\"0.02\"", ""), HasSubstr("inertia: ixx is missing"));
  EXPECT_THAT(without("axis xyz=\"0 1 0\"", "axis xyz=\"0 0 0\""), HasSubstr("axis = 0 0 0"));
  EXPECT_THAT(without("axis xyz=\"0 1 0\"", "axis xyz=\"0 1\""),
              HasSubstr("xyz has 2 numbers, must have 3"));
  EXPECT_THAT(without("type=\"continuous\"", "type=\"spherical\""),
              HasSubstr("type = 'spherical', must be revolute"));
  EXPECT_THAT(without("type=\"continuous\"", "type=\"planar\""),
              HasSubstr("a planar joint must have the axis 0 0 1"));
  EXPECT_THAT(without("lower=\"-3\"", "lower=\"4\""),
              HasSubstr("limit from 4 to 3, must not fall"));
  EXPECT_THAT(without("damping=\"0.02\"", "damping=\"-1\""),
              HasSubstr("damping = -1, must be ≥ 0"));
  EXPECT_THAT(without("<limit", "<mimic joint='q2'/><limit"), HasSubstr("follows itself"));
  EXPECT_THAT(without("<limit", "<mimic joint='q9'/><limit"),
              HasSubstr("mimic of joint 'q9', must name a joint"));
  EXPECT_THAT(refusalOf(with("<xacro:macro name='m'/>")), HasSubstr("is of xacro"));
  EXPECT_THAT(without("link name=\"lower\"", "link name=\"\""), HasSubstr("has no name"));
  EXPECT_THAT(refusalOf("<robot><link name='a'/>" + std::string(100000, '<')),
              HasSubstr("is not well-formed XML"));
  std::string deep = "<robot>";
  for (int i = 0; i < 100000; ++i) deep += "<link name='a'>";
  EXPECT_THAT(refusalOf(deep), HasSubstr("XML_ELEMENT_DEPTH_EXCEEDED"));
}

TEST_F(RobotDescriptions, AnMjcfThatBreaksARuleIsRefusedInOneLine) {
  const auto inBody = [&](const std::string& content) {
    return refusalOf("<mujoco><worldbody><body name='a'><joint name='x'/>\n" + content +
                     "</body></worldbody></mujoco>");
  };
  const std::string ball = "<geom size='0.1'/>";
  EXPECT_EQ(refusalOf("<mujoco/>"),
            "r.xml:1: mujoco: has no body in its worldbody, must have one or more");
  EXPECT_EQ(
      inBody("<geom name='g' type='mesh' mesh='m'/>"),
      "r.xml:1: body 'a': its mass would be that of geom 'g' of type mesh in line 2, which is "
      "not read: give it an <inertial>");
  EXPECT_EQ(inBody("<geom size='0'/>"), "r.xml:2: geom: size = 0, must be > 0");
  EXPECT_THAT(inBody("<geom type='box' size='1 1'/>"), HasSubstr("a box must have 3"));
  EXPECT_THAT(inBody("<geom size='0.1' mass='-1'/>"), HasSubstr("mass = -1, must be ≥ 0"));
  EXPECT_THAT(inBody("<geom size='0.1' quat='0 0 0 0'/>"), HasSubstr("quat = 0 0 0 0"));
  EXPECT_THAT(inBody("<geom size='0.1' quat='1 0 0 0' euler='0 0 1'/>"),
              HasSubstr("is turned by quat and euler, must be by one"));
  EXPECT_THAT(inBody("<geom size='0.1' class='none'/>"),
              HasSubstr("class = 'none', must name a <default>"));
  EXPECT_THAT(inBody(ball + "<body name='a'/>"), HasSubstr("is a second part called 'a'"));
  EXPECT_THAT(inBody(ball + "<joint name='x'/>"), HasSubstr("is a second joint called 'x'"));
  EXPECT_THAT(inBody(ball + "<joint type='screw'/>"), HasSubstr("type = 'screw'"));
  EXPECT_THAT(inBody(ball + "<joint axis='0 0 0'/>"), HasSubstr("axis = 0 0 0"));
  EXPECT_THAT(inBody(ball + "<joint range='3 1'/>"), HasSubstr("range = 3 to 1, must not fall"));
  EXPECT_THAT(inBody(ball + "<joint damping='nan'/>"), HasSubstr("damping = 'nan'"));
  EXPECT_THAT(inBody(ball + "<freejoint/>"), HasSubstr("has joints beside its free joint"));
  EXPECT_THAT(inBody(ball + "<replicate count='3'/>"), HasSubstr("is not supported inside a body"));
  EXPECT_THAT(inBody(ball + "<body><freejoint/></body>"),
              HasSubstr("its body must stand in the worldbody"));
  EXPECT_THAT(inBody("<inertial pos='0 0 0' mass='1' diaginertia='1 -1 1'/>"),
              HasSubstr("inertia = -1, must be ≥ 0"));
  const auto beside = [&](const std::string& content) {
    return refusalOf("<mujoco><worldbody><body name='a'><joint name='x'/>" + ball +
                     "</body></worldbody>" + content + "</mujoco>");
  };
  EXPECT_THAT(beside("<compiler coordinate='global'/>"), HasSubstr("must be local"));
  EXPECT_THAT(beside("<compiler eulerseq='xyw'/>"), HasSubstr("three letters of xyzXYZ"));
  EXPECT_THAT(beside("<compiler angle='grad'/>"), HasSubstr("must be degree or radian"));
  EXPECT_THAT(beside("<option gravity='0 0 -1e5'/>"), HasSubstr("must be at most 10000 m/s²"));
  EXPECT_THAT(beside("<wordlbody/>"), HasSubstr("is no section of an MJCF that is known"));
  EXPECT_THAT(beside("<actuator><motor joint='y'/></actuator>"), HasSubstr("joint = 'y'"));
  EXPECT_THAT(beside("<equality><joint joint1='x' joint2='x'/></equality>"),
              HasSubstr("couples a joint to itself"));
  EXPECT_THAT(beside("<include file='r.xml'/>"), HasSubstr("includes the file itself"));
  EXPECT_THAT(beside("<include file='none.xml'/>"), HasSubstr("there is no such file"));
  folder_.file("part.xml",
               "<mujoco><default class='main'>\n<joint damping='x'/></default></mujoco>");
  EXPECT_THAT(beside("<include file='part.xml'/><include file='part.xml'/>"),
              HasSubstr("'part.xml' is included twice"));
  folder_.file("loop.xml", "<mujoco><include file='loop.xml'/></mujoco>");
  EXPECT_THAT(beside("<include file='loop.xml'/>"), HasSubstr("is included twice"));
  EXPECT_THAT(beside("<default><default class='c'/><default class='c'/></default>"),
              HasSubstr("is a second default class 'c'"));
}

}  // namespace
}  // namespace bio
