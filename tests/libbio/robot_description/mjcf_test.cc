#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bio/opensim/osim_file.h"
#include "libbio/robot_description/hand_tree.h"
#include "support/scratch_folder.h"

// MJCF: every number against the equations by hand.
namespace bio {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double degree = M_PI / 180;

class Mjcf : public testing::Test {
 protected:
  Model read(const std::string& text) const { return readOsim(folder_.file("robot.mjcf", text)); }
  support::ScratchFolder folder_;
};

void movesAsByHand(const Model& model, const std::vector<hand::Link>& links, unsigned seed = 4) {
  hand::expectTheSame(model, links, 1.4, seed);
}

Matrix3d symmetric(double xx, double yy, double zz, double xy, double xz, double yz) {
  Matrix3d I;
  I << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  return I;
}

Matrix3d turned(const Matrix3d& R, const Matrix3d& I) {
  return R * I * R.transpose();
}

// One body for each way of turning a frame; a hinge off the origin, one with a reference, a slide.
constexpr const char* arm = R"(<mujoco model="arm">
  <compiler angle="degree" eulerseq="xYz"/>
  <option gravity="0.5 0 -9.7"/>
  <default>
    <joint damping="0.2"/>
    <default class="stiff"><joint stiffness="3" springref="30" damping="0.1"/>
      <default class="dry"><joint frictionloss="0.4"/></default></default>
  </default>
  <worldbody>
    <body name="one" pos="0.1 0.2 0.3" euler="10 20 -30" childclass="stiff">
      <joint name="a" axis="1 2 0" pos="0.05 -0.1 0.2" range="-90 45"/>
      <inertial pos="0.1 0 -0.2" quat="0.9 0.1 -0.3 0.2" mass="1.5" diaginertia="0.01 0.02 0.025"/>
      <frame pos="0 0.3 0" axisangle="0 1 1 40">
        <body name="two" pos="0.2 0 0" xyaxes="0 1 0.2 -1 0.1 0">
          <joint name="b" class="dry" ref="25" pos="0 0.1 0"/>
          <inertial pos="0 0.1 0" mass="0.8" fullinertia="0.004 0.005 0.006 0.0003 -0.0002 0.0004"/>
          <body name="three" zaxis="0.3 -0.2 -1">
            <joint name="c" type="slide" axis="0 1 1" class="main" limited="false" range="-1 1"/>
            <inertial pos="0.03 0 0.1" mass="0.5" diaginertia="0.001 0.002 0.002"/>
          </body>
        </body>
      </frame>
    </body>
  </worldbody>
  <actuator>
    <motor name="pull" joint="c" gear="12"/>
    <motor joint="a" gear="3 0 0 0 0 0"/>
    <general name="b" joint="b" gear="2" gainprm="5"/>
    <position name="servo" joint="b" kp="10"/>
  </actuator>
</mujoco>)";

std::vector<hand::Link> armByHand() {
  using hand::turn;
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();
  // eulerseq xYz: about x, then about the outer y, then about the moved z
  const Matrix3d one = turn(y, 20 * degree) * turn(x, 10 * degree) * turn(z, -30 * degree);
  const Matrix3d frame = turn({0, 1, 1}, 40 * degree);
  Matrix3d two;
  two.col(0) = Vector3d(0, 1, 0.2).normalized();
  const Vector3d across = Vector3d(-1, 0.1, 0) - two.col(0) * two.col(0).dot(Vector3d(-1, 0.1, 0));
  two.col(1) = across.normalized();
  two.col(2) = two.col(0).cross(two.col(1));
  const Vector3d down = Vector3d(0.3, -0.2, -1).normalized();
  const Matrix3d three = turn(z.cross(down), std::acos(down.z()));
  const Matrix3d inertial = Eigen::Quaterniond(0.9, 0.1, -0.3, 0.2).normalized().toRotationMatrix();
  return {{-1,
           {0.1, 0.2, 0.3},
           one,
           {{"a", true, {1, 2, 0}, {0.05, -0.1, 0.2}}},
           1.5,
           {0.1, 0, -0.2},
           turned(inertial, symmetric(0.01, 0.02, 0.025, 0, 0, 0))},
          {0,
           Vector3d(0, 0.3, 0) + frame * Vector3d(0.2, 0, 0),
           frame * two,
           {{"b", true, {0, 0, 1}, {0, 0.1, 0}, 25 * degree}},
           0.8,
           {0, 0.1, 0},
           symmetric(0.004, 0.005, 0.006, 0.0003, -0.0002, 0.0004)},
          {1,
           {0, 0, 0},
           three,
           {{"c", false, {0, 1, 1}}},
           0.5,
           {0.03, 0, 0.1},
           symmetric(0.001, 0.002, 0.002, 0, 0, 0)}};
}

