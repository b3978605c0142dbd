#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "bio/opensim/osim_file.h"
#include "bio/robot_description/robot_description.h"
#include "libbio/robot_description/hand_tree.h"
#include "support/scratch_folder.h"

// URDF: every number against the equations by hand.
namespace bio {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class Urdf : public testing::Test {
 protected:
  Model read(const std::string& text) const { return readOsim(folder_.file("robot.xml", text)); }
  support::ScratchFolder folder_;
};

constexpr const char* pendulum = R"(<robot name="pendulum">
  <link name="base"/>
  <link name="rod"><inertial><origin xyz="0 0 -0.3"/><mass value="2"/>
    <inertia ixx="0.05" iyy="0.04" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="swing" type="continuous"><parent link="base"/><child link="rod"/>
    <origin xyz="0 0 1"/><axis xyz="0 1 0"/><dynamics damping="0.3" friction="0.02"/></joint>
</robot>)";

TEST_F(Urdf, APendulumHasTheWeightAndInertiaOfItsFormulas) {
  const Model model = read(pendulum);
  EXPECT_THAT(model.warnings, IsEmpty());
  EXPECT_EQ(model.name, "pendulum");
  EXPECT_EQ(model.gravity, Vector3d(0, 0, -9.81));
  EXPECT_EQ(findCoordinate(model, "swing").defaultValue, 0);
  for (const double q : {0.0, 0.4, -1.3, 2.9}) {
    const auto at = SimbodyTree(model).dynamicsAt({{"swing", q}});
    EXPECT_NEAR(at.massMatrix(0, 0), 0.04 + 2 * 0.3 * 0.3, 1e-15);
    // the mass is at −0.3 (sin q, 0, cos q): V = −m g l cos q
    EXPECT_NEAR(at.gravityForce(0), -2 * 9.81 * 0.3 * std::sin(q), 1e-14);
  }
  ASSERT_EQ(model.springForces.size(), 1u);
  EXPECT_EQ(model.springForces[0].viscosity, 0.3);
  EXPECT_EQ(model.springForces[0].stiffness, 0);
  ASSERT_EQ(model.expressionForces.size(), 1u);
  EXPECT_EQ(model.expressionForces[0].expression, "-0.02*tanh(qdot/0.05)");
}

constexpr const char* doublePendulum = R"(<robot name="double">
  <link name="world"/>
  <link name="upper"><inertial><origin xyz="0 0 -0.2"/><mass value="0.6"/>
    <inertia ixx="0.02" iyy="0.015" izz="0.006" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="lower"><inertial><origin xyz="0 0 -0.25"/><mass value="0.4"/>
    <inertia ixx="0.01" iyy="0.012" izz="0.003" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="q1" type="continuous"><parent link="world"/><child link="upper"/><axis xyz="0 1 0"/></joint>
  <joint name="q2" type="continuous"><parent link="upper"/><child link="lower"/>
    <origin xyz="0 0 -0.3"/><axis xyz="0 1 0"/></joint>
</robot>)";

TEST_F(Urdf, ADoublePendulumAcceleratesAsItsLagrangianSays) {
  const Model model = read(doublePendulum);
  const double l = 0.3, r1 = 0.2, r2 = 0.25, m1 = 0.6, m2 = 0.4, I1 = 0.015, I2 = 0.012, g = 9.81;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> value(-3, 3);
  const SimbodyTree tree(model);
  const auto massAt = [&](const Eigen::VectorXd& q) {
    return tree.reducedTo({"q1", "q2"}, {{"q1", q[0]}, {"q2", q[1]}}).massMatrix;
  };
  for (int trial = 0; trial < 6; ++trial) {
    const Eigen::Vector2d q(value(random), value(random)), v(value(random), value(random));
    const double c = std::cos(q[1]), s = std::sin(q[1]), d = m2 * l * r2;
    Eigen::Matrix2d M;
    M << I1 + I2 + m1 * r1 * r1 + m2 * (l * l + r2 * r2) + 2 * d * c, I2 + m2 * r2 * r2 + d * c,
        I2 + m2 * r2 * r2 + d * c, I2 + m2 * r2 * r2;
    const double lower = m2 * g * r2 * std::sin(q[0] + q[1]);
    const Eigen::Vector2d weight(-(m1 * r1 + m2 * l) * g * std::sin(q[0]) - lower, -lower);
    const Eigen::Vector2d speed(d * s * (2 * v[0] * v[1] + v[1] * v[1]), -d * s * v[0] * v[0]);
    const auto found = tree.reducedTo({"q1", "q2"}, {{"q1", q[0]}, {"q2", q[1]}});
    EXPECT_LT((found.massMatrix - M).cwiseAbs().maxCoeff(), 1e-14);
    EXPECT_LT((found.gravityForce - weight).cwiseAbs().maxCoeff(), 1e-13);
    const Eigen::VectorXd accelerated =
        hand::accelerations(massAt, found.gravityForce, Eigen::VectorXd(q), Eigen::VectorXd(v));
    // measured 7e-10, of the differences of M
    EXPECT_LT((accelerated - M.ldlt().solve(weight + speed)).norm(), 1e-8);
  }
}

