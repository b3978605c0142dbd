#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bio/opensim/osim_file.h"
#include "bio/tables/file_error.h"
#include "libbio/robot_description/double_pendulum_urdf.h"
#include "support/scratch_folder.h"

// Robot descriptions that break a rule, each once.
namespace bio {
namespace {

using testing::HasSubstr;

class RobotRefusals : public testing::Test {
 protected:
  std::string refusalOf(const std::string& text) const {
    try {
      readOsim(folder_.file("r.xml", text));
    } catch (const FileError& error) {
      const std::string what = error.what();
      EXPECT_EQ(what.find('\n'), std::string::npos) << what;
      const std::string folder = folder_.path().string() + "/";
      return what.starts_with(folder) ? what.substr(folder.size()) : what;
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

TEST_F(RobotRefusals, AUrdfThatBreaksARuleIsRefusedInOneLine) {
  const std::string good = doublePendulumUrdf;
  const std::string more = "</robot>";
  const auto with = [&](const std::string& part) { return replaced(good, more, part + more); };
  const auto without = [&](const std::string& from, const std::string& to) {
    return refusalOf(replaced(good, from, to));
  };
  EXPECT_EQ(refusalOf("<robot/>"), "r.xml:1: robot: has no link, must have one or more");
  EXPECT_EQ(
      refusalOf(with("<link name='other'/>")),
      "r.xml:11: link 'other': is a second root beside link 'world': no joint moves either, a "
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
  EXPECT_THAT(without("ixx=\"0.02\"", ""), HasSubstr("link 'upper': its <inertia> has no ixx"));
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

TEST_F(RobotRefusals, AnMjcfThatBreaksARuleIsRefusedInOneLine) {
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