TEST_F(Mjcf, AnArmWithEveryWayOfTurningAFrameIsThatOfItsNumbers) {
  const Model model = read(arm);
  EXPECT_EQ(model.gravity, Vector3d(0.5, 0, -9.7));
  movesAsByHand(model, armByHand());
}

TEST_F(Mjcf, CoordinatesForcesAndMotorsAreThoseOfTheClassesAndUnits) {
  const Model model = read(arm);
  const Coordinate &a = findCoordinate(model, "a"), &b = findCoordinate(model, "b"),
                   &c = findCoordinate(model, "c");
  EXPECT_DOUBLE_EQ(a.rangeMin, -M_PI / 2);
  EXPECT_DOUBLE_EQ(a.rangeMax, M_PI / 4);
  EXPECT_DOUBLE_EQ(b.defaultValue, 25 * degree);
  EXPECT_EQ(c.rangeMax, 10);  // not limited
  ASSERT_EQ(model.springForces.size(), 3u);
  EXPECT_EQ(model.springForces[0].stiffness, 3);  // of its childclass
  EXPECT_EQ(model.springForces[0].viscosity, 0.1);
  EXPECT_DOUBLE_EQ(model.springForces[0].restLength, 30 * degree);
  EXPECT_EQ(model.springForces[1].stiffness, 3);    // inherited by the class in the class
  EXPECT_EQ(model.springForces[2].viscosity, 0.2);  // of the outermost class
  EXPECT_EQ(model.springForces[2].stiffness, 0);
  ASSERT_EQ(model.expressionForces.size(), 1u);
  EXPECT_EQ(model.expressionForces[0].coordinate, "b");
  EXPECT_EQ(model.expressionForces[0].expression, "-0.4*tanh(qdot/0.05)");
  ASSERT_EQ(model.actuators.size(), 3u);
  EXPECT_EQ(model.actuators[0].name, "pull");
  EXPECT_EQ(model.actuators[0].optimalForce, 12);
  EXPECT_EQ(model.actuators[1].name, "a_motor");
  EXPECT_EQ(model.actuators[1].optimalForce, 3);
  EXPECT_EQ(model.actuators[2].name, "b_motor");  // the coordinate is called b
  EXPECT_EQ(model.actuators[2].optimalForce, 10);
  EXPECT_THAT(model.warnings,
              ElementsAre("not simulated: servos and other actuators than motors (servo)"));
  EXPECT_THAT(model.remarks, Contains(HasSubstr("general 'b' at joint 'b' is called 'b_motor'")));
}