// Oblique frames and axes, one frame where angles about x, y, z are singular, a full tensor in
// turned axes, a slider, and links without mass between.
constexpr const char* arm = R"(<robot name="arm">
  <link name="foot"><inertial><mass value="3"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="trunk"><inertial><origin xyz="0.02 -0.03 0.2" rpy="0.3 -0.2 0.7"/><mass value="2.5"/>
    <inertia ixx="0.06" iyy="0.05" izz="0.03" ixy="0.004" ixz="-0.003" iyz="0.006"/></inertial></link>
  <link name="plate"/>
  <link name="upper"><inertial><origin xyz="0.1 0.05 -0.01" rpy="-1.1 0.4 2.2"/><mass value="1.2"/>
    <inertia ixx="0.011" iyy="0.02" izz="0.017" ixy="-0.002" ixz="0.001" iyz="0.003"/></inertial></link>
  <link name="rail"><inertial><origin xyz="0 0 0.1"/><mass value="0.7"/>
    <inertia ixx="0.004" iyy="0.005" izz="0.002" ixy="0.0005" ixz="0" iyz="-0.0004"/></inertial></link>
  <link name="tool"><inertial><origin rpy="0 1.5707963267948966 0" xyz="0.01 0.02 0.03"/><mass value="0.3"/>
    <inertia ixx="0.001" iyy="0.002" izz="0.0015" ixy="0.0001" ixz="0.0002" iyz="0.0003"/></inertial></link>
  <joint name="yaw" type="revolute"><origin xyz="0 0.1 0.4" rpy="0.1 0.2 0.3"/><parent link="foot"/><child link="trunk"/>
    <axis xyz="0 0 1"/><limit lower="-2.5" upper="1.5" effort="10" velocity="3"/></joint>
  <joint name="mount" type="fixed"><origin xyz="0.05 0 0.3" rpy="1.5707963267948966 0 0.4"/><parent link="trunk"/><child link="plate"/></joint>
  <joint name="lift" type="revolute"><origin xyz="0 0.02 0.1" rpy="0.2 -1.5707963267948966 0.5"/><parent link="plate"/><child link="upper"/>
    <axis xyz="1 2 -0.5"/><limit effort="10" velocity="3"/></joint>
  <joint name="reach" type="prismatic"><origin xyz="0.3 0 0" rpy="-0.4 0.6 1.9"/><parent link="upper"/><child link="rail"/>
    <axis xyz="0.2 0.3 1"/><limit lower="0" upper="0.4" effort="10" velocity="3"/></joint>
  <joint name="roll" type="continuous"><origin xyz="0 0 0.2" rpy="1.5707963267948966 0.5 1.5707963267948966"/><parent link="rail"/><child link="tool"/>
    <axis xyz="-1 0 0"/></joint>
</robot>)";

Matrix3d tensor(double xx, double yy, double zz, double xy, double xz, double yz) {
  Matrix3d I;
  I << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  return I;
}