// Solids whose moments anyone can look up; the capsule's by summing thin discs.
TEST_F(Mjcf, MassesOfGeomsAreThoseOfTheirSolids) {
  const auto bodyOf = [&](const std::string& geoms) {
    return read("<mujoco><compiler angle='radian'/><worldbody><body name='b'><joint/>" + geoms +
                "</body></worldbody></mujoco>")
        .bodies.at(0);
  };
  const Body ball = bodyOf("<geom size='0.1'/>");
  EXPECT_NEAR(ball.mass, 1000 * 4 * M_PI / 3 * 1e-3, 1e-12);
  EXPECT_NEAR(ball.inertia[0], 0.4 * ball.mass * 0.01, 1e-15);
  const Body brick = bodyOf("<geom type='box' size='0.1 0.2 0.3' density='500' pos='1 2 3'/>");
  EXPECT_NEAR(brick.mass, 500 * 0.2 * 0.4 * 0.6, 1e-12);
  EXPECT_EQ(brick.massCenter, Vector3d(1, 2, 3));
  EXPECT_NEAR(brick.inertia[0], brick.mass * (0.16 + 0.36) / 12, 1e-13);
  EXPECT_NEAR(brick.inertia[2], brick.mass * (0.04 + 0.16) / 12, 1e-13);
  const Body egg = bodyOf("<geom type='ellipsoid' size='0.1 0.2 0.3' mass='2'/>");
  EXPECT_EQ(egg.mass, 2);
  EXPECT_NEAR(egg.inertia[1], 2 * (0.01 + 0.09) / 5, 1e-15);
  const Body rod = bodyOf("<geom type='cylinder' fromto='0 0 0 0.4 0 0' size='0.05' mass='3'/>");
  EXPECT_LT((rod.massCenter - Vector3d(0.2, 0, 0)).norm(), 1e-16);
  EXPECT_NEAR(rod.inertia[0], 3 * 0.0025 / 2, 1e-15);
  EXPECT_NEAR(rod.inertia[1], 3 * (3 * 0.0025 + 0.16) / 12, 1e-15);

  const double r = 0.05, h = 0.2;
  const Body capsule = bodyOf("<geom type='capsule' size='0.05 0.2'/>");
  double mass = 0, across = 0, along = 0;
  const int discs = 200000;
  for (int i = 0; i < discs; ++i) {
    const double dz = 2 * (h + r) / discs, z = -(h + r) + (i + 0.5) * dz;
    const double beyond = std::max(0.0, std::abs(z) - h), R2 = r * r - beyond * beyond;
    const double dm = 1000 * M_PI * R2 * dz;
    mass += dm;
    along += dm * R2 / 2;
    across += dm * (R2 / 4 + z * z);
  }
  EXPECT_NEAR(capsule.mass, mass, 1e-8);  // measured 2e-10, 1e-11 and 1e-14
  EXPECT_NEAR(capsule.inertia[0], across, 1e-9);
  EXPECT_NEAR(capsule.inertia[2], along, 1e-9);

  // two balls: the mass centre between them, with the axis theorem
  const Body pair = bodyOf(
      "<geom size='0.1' mass='1' pos='1 0 0'/><geom size='0.1' mass='3' pos='-1 0 0'/>"
      "<geom type='mesh' mesh='skin' density='0' mass='0'/><geom size='9' group='7'/>");
  EXPECT_LT((pair.massCenter - Vector3d(-0.5, 0, 0)).norm(), 1e-16);
  EXPECT_NEAR(pair.inertia[0], 4 * 0.4 * 0.01, 1e-15);
  EXPECT_NEAR(pair.inertia[2], 4 * 0.4 * 0.01 + 1 * 2.25 + 3 * 0.25, 1e-14);
}

TEST_F(Mjcf, TheCompilerBoundsAndScalesMasses) {
  const auto bodiesOf = [&](const std::string& compiler) {
    return read("<mujoco><compiler " + compiler +
                "/><worldbody><body name='a'><joint/>"
                "<inertial pos='0 0 0' mass='1' diaginertia='1 1 3'/><geom size='0.1' mass='2'/>"
                "<body name='b'><joint/><geom size='0.1' mass='0.5'/></body></body></worldbody>"
                "</mujoco>")
        .bodies;
  };
  EXPECT_EQ(bodiesOf("")[0].mass, 1);
  EXPECT_EQ(bodiesOf("inertiafromgeom='true'")[0].mass, 2);
  EXPECT_EQ(bodiesOf("boundmass='0.7'")[1].mass, 0.7);
  EXPECT_NEAR(bodiesOf("boundinertia='0.1'")[1].inertia[1], 0.1, 1e-16);
  EXPECT_NEAR(bodiesOf("balanceinertia='true'")[0].inertia[2], 5.0 / 3, 1e-15);
  const auto scaled = bodiesOf("settotalmass='6'");
  EXPECT_DOUBLE_EQ(scaled[0].mass, 4);
  EXPECT_DOUBLE_EQ(scaled[1].mass, 2);
  EXPECT_DOUBLE_EQ(scaled[0].inertia[2], 12);
}

// In order, each about its own point and an axis that those before it moved: a slide after a hinge
// and a hinge about another point need joints of their own.
TEST_F(Mjcf, SeveralJointsOfABodyFollowEachOther) {
  const Model model = read(R"(<mujoco><compiler angle="radian"/><worldbody>
    <body name="base" pos="0 0 1" quat="0.8 0 0.6 0">
      <joint name="sx" type="slide" axis="1 0 0"/><joint name="sz" type="slide" axis="0 0 1"/>
      <joint name="turn" axis="0 1 0" pos="0.1 0 0"/>
      <inertial pos="0 0.1 0" mass="2" diaginertia="0.1 0.2 0.3"/>
      <body name="hip" pos="0.1 0.2 0.3">
        <joint name="h1" axis="0 1 0" pos="0 0 0.1"/><joint name="h2" axis="1 0 1" pos="0 0 0.1"/>
        <joint name="h3" axis="1 0 0" pos="0.2 0 0"/><joint name="h4" type="slide" axis="0 0 1"/>
        <inertial pos="0.1 0 0" mass="1" diaginertia="0.05 0.04 0.03"/>
      </body>
    </body></worldbody></mujoco>)");
  EXPECT_EQ(model.bodies.size(), 4u);  // two without mass between base and hip
  const Matrix3d R = Eigen::Quaterniond(0.8, 0, 0.6, 0).toRotationMatrix();
  movesAsByHand(model, {{-1,
                         {0, 0, 1},
                         R,
                         {{"sx", false, {1, 0, 0}},
                          {"sz", false, {0, 0, 1}},
                          {"turn", true, {0, 1, 0}, {0.1, 0, 0}}},
                         2,
                         {0, 0.1, 0},
                         symmetric(0.1, 0.2, 0.3, 0, 0, 0)},
                        {0,
                         {0.1, 0.2, 0.3},
                         Matrix3d::Identity(),
                         {{"h1", true, {0, 1, 0}, {0, 0, 0.1}},
                          {"h2", true, {1, 0, 1}, {0, 0, 0.1}},
                          {"h3", true, {1, 0, 0}, {0.2, 0, 0}},
                          {"h4", false, {0, 0, 1}}},
                         1,
                         {0.1, 0, 0},
                         symmetric(0.05, 0.04, 0.03, 0, 0, 0)}});
}

TEST_F(Mjcf, FreeAndBallJointsAreAnglesOfTheSameTurns) {
  const Model model = read(R"(<mujoco><worldbody>
    <body name="torso" pos="0.5 0 1.4" euler="0 0 90"><freejoint name="root"/><geom size="0.1" mass="3"/>
      <body name="arm" pos="0 0.2 0"><joint name="shoulder" type="ball" pos="0 0 0.1" damping="1"/>
        <geom type="box" size="0.1 0.2 0.3" pos="0 0 -0.3" mass="1"/></body></body>
    </worldbody></mujoco>)");
  EXPECT_EQ(findCoordinate(model, "root_tz").defaultValue, 1.4);
  EXPECT_NEAR(findCoordinate(model, "root_rz").defaultValue, M_PI / 2, 1e-15);
  EXPECT_THAT(model.warnings,
              ElementsAre("not simulated: damping of ball and free joints (shoulder)",
                          "not simulated: contacts (2 geoms may touch)"));
  EXPECT_THAT(model.remarks, ElementsAre(HasSubstr("shoulder_ry must stay within a right angle")));
  const Vector3d x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  movesAsByHand(model, {{-1,
                         {0, 0, 0},
                         Matrix3d::Identity(),
                         {{"root_tx", false, x},
                          {"root_ty", false, y},
                          {"root_tz", false, z},
                          {"root_rx", true, x},
                          {"root_ry", true, y},
                          {"root_rz", true, z}},
                         3,
                         {0, 0, 0},
                         Matrix3d::Identity() * 0.4 * 3 * 0.01},
                        {0,
                         {0, 0.2, 0},
                         Matrix3d::Identity(),
                         {{"shoulder_rx", true, x, {0, 0, 0.1}},
                          {"shoulder_ry", true, y, {0, 0, 0.1}},
                          {"shoulder_rz", true, z, {0, 0, 0.1}}},
                         1,
                         {0, 0, -0.3},
                         symmetric(0.13 / 3, 0.1 / 3, 0.05 / 3, 0, 0, 0)}});
}