std::vector<hand::Link> armByHand() {
  using hand::rollPitchYaw;
  const auto turned = [](const Matrix3d& R, const Matrix3d& I) {
    return Matrix3d(R * I * R.transpose());
  };
  const double right = std::acos(0.0);
  return {
      {-1,
       {0, 0.1, 0.4},
       rollPitchYaw(0.1, 0.2, 0.3),
       {{"yaw", true, {0, 0, 1}}},
       2.5,
       {0.02, -0.03, 0.2},
       turned(rollPitchYaw(0.3, -0.2, 0.7), tensor(0.06, 0.05, 0.03, 0.004, -0.003, 0.006))},
      {0, {0.05, 0, 0.3}, rollPitchYaw(right, 0, 0.4), {}},
      {1,
       {0, 0.02, 0.1},
       rollPitchYaw(0.2, -right, 0.5),
       {{"lift", true, {1, 2, -0.5}}},
       1.2,
       {0.1, 0.05, -0.01},
       turned(rollPitchYaw(-1.1, 0.4, 2.2), tensor(0.011, 0.02, 0.017, -0.002, 0.001, 0.003))},
      {2,
       {0.3, 0, 0},
       rollPitchYaw(-0.4, 0.6, 1.9),
       {{"reach", false, {0.2, 0.3, 1}}},
       0.7,
       {0, 0, 0.1},
       tensor(0.004, 0.005, 0.002, 0.0005, 0, -0.0004)},
      {3,
       {0, 0, 0.2},
       rollPitchYaw(right, 0.5, right),
       {{"roll", true, {-1, 0, 0}}},
       0.3,
       {0.01, 0.02, 0.03},
       turned(rollPitchYaw(0, right, 0), tensor(0.001, 0.002, 0.0015, 0.0001, 0.0002, 0.0003))}};
}

TEST_F(Urdf, AnArmOfObliqueFramesAndFullTensorsIsThatOfItsNumbers) {
  const Model model = read(arm);
  hand::expectTheSame(model, armByHand(), 2);
  const Coordinate& yaw = findCoordinate(model, "yaw");
  EXPECT_EQ(yaw.rangeMin, -2.5);
  EXPECT_EQ(yaw.rangeMax, 1.5);
  EXPECT_EQ(findCoordinate(model, "lift").rangeMin, -10);  // a limit without numbers is none
  EXPECT_FALSE(findCoordinate(model, "reach").isRotation);
  EXPECT_EQ(findBody(model, "plate").mass, 0);
}

TEST_F(Urdf, AFloatingBodyAndAPlanarOneMoveByTheirNames) {
  const std::string links =
      R"(<robot name="r"><link name="a"/><link name="b"><inertial><origin xyz="0.1 0 0"/>
    <mass value="1"/><inertia ixx="1" iyy="2" izz="2.5" ixy="0.1" ixz="0" iyz="0"/></inertial></link>
    <joint name="j" type="KIND"><origin xyz="1 2 3" rpy="0.1 0.2 0.3"/><parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint></robot>)";
  const auto of = [&](const std::string& kind) {
    std::string text = links;
    return read(text.replace(text.find("KIND"), 4, kind));
  };
  const Matrix3d R = hand::rollPitchYaw(0.1, 0.2, 0.3);
  const Matrix3d I = tensor(1, 2, 2.5, 0.1, 0, 0);
  hand::expectTheSame(of("floating"),
                      {{-1,
                        {1, 2, 3},
                        R,
                        {{"j_tx", false, {1, 0, 0}},
                         {"j_ty", false, {0, 1, 0}},
                         {"j_tz", false, {0, 0, 1}},
                         {"j_rx", true, {1, 0, 0}},
                         {"j_ry", true, {0, 1, 0}},
                         {"j_rz", true, {0, 0, 1}}},
                        1,
                        {0.1, 0, 0},
                        I}},
                      2);
  hand::expectTheSame(
      of("planar"),
      {{-1,
        {1, 2, 3},
        R,
        {{"j_x", false, {1, 0, 0}}, {"j_y", false, {0, 1, 0}}, {"j_yaw", true, {0, 0, 1}}},
        1,
        {0.1, 0, 0},
        I}},
      2);
}

TEST_F(Urdf, JointsThatMimicOthersFollowThemAlsoThroughOthers) {
  std::string text = arm;
  const auto add = [&](const std::string& joint, const std::string& mimic) {
    const std::size_t at = text.find("<axis", text.find("\"" + joint + "\""));
    text.insert(at, mimic);
  };
  add("roll", "<mimic joint='lift' multiplier='0.5' offset='0.1'/>");
  add("lift", "<mimic joint='yaw' multiplier='-2' offset='0.3'/>");
  const Model model = read(text);
  ASSERT_EQ(model.couplers.size(), 2u);
  std::map<std::string, LinearFunction> lines;
  for (const CoordinateCoupler& coupler : model.couplers) {
    EXPECT_EQ(coupler.independent, "yaw");
    lines[coupler.dependent] = std::get<LinearFunction>(coupler.function.shape);
  }
  EXPECT_EQ(lines.at("lift"), (LinearFunction{-2, 0.3}));
  EXPECT_DOUBLE_EQ(lines.at("roll").slope, -1);
  EXPECT_DOUBLE_EQ(lines.at("roll").intercept, 0.25);
}

TEST_F(Urdf, NamesThatTablesCannotHoldAreChangedWithARemark) {
  std::string text = pendulum;
  text.replace(text.find("swing"), 5, "left/swing one");
  const Model model = read(text);
  EXPECT_EQ(model.joints.back().coordinates[0].name, "left_swing_one");
  EXPECT_THAT(model.remarks,
              ElementsAre(HasSubstr("joint 'left/swing one' is called 'left_swing_one'")));
}

TEST_F(Urdf, AWorldThatIsNoLinkIsTheGroundAsInDrake) {
  std::string text = doublePendulum;
  text.erase(text.find("<link name=\"world\"/>"), 21);
  EXPECT_EQ(read(text), read(doublePendulum));
}

TEST_F(Urdf, SmallFaultsOfManyFilesAreForgiven) {
  std::string text = doublePendulum;
  text.replace(text.find("izz=\"0.003\""), 11, "izz=\"-5e-20\"");
  text.insert(text.find("</robot>"),
              "<link name='ground'/><joint name='weld' type='fixed'><parent link='lower'/><child "
              "link='ground'/><mimic joint='q1'/></joint>");
  const Model model = read(text);
  EXPECT_EQ(findBody(model, "lower").inertia[2], 0);
  EXPECT_EQ(model.bodies.back().name, "ground_link");
  EXPECT_THAT(model.couplers, IsEmpty());
}

TEST_F(Urdf, WhatIsWrittenIsAnOpenSimModelThatIsTheSame) {
  const std::string file = folder_.file("arm.urdf", arm);
  const Model model = readOsim(file);
  rewriteOsim(file, model, folder_ / "unchanged.osim");
  EXPECT_EQ(readOsim(folder_ / "unchanged.osim"), model);
  EXPECT_EQ(modelFormat(folder_ / "unchanged.osim"), ModelFormat::openSim);
  Model changed = model;
  changed.bodies[1].mass = 2.75;
  changed.springForces.push_back({"grease", "lift", 0, 0, 0.4});
  rewriteOsim(file, changed, folder_ / "changed.osim");
  EXPECT_EQ(readOsim(folder_ / "changed.osim"), changed);
  EXPECT_EQ(modelFormat(folder_ / "changed.osim"), ModelFormat::openSim);
}

TEST(ModelFormat, IsToldByTheRootElementNotByTheSuffix) {
  const support::ScratchFolder folder;
  const auto of = [&](const std::string& text) { return modelFormat(folder.file("a.txt", text)); };
  EXPECT_EQ(of(pendulum), ModelFormat::urdf);
  EXPECT_EQ(of("\xEF\xBB\xBF<?xml version='1.0'?>\n<!-- <robot> > -->\n<!DOCTYPE x>\n<mujoco "
               "model='a'/>"),
            ModelFormat::mjcf);
  EXPECT_EQ(of("<OpenSimDocument Version='40000'>"), ModelFormat::openSim);
  EXPECT_EQ(of("<robots/>"), ModelFormat::none);
  EXPECT_EQ(of("time,q\n0,1\n"), ModelFormat::none);
  EXPECT_EQ(of(""), ModelFormat::none);
  EXPECT_EQ(of("<!-- <robot>"), ModelFormat::none);
}

}  // namespace
}  // namespace bio