TEST_F(Mjcf, EqualitiesOfJointsAreCouplersAroundTheirReferences) {
  const auto modelWith = [&](const std::string& equality) {
    return read(
        "<mujoco><compiler angle='radian'/><worldbody><body name='a'><joint name='x' ref='0.3'/>"
        "<geom size='0.1'/><body name='b'><joint name='y' ref='-0.2'/><geom size='0.1'/></body>"
        "</body></worldbody><equality>" +
        equality + "</equality></mujoco>");
  };
  const Model line = modelWith("<joint joint1='y' joint2='x' polycoef='0.1 2 0 0 0'/>");
  ASSERT_EQ(line.couplers.size(), 1u);
  // y + 0.2 = 0.1 + 2 (x − 0.3)
  const auto& straight = std::get<LinearFunction>(line.couplers[0].function.shape);
  EXPECT_DOUBLE_EQ(straight.slope, 2);
  EXPECT_DOUBLE_EQ(straight.intercept, 0.1 - 0.2 - 0.6);
  const Model curve = modelWith("<joint joint1='y' joint2='x' polycoef='0.1 2 3 -1 0.5'/>");
  const auto& c = std::get<PolynomialFunction>(curve.couplers[0].function.shape).coefficients;
  ASSERT_EQ(c.size(), 5u);
  for (const double x : {-1.0, 0.3, 2.0}) {
    const double d = x - 0.3;
    EXPECT_NEAR((((c[0] * x + c[1]) * x + c[2]) * x + c[3]) * x + c[4],
                -0.2 + 0.1 + 2 * d + 3 * d * d - d * d * d + 0.5 * d * d * d * d, 1e-14);
  }
  const Model held = modelWith("<joint joint1='y' polycoef='0.5 0 0 0 0'/>");
  EXPECT_TRUE(findCoordinate(held, "y").locked);
  EXPECT_DOUBLE_EQ(findCoordinate(held, "y").defaultValue, 0.3);
  EXPECT_THAT(modelWith("<joint joint1='y' joint2='x' active='false'/>").couplers, IsEmpty());
  EXPECT_THAT(modelWith("<weld name='grip' body1='a' body2='b'/>").warnings,
              Contains("not simulated: constraints (weld grip)"));
}

TEST_F(Mjcf, IncludedFilesAreReadAsIfTheyStoodThere) {
  folder_.file(
      "parts.xml",
      "<mujocoinclude><default class='main'><joint damping='0.7'/></default></mujocoinclude>");
  folder_.file("arm.xml",
               "<mujoco><body name='a'><joint name='x'/><geom size='0.1'/></body></mujoco>");
  const Model model = read(
      "<mujoco><include file='parts.xml'/><worldbody><include "
      "file='arm.xml'/></worldbody></mujoco>");
  EXPECT_EQ(model.bodies.at(0).name, "a");
  EXPECT_EQ(model.springForces.at(0).viscosity, 0.7);
}

TEST_F(Mjcf, WhatWouldActAndIsNotSimulatedIsNamed) {
  const Model model = read(
      R"(<mujoco><option density="1.2"><flag contact="disable" gravity="disable"/></option><worldbody>
    <body name="a" gravcomp="1"><joint name="x" armature="0.1"/><geom size="0.1"/>
      <body name="b"><joint name="y" armature="0.2"/><geom size="0.1"/></body></body></worldbody>
    <tendon><fixed name="string"><joint joint="x" coef="1"/></fixed></tendon>
    <actuator><motor name="m" tendon="string"/><velocity name="v" joint="x"/><muscle joint="y"/>
      <general name="g" joint="x" biastype="affine"/></actuator></mujoco>)");
  EXPECT_EQ(model.gravity, Vector3d(0, 0, 0));
  EXPECT_THAT(
      model.warnings,
      ElementsAre("not simulated: a medium's resistance (option density)",
                  "not simulated: compensation of gravity (gravcomp) (a)",
                  "not simulated: the rotors' inertia (armature) (x, y)",
                  "not simulated: tendons (string)", "not simulated: motors at no joint (m)",
                  "not simulated: servos and other actuators than motors (v, line 5, g)"));
}

}  // namespace
}  // namespace bio
