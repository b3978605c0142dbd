#include <gmock/gmock.h>

#include <random>
#include <string>

#include "bio/opensim/osim_file.h"
#include "bio/tables/file_error.h"
#include "support/scratch_folder.h"

// Every rule of a model file, broken once; and what the reader takes from unusual but good files.
namespace bio {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// A hinge with one muscle, everything that the rules are about in as few lines as possible.
const std::string valid = R"(<?xml version="1.0" encoding="UTF-8"?>
<OpenSimDocument Version="40000">
<Model name="hinge">
<gravity>0 -9.81 0</gravity>
<BodySet name="bodyset"><objects>
<Body name="upper"><mass>2</mass><mass_center>0 -0.1 0</mass_center><inertia>0.1 0.1 0.1 0 0 0</inertia>
<WrapObjectSet name="wrapobjectset"><objects>
<WrapCylinder name="roll"><translation>0 -0.3 0</translation><quadrant>x</quadrant><radius>0.02</radius><length>0.1</length></WrapCylinder>
<WrapEllipsoid name="egg"><dimensions>0.02 0.03 0.04</dimensions></WrapEllipsoid>
</objects></WrapObjectSet></Body>
<Body name="lower"><mass>1</mass></Body>
</objects></BodySet>
<JointSet name="jointset"><objects>
<WeldJoint name="base"><socket_parent_frame>/ground</socket_parent_frame><socket_child_frame>/bodyset/upper</socket_child_frame></WeldJoint>
<CustomJoint name="elbow"><socket_parent_frame>upper_offset</socket_parent_frame><socket_child_frame>/bodyset/lower</socket_child_frame>
<coordinates><Coordinate name="q"><default_value>0.5</default_value><range>0 2</range></Coordinate></coordinates>
<frames><PhysicalOffsetFrame name="upper_offset"><socket_parent>/bodyset/upper</socket_parent><translation>0 -0.3 0</translation></PhysicalOffsetFrame></frames>
<SpatialTransform><TransformAxis name="rotation1"><coordinates>q</coordinates><axis>0 0 1</axis><LinearFunction name="function"><coefficients>1 0</coefficients></LinearFunction></TransformAxis></SpatialTransform>
</CustomJoint>
</objects></JointSet>
<ForceSet name="forceset"><objects>
<Schutte1993Muscle_Deprecated name="flexor">
<GeometryPath name="path"><PathPointSet><objects>
<PathPoint name="a"><socket_parent_frame>/bodyset/upper</socket_parent_frame><location>0.01 0 0</location></PathPoint>
<ConditionalPathPoint name="b"><socket_parent_frame>/bodyset/upper</socket_parent_frame><location>0.02 -0.2 0</location><socket_coordinate>/jointset/elbow/q</socket_coordinate><range>0 1</range></ConditionalPathPoint>
<PathPoint name="c"><socket_parent_frame>/bodyset/lower</socket_parent_frame><location>0.01 -0.1 0</location></PathPoint>
</objects></PathPointSet>
<PathWrapSet><objects><PathWrap name="w"><wrap_object>roll</wrap_object><range>2 3</range></PathWrap></objects></PathWrapSet></GeometryPath>
<max_isometric_force>500</max_isometric_force><optimal_fiber_length>0.1</optimal_fiber_length><tendon_slack_length>0.2</tendon_slack_length><pennation_angle_at_optimal>0.1</pennation_angle_at_optimal>
<time_scale>0.1</time_scale><activation1>7.667</activation1><activation2>1.459854</activation2><damping>0.017</damping>
<SimmSpline name="active_force_length_curve"><x>0 0.5 1 1.5 2</x><y>0 0.3 1 0.3 0</y></SimmSpline>
</Schutte1993Muscle_Deprecated>
<CoordinateLimitForce name="stop"><coordinate>q</coordinate><upper_limit>90</upper_limit><lower_limit>-10</lower_limit><upper_stiffness>1</upper_stiffness><lower_stiffness>1</lower_stiffness><transition>5</transition></CoordinateLimitForce>
<SpringGeneralizedForce name="spring"><coordinate>q</coordinate><viscosity>0.1</viscosity></SpringGeneralizedForce>
<ExpressionBasedCoordinateForce name="push"><coordinate>q</coordinate><expression>-q</expression></ExpressionBasedCoordinateForce>
</objects></ForceSet>
<ConstraintSet name="constraintset"><objects></objects></ConstraintSet>
</Model>
</OpenSimDocument>
)";

std::string replaced(std::string text, const std::string& old, const std::string& with) {
  const auto at = text.find(old);
  if (at == std::string::npos) throw std::logic_error("the model does not hold: " + old);
  return text.replace(at, old.size(), with);
}

class OsimRules : public testing::Test {
 protected:
  Model read(const std::string& text) const { return readOsim(folder_.file("m.osim", text)); }

  // The line that the reader complains with, without the folder.
  std::string messageOf(const std::string& text) const {
    try {
      read(text);
    } catch (const FileError& error) {
      const std::string what = error.what();
      EXPECT_EQ(what.find('\n'), std::string::npos) << what;
      return what.substr(folder_.path().string().size() + 1);
    }
    return "read without complaint";
  }
  std::string messageAfter(const std::string& old, const std::string& with) const {
    return messageOf(replaced(valid, old, with));
  }
  support::ScratchFolder folder_;
};

TEST_F(OsimRules, TheUnspoiledModelIsRead) {
  const Model model = read(valid);
  EXPECT_EQ(model.bodies.size(), 2u);
  EXPECT_EQ(model.joints[1].parentFrame.translation, Eigen::Vector3d(0, -0.3, 0));
  EXPECT_EQ(model.muscles[0].path.points.size(), 3u);
  EXPECT_THAT(model.warnings, IsEmpty());
}

TEST_F(OsimRules, FilesThatAreNoModel) {
  EXPECT_EQ(messageOf(""), "m.osim: is empty, must be an OpenSim model");
  EXPECT_EQ(messageOf(" \n\n"), "m.osim: is empty, must be an OpenSim model");
  EXPECT_THAT(messageOf("time,BRA\n0,1\n"), HasSubstr("m.osim:"));
  EXPECT_THAT(messageOf(valid.substr(0, valid.size() / 2)), HasSubstr("is not well-formed XML"));
  EXPECT_THAT(messageAfter("</Body>", ""), HasSubstr("is not well-formed XML"));
  EXPECT_EQ(messageOf("<mujoco/>"),
            "m.osim:1: mujoco: root element is mujoco, must be OpenSimDocument");
  EXPECT_EQ(messageOf("<OpenSimDocument Version=\"40000\"/>"),
            "m.osim:1: OpenSimDocument: holds no Model, must hold one");
  EXPECT_EQ(messageAfter("Version=\"40000\"", "Version=\"four\""),
            "m.osim:2: OpenSimDocument: Version = 'four', must be 10000 or more");
  EXPECT_EQ(
      messageAfter("<JointSet name", "<JointSet file=\"joints.xml\" name"),
      "m.osim:13: JointSet 'jointset': is kept in another file ('joints.xml'), must be in this "
      "one");
  EXPECT_THAT([&] { readOsim(folder_ / "none.osim"); },
              testing::ThrowsMessage<FileError>(HasSubstr("none.osim: there is no such file")));
  EXPECT_THAT([&] { readOsim(folder_.path()); },
              testing::ThrowsMessage<FileError>(HasSubstr("is a directory, must be a file")));
}

TEST_F(OsimRules, Bodies) {
  EXPECT_EQ(messageAfter("<mass>1<", "<mass>-1<"),
            "m.osim:11: Body 'lower': mass = -1 kg, must be ≥ 0");
  EXPECT_EQ(messageAfter("<mass>1<", "<mass>nan<"),
            "m.osim:11: Body 'lower': mass = nan kg, must be finite");
  EXPECT_EQ(messageAfter("<mass>1<", "<mass>1e999<"),
            "m.osim:11: Body 'lower': mass = '1e999', must be a number");
  EXPECT_EQ(messageAfter("<mass>1<", "<mass>one<"),
            "m.osim:11: Body 'lower': mass = 'one', must be a number");
  EXPECT_EQ(messageAfter("<mass>1</mass>", ""),
            "m.osim:11: Body 'lower': mass is missing, must be given");
  EXPECT_EQ(messageAfter("0 -0.1 0<", "0 -0.1<"),
            "m.osim:6: Body 'upper': mass_center has 2 numbers, must have 3");
  EXPECT_EQ(messageAfter("0.1 0.1 0.1 0 0 0", "0.1 -0.1 0.1 0 0 0"),
            "m.osim:6: Body 'upper': inertia about y = -0.1 kg m², must be ≥ 0");
  EXPECT_EQ(messageAfter("0.1 0.1 0.1 0 0 0", "0.1 inf 0.1 0 0 0"),
            "m.osim:6: Body 'upper': inertia = inf kg m², must be finite");
  EXPECT_EQ(
      messageAfter("Body name=\"lower\"", "Body name=\"upper\""),
      "m.osim:11: Body 'upper': second body called 'upper' (the first is in line 6), names must "
      "be unique");
  EXPECT_EQ(messageAfter("Body name=\"lower\"", "Body"),
            "m.osim:11: Body: has no name, must have one");
  EXPECT_EQ(messageAfter("<Body name=\"lower\">",
                         "<Body name=\"lost\"><mass>1</mass></Body><Body name=\"lower\">"),
            "m.osim:11: Body 'lost': no joint moves this body, every body must be the child of one "
            "joint");
}

TEST_F(OsimRules, ABodyWithoutMassHasNoInertia) {
  const Model model =
      read(replaced(valid, "<mass>1</mass>", "<mass>0</mass><inertia>1 1 1 0 0 0</inertia>"));
  EXPECT_EQ(findBody(model, "lower").inertia, (std::array<double, 6>{}));
  EXPECT_EQ(findBody(read(valid), "upper").inertia[0], 0.1);
}

TEST_F(OsimRules, Joints) {
  EXPECT_EQ(
      messageAfter("/bodyset/upper</socket_child", "/bodyset/arm</socket_child"),
      "m.osim:14: WeldJoint 'base': socket_child_frame = '/bodyset/arm', must name a frame of "
      "the model");
  EXPECT_EQ(messageAfter("<socket_parent>/bodyset/upper", "<socket_parent>/bodyset/arm"),
            "m.osim:17: PhysicalOffsetFrame 'upper_offset' of CustomJoint 'elbow': socket_parent = "
            "'/bodyset/arm', must name a frame of the model");
  std::string ball = replaced(valid, "<WeldJoint", "<BallJoint");
  ball = replaced(ball, "</WeldJoint", "</BallJoint");
  EXPECT_EQ(
      messageOf(ball),
      "m.osim:14: BallJoint 'base': joint of class BallJoint, must be one of WeldJoint, PinJoint, "
      "SliderJoint, CustomJoint, UniversalJoint, PlanarJoint, GimbalJoint, FreeJoint");
  std::string pin = replaced(valid, "<WeldJoint", "<PinJoint");
  pin = replaced(pin, "</WeldJoint", "</PinJoint");
  EXPECT_EQ(messageOf(pin), "m.osim:14: PinJoint 'base': has 0 coordinates, must have 1");
  EXPECT_EQ(messageAfter("<range>0 2<", "<range>2 0<"),
            "m.osim:16: Coordinate 'q' of CustomJoint 'elbow': range = 2 to 0, must not fall");
  EXPECT_EQ(messageAfter("<range>0 2<", "<range>0<"),
            "m.osim:16: Coordinate 'q' of CustomJoint 'elbow': range has 1 numbers, must have 2");
  EXPECT_EQ(messageAfter("<range>0 2</range>", "<locked>maybe</locked>"),
            "m.osim:16: Coordinate 'q' of CustomJoint 'elbow': locked = 'maybe', must be true or "
            "false");
  EXPECT_EQ(
      messageAfter("<axis>0 0 1<", "<axis>0 0 0<"),
      "m.osim:18: TransformAxis 'rotation1' of CustomJoint 'elbow': axis = 0 0 0, must have a "
      "length > 0");
  EXPECT_EQ(
      messageAfter("<coordinates>q<", "<coordinates>knee<"),
      "m.osim:18: TransformAxis 'rotation1' of CustomJoint 'elbow': coordinates = 'knee', must "
      "name one coordinate of the joint");
  EXPECT_EQ(messageAfter("<coordinates>q<", "<coordinates><"),
            "m.osim:18: TransformAxis 'rotation1' of CustomJoint 'elbow': function depends on a "
            "coordinate, but coordinates is empty");
  EXPECT_EQ(messageAfter("\"rotation1\"", "\"turn\""),
            "m.osim:18: TransformAxis 'turn' of CustomJoint 'elbow': must be called rotation1–3 or "
            "translation1–3");
  EXPECT_EQ(
      messageAfter("<coefficients>1 0<", "<coefficients>1 0 3<"),
      "m.osim:18: LinearFunction 'function' of CustomJoint 'elbow': coefficients has 3 numbers, "
      "must have 2");
  const std::string step =
      replaced(valid, "<LinearFunction name=\"function\">", "<StepFunction name=\"function\">");
  EXPECT_THAT(messageOf(replaced(step, "</LinearFunction>", "</StepFunction>")),
              HasSubstr("m.osim:18: StepFunction 'function' of CustomJoint 'elbow': function of "
                        "class StepFunction, must be one of"));
  EXPECT_EQ(messageAfter("</Coordinate>", "</Coordinate><Coordinate name=\"idle\"/>"),
            "m.osim:15: CustomJoint 'elbow': coordinate 'idle' drives none of the joint's axes");
  EXPECT_EQ(
      messageAfter("</Coordinate>", "</Coordinate><Coordinate name=\"q\"/>"),
      "m.osim:16: Coordinate 'q' of CustomJoint 'elbow': second coordinate called 'q' (the first "
      "is in line 16), names must be unique");
  const std::string weld =
      "<WeldJoint name=\"again\"><socket_parent_frame>/ground</socket_parent_frame>"
      "<socket_child_frame>/bodyset/lower</socket_child_frame></WeldJoint>\n<CustomJoint";
  EXPECT_EQ(
      messageAfter("<CustomJoint", weld),
      "m.osim:16: CustomJoint 'elbow': is a second joint that moves body 'lower', a closed loop "
      "is not supported");
  EXPECT_EQ(
      messageAfter("<socket_parent_frame>/ground", "<socket_parent_frame>/bodyset/lower"),
      "m.osim:14: WeldJoint 'base': is not connected to the ground, its parents form a closed "
      "loop");
  EXPECT_EQ(messageAfter("<socket_child_frame>/bodyset/upper", "<socket_child_frame>/ground"),
            "m.osim:14: WeldJoint 'base': moves the ground, the child must be a body");
}

TEST_F(OsimRules, WrapObjects) {
  EXPECT_EQ(messageAfter("<radius>0.02<", "<radius>-0.02<"),
            "m.osim:8: WrapCylinder 'roll' of Body 'upper': radius = -0.02 m, must be > 0");
  EXPECT_EQ(messageAfter("<radius>0.02<", "<radius>0<"),
            "m.osim:8: WrapCylinder 'roll' of Body 'upper': radius = 0 m, must be > 0");
  EXPECT_EQ(messageAfter("<length>0.1</length>", ""),
            "m.osim:8: WrapCylinder 'roll' of Body 'upper': length is missing, must be given");
  EXPECT_EQ(
      messageAfter("<quadrant>x<", "<quadrant>left<"),
      "m.osim:8: WrapCylinder 'roll' of Body 'upper': quadrant = 'left', must be all, x, +x, -x, "
      "y, +y, -y, z, +z or -z");
  EXPECT_EQ(
      messageAfter("0.02 0.03 0.04", "0.02 0 0.04"),
      "m.osim:9: WrapEllipsoid 'egg' of Body 'upper': dimensions = 0.02 0 0.04 m, must be > 0");
  EXPECT_EQ(messageAfter("\"egg\"", "\"roll\""),
            "m.osim:9: WrapEllipsoid 'roll' of Body 'upper': second wrap object called 'roll' (the "
            "first is in line 8), names must be unique");
}

TEST_F(OsimRules, Paths) {
  const std::string muscle = " of Schutte1993Muscle_Deprecated 'flexor': ";
  EXPECT_EQ(messageAfter("<wrap_object>roll<", "<wrap_object>wheel<"),
            "m.osim:28: PathWrap 'w'" + muscle +
                "wrap_object = 'wheel', must name a wrap object of the model");
  EXPECT_EQ(messageAfter("<range>2 3<", "<range>2 4<"),
            "m.osim:28: PathWrap 'w'" + muscle +
                "range = 2 4, must be rising numbers of the path's 3 points, or -1");
  EXPECT_EQ(messageAfter("<range>2 3<", "<range>3 2<"),
            "m.osim:28: PathWrap 'w'" + muscle +
                "range = 3 2, must be rising numbers of the path's 3 points, or -1");
  EXPECT_EQ(messageAfter("<range>2 3<", "<range>1.5 3<"),
            "m.osim:28: PathWrap 'w'" + muscle +
                "range = 1.5 3, must be rising numbers of the path's 3 points, or -1");
  EXPECT_EQ(messageAfter("/bodyset/lower</socket_parent_frame><location>",
                         "/bodyset/hand</socket_parent_frame><location>"),
            "m.osim:26: PathPoint 'c'" + muscle +
                "socket_parent_frame = '/bodyset/hand', must name a frame of the model");
  EXPECT_EQ(messageAfter("<location>0.01 0 0<", "<location>0.01 0 x<"),
            "m.osim:24: PathPoint 'a'" + muscle + "location = 'x', must be a number");
  EXPECT_EQ(messageAfter("/jointset/elbow/q<", "/jointset/elbow/p<"),
            "m.osim:25: ConditionalPathPoint 'b'" + muscle +
                "socket_coordinate = 'p', must name a coordinate of the model");
  EXPECT_EQ(messageAfter("<range>0 1<", "<range>1 0<"),
            "m.osim:25: ConditionalPathPoint 'b'" + muscle + "range = 1 to 0, must not fall");
  const auto first = valid.find("<ConditionalPathPoint"),
             last = valid.find("</objects></PathPointSet>");
  EXPECT_EQ(messageOf(valid.substr(0, first) + valid.substr(last)),
            "m.osim:23: Schutte1993Muscle_Deprecated 'flexor': its path has 1 points, must have at "
            "least 2");
  EXPECT_EQ(messageAfter("<ConditionalPathPoint name=\"b\">",
                         "<SlidingPathPoint name=\"s\"><socket_parent_frame>/ground"
                         "</socket_parent_frame><location>0 0 0</location></SlidingPathPoint>"
                         "<ConditionalPathPoint name=\"b\">"),
            "m.osim:25: SlidingPathPoint 's'" + muscle +
                "path point of class SlidingPathPoint, must be PathPoint, ConditionalPathPoint or "
                "MovingPathPoint");
}

TEST_F(OsimRules, Muscles) {
  const std::string muscle = "Schutte1993Muscle_Deprecated 'flexor': ";
  EXPECT_EQ(messageAfter("<max_isometric_force>500<", "<max_isometric_force>0<"),
            "m.osim:29: " + muscle + "max_isometric_force = 0 N, must be > 0");
  EXPECT_EQ(messageAfter("<optimal_fiber_length>0.1<", "<optimal_fiber_length>-0.1<"),
            "m.osim:29: " + muscle + "optimal_fiber_length = -0.1 m, must be > 0");
  EXPECT_EQ(messageAfter("<tendon_slack_length>0.2<", "<tendon_slack_length>NaN<"),
            "m.osim:29: " + muscle + "tendon_slack_length = NaN m, must be finite");
  EXPECT_EQ(messageAfter("<pennation_angle_at_optimal>0.1<", "<pennation_angle_at_optimal>12<"),
            "m.osim:29: " + muscle + "pennation_angle_at_optimal = 12 rad, must be < π/2");
  EXPECT_EQ(messageAfter("<time_scale>0.1<", "<time_scale>0<"),
            "m.osim:30: " + muscle + "time_scale = 0 s, must be > 0");
  EXPECT_EQ(messageAfter("<damping>0.017<", "<damping>0<"),
            "m.osim:30: " + muscle + "damping = 0, must be > 0");
  EXPECT_EQ(messageAfter("<damping>", "<min_control>1</min_control><damping>"),
            "m.osim:22: " + muscle + "min_control = 1, must be < max_control = 1");
  const std::string curve = "m.osim:31: SimmSpline 'active_force_length_curve' of " + muscle;
  EXPECT_EQ(messageAfter("<x>0 0.5 1 1.5 2<", "<x>0 0.5 0.4 1.5 2<"),
            curve + "x[2] = 0.4 after 0.5, must rise strictly");
  EXPECT_EQ(messageAfter("<x>0 0.5 1 1.5 2<", "<x>0 0.5 0.5 1.5 2<"),
            curve + "x[2] = 0.5 after 0.5, must rise strictly");
  EXPECT_EQ(messageAfter("<x>0 0.5 1 1.5 2<", "<x>0 0.5 1 1.5<"),
            curve + "has 4 x and 5 y, must have as many of each");
  EXPECT_EQ(messageAfter("<x>0 0.5 1 1.5 2</x><y>0 0.3 1 0.3 0<", "<x>1</x><y>1<"),
            curve + "has 1 points, must have at least 2");
  EXPECT_EQ(
      messageAfter("<CoordinateLimitForce name=\"stop\"", "<CoordinateLimitForce name=\"flexor\""),
      "m.osim:33: CoordinateLimitForce 'flexor': second force called 'flexor' (the first is in "
      "line 22), names must be unique");
}

TEST_F(OsimRules, CoordinateForces) {
  EXPECT_EQ(
      messageAfter("\"stop\"><coordinate>q<", "\"stop\"><coordinate>knee<"),
      "m.osim:33: CoordinateLimitForce 'stop': coordinate = 'knee', must name a coordinate of "
      "the model");
  EXPECT_EQ(
      messageAfter("<lower_limit>-10<", "<lower_limit>100<"),
      "m.osim:33: CoordinateLimitForce 'stop': lower_limit = 100 deg, must be ≤ upper_limit = 90 "
      "deg");
  EXPECT_EQ(messageAfter("<transition>5<", "<transition>0<"),
            "m.osim:33: CoordinateLimitForce 'stop': transition = 0 deg, must be > 0");
  EXPECT_EQ(messageAfter("<upper_stiffness>1<", "<upper_stiffness>-1<"),
            "m.osim:33: CoordinateLimitForce 'stop': upper_stiffness = -1 N m/deg, must be ≥ 0");
  EXPECT_EQ(messageAfter("<viscosity>0.1<", "<viscosity>-0.1<"),
            "m.osim:34: SpringGeneralizedForce 'spring': viscosity = -0.1 N m s/rad, must be ≥ 0");
  EXPECT_EQ(messageAfter("<expression>-q<", "<expression><"),
            "m.osim:35: ExpressionBasedCoordinateForce 'push': expression is empty, must be given");
}

TEST_F(OsimRules, Couplers) {
  const auto coupled = [](const std::string& independent, const std::string& dependent) {
    return replaced(valid, "<ConstraintSet name=\"constraintset\"><objects>",
                    "<ConstraintSet name=\"constraintset\"><objects><CoordinateCouplerConstraint "
                    "name=\"c\"><coupled_coordinates_function><LinearFunction><coefficients>2 0"
                    "</coefficients></LinearFunction></coupled_coordinates_function>"
                    "<independent_coordinate_names>" +
                        independent + "</independent_coordinate_names><dependent_coordinate_name>" +
                        dependent + "</dependent_coordinate_name></CoordinateCouplerConstraint>");
  };
  EXPECT_EQ(
      messageOf(coupled("q", "p")),
      "m.osim:37: CoordinateCouplerConstraint 'c': dependent_coordinate_name = 'p', must name a "
      "coordinate of the model");
  EXPECT_EQ(messageOf(coupled("q", "q")),
            "m.osim:37: CoordinateCouplerConstraint 'c': couples 'q' to itself, must name two "
            "coordinates");
  EXPECT_THAT(read(coupled("q r", "q")).warnings,
              ElementsAre("CoordinateCouplerConstraint 'c' is not simulated: it depends on several "
                          "coordinates"));
}

const std::string digest = std::string(60, 'a') + "0123";

std::string withFitted(const std::string& text) {
  return replaced(valid, "</ForceSet>", "</ForceSet>\n<FisherHill>" + text + "</FisherHill>");
}

std::string startOf(const std::string& sha256, const std::string& coordinate) {
  return "<trial_start><file>curl.sto</file><sha256>" + sha256 + "</sha256><coordinate>" +
         coordinate + "</coordinate><value>0.25</value><speed>-0.5</speed></trial_start>";
}

TEST_F(OsimRules, WhatWasFittedIsReadAndWritten) {
  Model model = read(withFitted("<step_s>0.005</step_s>" + startOf(digest, "q")));
  EXPECT_EQ(model.fitted.step, 0.005);
  ASSERT_EQ(model.fitted.starts.size(), 1u);
  EXPECT_EQ(model.fitted.starts[0], (TrialStart{"curl.sto", digest, "q", 0.25, -0.5}));
  EXPECT_THAT(model.warnings, IsEmpty());
  EXPECT_TRUE(read(valid).fitted.empty());

  // into a document that had none, changed there, and taken away again
  const auto original = folder_.file("original.osim", valid);
  const auto copy = folder_ / "copy.osim";
  const std::string other = std::string(64, 'b');
  model.fitted.starts.push_back({"a & b.sto", other, "q", 1.0 / 3, 0});
  rewriteOsim(original, model, copy);
  EXPECT_EQ(readOsim(copy), model);
  model.fitted.starts.erase(model.fitted.starts.begin());
  model.fitted.step = 0.0025;
  rewriteOsim(copy, model, copy);
  EXPECT_EQ(readOsim(copy), model);
  model.fitted = {};
  rewriteOsim(copy, model, copy);
  EXPECT_EQ(readOsim(copy), read(valid));
}

TEST_F(OsimRules, WhatWasFitted) {
  const auto message = [&](const std::string& text) { return messageOf(withFitted(text)); };
  EXPECT_EQ(message("<step_s>0</step_s>"), "m.osim:37: FisherHill: step_s = 0 s, must be > 0");
  EXPECT_EQ(message("<step>0.01</step>"),
            "m.osim:37: FisherHill: holds 'step', must hold nothing but step_s, trial_start");
  EXPECT_EQ(
      message("<trial_start><speeds>1</speeds></trial_start>"),
      "m.osim:37: trial_start: holds 'speeds', must hold nothing but coordinate, file, sha256, "
      "speed, value");
  EXPECT_EQ(message(startOf("abc", "q")),
            "m.osim:37: trial_start: sha256 = 'abc', must be 64 lower-case hexadecimal digits");
  EXPECT_EQ(message(startOf(digest, "knee")),
            "m.osim:37: trial_start: coordinate = 'knee', must name a coordinate of the model");
  EXPECT_EQ(message(replaced(startOf(digest, "q"), ">0.25<", ">nan<")),
            "m.osim:37: trial_start: value = nan, must be finite");
  EXPECT_EQ(message(replaced(startOf(digest, "q"), "<value>0.25</value>", "")),
            "m.osim:37: trial_start: value is missing, must be given");
  EXPECT_EQ(message(startOf(digest, "q") + startOf(digest, "q")),
            "m.osim:37: trial_start: coordinate 'q' of the trial with this sha256 has two starts, "
            "must have one");
  EXPECT_EQ(messageOf(replaced(withFitted(""), "</FisherHill>", "</FisherHill><FisherHill/>")),
            "m.osim:37: FisherHill: is there twice, must be there once");
}

// Whatever is done to the text, the reader reads it or refuses it in one line that names the file.
TEST_F(OsimRules, RandomDamageIsReadOrRefused) {
  std::mt19937 random(7);
  const std::string marks = "<>/\"'& -0x.\n";
  int refused = 0;
  const int trials = 1500;
  for (int trial = 0; trial < trials; ++trial) {
    std::string text = valid;
    for (unsigned change = 0; change <= random() % 3; ++change) {
      const auto at = random() % text.size();
      switch (random() % 4) {
        case 0:
          text.resize(at + 1);
          break;
        case 1:
          text[at] = marks[random() % marks.size()];
          break;
        case 2:
          text.erase(at, 1 + random() % 60);
          break;
        default:
          text.insert(at, text.substr(random() % text.size(), 1 + random() % 60));
      }
    }
    try {
      read(text);
    } catch (const FileError& error) {
      ++refused;
      const std::string what = error.what();
      EXPECT_TRUE(what.starts_with((folder_ / "m.osim:").string())) << what;
    }
  }
  EXPECT_GT(refused, trials / 4);
  EXPECT_LT(refused, trials);
}

// What is good ------------------------------------------------------------------------------------

TEST_F(OsimRules, DefaultsOfTheModelSpeakWhereAnElementIsSilent) {
  std::string text =
      replaced(valid, "<gravity>",
               "<defaults><Schutte1993Muscle_Deprecated name=\"default\"><damping>0.3"
               "</damping><activation1>5</activation1></Schutte1993Muscle_Deprecated>"
               "</defaults><gravity>");
  text = replaced(text, "<activation1>7.667</activation1>", "");
  const SchutteParameters p = *read(text).muscles[0].schutte;
  EXPECT_EQ(p.activation1, 5);
  EXPECT_EQ(p.damping, 0.017);  // the muscle's own
  EXPECT_FALSE(p.passiveForceLength);
  EXPECT_EQ(p.tendonForceLength.x.size(), 17u);  // the class's own curve
}

// Each with all its properties, as OpenSim 4 writes them; written and read again they are the same.
TEST_F(OsimRules, ForcesOnBodiesAreReadAndWritten) {
  const std::string body = read(valid).bodies.front().name;
  const std::string forces =
      "<PointToPointSpring "
      "name=\"band\"><socket_body1>/ground</socket_body1><socket_body2>/bodyset/" +
      body +
      "</socket_body2><point1>0.1 0.2 0.3</point1><point2>0 -0.1 "
      "0</point2><stiffness>40</stiffness>"
      "<rest_length>0.05</rest_length></PointToPointSpring>"
      "<BushingForce name=\"sleeve\"><socket_frame1>in_ground</socket_frame1>"
      "<socket_frame2>/bodyset/" +
      body +
      "</socket_frame2><frames><PhysicalOffsetFrame name=\"in_ground\"><socket_parent>/ground"
      "</socket_parent><translation>0 0.1 0</translation><orientation>0.1 0 0.2</orientation>"
      "</PhysicalOffsetFrame></frames><rotational_stiffness>1 2 3</rotational_stiffness>"
      "<translational_damping>4 5 6</translational_damping></BushingForce>"
      "<PrescribedForce name=\"pull\"><socket_frame>/bodyset/" +
      body +
      "</socket_frame><forceIsGlobal>false</forceIsGlobal><FunctionSet "
      "name=\"forceFunctions\"><objects>"
      "<Constant><value>1</value></Constant><Constant><value>2</value></Constant><LinearFunction>"
      "<coefficients>3 4</coefficients></LinearFunction></objects></FunctionSet></PrescribedForce>"
      "<CoordinateActuator name=\"motor\"><coordinate>q</coordinate><optimal_force>7"
      "</optimal_force></CoordinateActuator>";
  const Model model = read(replaced(valid, "<ForceSet name=\"forceset\"><objects>",
                                    "<ForceSet name=\"forceset\"><objects>" + forces));
  EXPECT_THAT(model.warnings, IsEmpty());
  ASSERT_EQ(model.pointSprings.size(), 1u);
  EXPECT_EQ(model.pointSprings[0].body[0], "ground");
  EXPECT_EQ(model.pointSprings[0].point[1], Eigen::Vector3d(0, -0.1, 0));
  EXPECT_EQ(model.pointSprings[0].restLength, 0.05);
  ASSERT_EQ(model.bushings.size(), 1u);
  EXPECT_EQ(model.bushings[0].body[0], "ground");
  EXPECT_EQ(model.bushings[0].frame[0].orientation, Eigen::Vector3d(0.1, 0, 0.2));
  EXPECT_EQ(model.bushings[0].translationalDamping, Eigen::Vector3d(4, 5, 6));
  ASSERT_EQ(model.prescribedForces.size(), 1u);
  EXPECT_EQ(model.prescribedForces[0].forceFrame, body);
  EXPECT_EQ(model.prescribedForces[0].pointFrame, body);
  EXPECT_EQ(model.prescribedForces[0].functions.size(), 9u);
  ASSERT_EQ(model.actuators.size(), 1u);
  EXPECT_EQ(model.actuators[0].optimalForce, 7);
  const support::ScratchFolder folder;
  writeOsim(model, folder / "again.osim");
  const Model again = readOsim(folder / "again.osim");
  EXPECT_EQ(again.pointSprings, model.pointSprings);
  EXPECT_EQ(again.bushings, model.bushings);
  EXPECT_EQ(again.prescribedForces, model.prescribedForces);
  EXPECT_EQ(again.actuators, model.actuators);
}

// Written and read again, a prescribed motion is the same, in all classes of functions.
TEST_F(OsimRules, PrescribedFunctionsAreReadAndWritten) {
  const auto with = [](const std::string& function, const std::string& flag = "true") {
    return replaced(valid, "<range>0 2",
                    "<prescribed>" + flag + "</prescribed><prescribed_function>" + function +
                        "</prescribed_function><range>0 2");
  };
  const std::string points = "<x>0 0.5 1 2</x><y>0 0.3 0.2 1</y>";
  const support::ScratchFolder folder;
  for (const std::string& function :
       {std::string("<Constant><value>0.4</value></Constant>"),
        std::string("<LinearFunction><coefficients>2 0.1</coefficients></LinearFunction>"),
        "<SimmSpline>" + points + "</SimmSpline>",
        "<PiecewiseLinearFunction>" + points + "</PiecewiseLinearFunction>",
        std::string("<PolynomialFunction><coefficients>1 2 3</coefficients></PolynomialFunction>"),
        std::string("<Sine><amplitude>0.3</amplitude><omega>6.28</omega><phase>0.1</phase><offset>"
                    "0.8</offset></Sine>"),
        "<MultiplierFunction><function><SimmSpline>" + points +
            "</SimmSpline></function><scale>0.5</scale></MultiplierFunction>"}) {
    const Model model = read(with(function));
    EXPECT_THAT(model.warnings, IsEmpty()) << function;
    const Coordinate& q = findCoordinate(model, "q");
    EXPECT_TRUE(q.isPrescribed());
    ASSERT_TRUE(q.prescribedFunction) << function;
    writeOsim(model, folder / "again.osim");
    EXPECT_EQ(findCoordinate(readOsim(folder / "again.osim"), "q"), q) << function;
  }
  const auto sine = std::get<SineFunction>(
      findCoordinate(read(with("<Sine><omega>3</omega></Sine>")), "q").prescribedFunction->shape);
  EXPECT_EQ(sine, (SineFunction{1, 3, 0, 0}));
  EXPECT_FALSE(findCoordinate(read(with("<Sine/>", "false")), "q").isPrescribed());

  // what is not known is said, kept in its file, and cannot be written elsewhere
  const Model unknown = read(with("<GCVSpline>" + points + "</GCVSpline>"));
  EXPECT_THAT(unknown.warnings, ElementsAre(HasSubstr("its prescribed_function is a GCVSpline")));
  EXPECT_TRUE(findCoordinate(unknown, "q").isPrescribed());
  EXPECT_FALSE(findCoordinate(unknown, "q").prescribedFunction);
  EXPECT_THAT([&] { writeOsim(unknown, folder / "again.osim"); },
              testing::ThrowsMessage<std::invalid_argument>(HasSubstr("prescribed_function")));
}

TEST_F(OsimRules, ForcesThatAreNotSimulatedAreNamedUnlessDisabled) {
  const auto with = [](const std::string& flag) {
    return replaced(valid, "<ForceSet name=\"forceset\"><objects>",
                    "<ForceSet name=\"forceset\"><objects><HuntCrossleyForce name=\"b\">" + flag +
                        "</HuntCrossleyForce>");
  };
  EXPECT_THAT(read(with("")).warnings, ElementsAre("HuntCrossleyForce 'b' is not simulated"));
  EXPECT_THAT(read(with("<appliesForce>false</appliesForce>")).warnings, IsEmpty());
  EXPECT_THAT(read(with("<isDisabled>true</isDisabled>")).warnings, IsEmpty());
}

TEST_F(OsimRules, OtherUnitsPrescribedMotionAndNaturalSplinesAreNamed) {
  EXPECT_THAT(
      read(replaced(valid, "<gravity>", "<length_units>mm</length_units><gravity>")).warnings,
      ElementsAre("length_units = 'mm' is ignored: lengths are read as metres"));
  EXPECT_THAT(
      read(replaced(valid, "<range>0 2", "<prescribed>true</prescribed><range>0 2")).warnings,
      ElementsAre("Coordinate 'q' of CustomJoint 'elbow': is prescribed, but has no "
                  "prescribed_function: it is not prescribed"));
  std::string natural = replaced(valid, "<SimmSpline name", "<NaturalCubicSpline name");
  natural = replaced(natural, "</SimmSpline>", "</NaturalCubicSpline>");
  EXPECT_THAT(read(natural).warnings, ElementsAre(HasSubstr("end conditions of a SimmSpline")));
}

TEST_F(OsimRules, PointsAndWrapsOnOffsetFramesAreFoldedIntoTheBody) {
  // The frame is turned by 90° about z and shifted: its x-axis is the body's y-axis.
  std::string text =
      replaced(valid, "<Body name=\"lower\"><mass>1</mass>",
               "<Body name=\"lower\"><components><PhysicalOffsetFrame name=\"f\">"
               "<socket_parent>..</socket_parent><translation>1 2 3</translation>"
               "<orientation>0 0 1.5707963267948966</orientation>"
               "<WrapObjectSet><objects><WrapSphere name=\"ball\"><translation>0.5 0 0"
               "</translation><radius>0.1</radius></WrapSphere></objects>"
               "</WrapObjectSet></PhysicalOffsetFrame></components><mass>1</mass>");
  text = replaced(text, "/bodyset/lower</socket_parent_frame><location>0.01 -0.1 0<",
                  "/bodyset/lower/f</socket_parent_frame><location>0.5 0 0<");
  const Model model = read(text);
  const PathPoint& point = model.muscles[0].path.points[2];
  EXPECT_EQ(point.body, "lower");
  EXPECT_NEAR((point.location - Eigen::Vector3d(1, 2.5, 3)).norm(), 0, 1e-15);
  const WrapObject& ball = findWrapObject(model, "ball");
  EXPECT_EQ(ball.body, "lower");
  EXPECT_NEAR((ball.frame.translation - Eigen::Vector3d(1, 2.5, 3)).norm(), 0, 1e-15);
  EXPECT_NEAR(ball.frame.orientation.z(), 1.5707963267948966, 1e-15);
}

TEST_F(OsimRules, FramesMayHangOnFramesOfAComponentSet) {
  const std::string text = replaced(
      valid, "</Model>",
      "<ComponentSet><objects><PhysicalOffsetFrame name=\"outer\"><socket_parent>/bodyset/lower"
      "</socket_parent><translation>1 0 0</translation><components><PhysicalOffsetFrame "
      "name=\"inner\"><socket_parent>..</socket_parent><translation>0 1 0</translation>"
      "<WrapObjectSet><objects><WrapSphere "
      "name=\"ball\"><radius>0.1</radius></WrapSphere></objects>"
      "</WrapObjectSet></PhysicalOffsetFrame></components></PhysicalOffsetFrame></objects>"
      "</ComponentSet></Model>");
  const Model model = read(text);
  EXPECT_EQ(findWrapObject(model, "ball").body, "lower");
  EXPECT_EQ(findWrapObject(model, "ball").frame.translation, Eigen::Vector3d(1, 1, 0));
}

TEST_F(OsimRules, AngleLimitsAreDegreesButThoseOfASlideAreNot) {
  EXPECT_NEAR(read(valid).limitForces[0].upperLimit, 1.5707963267948966, 1e-15);
  EXPECT_NEAR(read(valid).limitForces[0].upperStiffness, 57.29577951308232, 1e-13);
  const std::string slide = replaced(valid, "\"rotation1\"", "\"translation1\"");
  EXPECT_FALSE(findCoordinate(read(slide), "q").isRotation);
  EXPECT_EQ(read(slide).limitForces[0].upperLimit, 90);
  EXPECT_EQ(read(slide).limitForces[0].upperStiffness, 1);
}

TEST_F(OsimRules, JointsWithFixedAxesBecomeCustomJoints) {
  const std::string planar = replaced(
      replaced(valid, "<WeldJoint name=\"base\">",
               "<PlanarJoint name=\"base\"><coordinates><Coordinate name=\"turn\"/><Coordinate "
               "name=\"x\"/><Coordinate name=\"y\"/></coordinates>"),
      "</WeldJoint>", "</PlanarJoint>");
  const Joint joint = read(planar).joints[0];
  EXPECT_EQ(joint.kind, JointKind::custom);
  EXPECT_EQ(joint.axes[2].coordinate, "turn");
  EXPECT_EQ(joint.axes[3].coordinate, "x");
  EXPECT_EQ(joint.axes[4].coordinate, "y");
  EXPECT_TRUE(joint.coordinates[0].isRotation);
  EXPECT_FALSE(joint.coordinates[2].isRotation);
  EXPECT_EQ(joint.coordinates[0].rangeMax, 10);  // OpenSim's default
}

TEST_F(OsimRules, MultipliersAreMultipliedOut) {
  const std::string text = replaced(
      replaced(valid, "<LinearFunction name=\"function\">",
               "<MultiplierFunction name=\"function\"><function><MultiplierFunction><function>"
               "<LinearFunction>"),
      "</LinearFunction>",
      "</LinearFunction></function><scale>3</scale></MultiplierFunction></function><scale>2</scale>"
      "</MultiplierFunction>");
  const Function f = read(text).joints[1].axes[0].function;
  EXPECT_EQ(f.scale, 6);
  EXPECT_EQ(std::get<LinearFunction>(f.shape).slope, 1);
}

TEST_F(OsimRules, APointGivenTwiceIsKeptAndRemarked) {
  const Model model = read(replaced(valid, "<x>0 0.5 1 1.5 2</x><y>0 0.3 1 0.3 0<",
                                    "<x>0 0.5 0.5 1 2</x><y>0 0.3 0.3 1 0<"));
  EXPECT_THAT(model.muscles[0].schutte->activeForceLength.x, ElementsAre(0, 0.5, 0.5, 1, 2));
  EXPECT_THAT(model.remarks,
              ElementsAre("SimmSpline 'active_force_length_curve' of Schutte1993Muscle_Deprecated "
                          "'flexor': the point x = 0.5 is there twice; the spline is flat there"));
  EXPECT_THAT(model.warnings, IsEmpty());
}

// Writing -----------------------------------------------------------------------------------------

TEST_F(OsimRules, AModelThatBreaksARuleIsNotWritten) {
  Model model = read(valid);
  model.bodies[1].mass = -1;
  EXPECT_THROW(writeOsim(model, folder_ / "out.osim"), FileError);
  EXPECT_THROW(rewriteOsim(folder_ / "m.osim", model, folder_ / "out.osim"), FileError);
  EXPECT_THAT(folder_.listing(), ElementsAre("m.osim"));
  EXPECT_THROW(writeOsim(read(valid), folder_ / "missing/out.osim"), FileError);
}

TEST_F(OsimRules, AChangeThatTheDocumentCannotExpressIsRefused) {
  const std::string onFrame =
      replaced(valid, "/bodyset/lower</socket_parent_frame><location>",
               "/jointset/elbow/upper_offset</socket_parent_frame><location>");
  Model model = read(onFrame);
  model.muscles[0].path.points[2].location.x() += 0.01;  // the file has it in the offset frame
  EXPECT_THAT([&] { rewriteOsim(folder_ / "m.osim", model, folder_ / "m.osim"); },
              testing::ThrowsMessage<std::invalid_argument>(
                  HasSubstr("the document cannot express the model")));
  EXPECT_EQ(support::contentOf(folder_ / "m.osim"), onFrame);
}

// The flexor of `valid` with a length by function in place of its points.
std::string withFunction(const std::string& path) {
  const auto from = valid.find("<GeometryPath"), to = valid.find("</GeometryPath>");
  return valid.substr(0, from) + path + valid.substr(to + std::string("</GeometryPath>").size());
}

std::string functionPath(const std::string& length,
                         const std::string& paths = "/jointset/elbow/q") {
  return "<FunctionBasedPath name=\"path\"><coordinate_paths>" + paths +
         "</coordinate_paths><length_function>" + length + "</length_function></FunctionBasedPath>";
}

std::string polynomialText(const std::string& coefficients, int dimension, int order) {
  return "<MultivariatePolynomialFunction><coefficients>" + coefficients +
         "</coefficients><dimension>" + std::to_string(dimension) + "</dimension><order>" +
         std::to_string(order) + "</order></MultivariatePolynomialFunction>";
}

TEST_F(OsimRules, ALengthMayBeAFunctionOfCoordinates) {
  const Model model = read(withFunction(functionPath(polynomialText("0.3 -0.02 0.001", 1, 2))));
  const Path& path = model.muscles[0].path;
  EXPECT_THAT(path.points, IsEmpty());
  ASSERT_TRUE(path.function);
  EXPECT_THAT(path.function->coordinates, ElementsAre("q"));
  EXPECT_EQ(std::get<MultivariatePolynomial>(path.function->length),
            (MultivariatePolynomial{1, 2, {0.3, -0.02, 0.001}}));
  // names of coordinates as OpenSim 4.5 had them; the property as an element of its own
  const std::string old = replaced(
      replaced(functionPath("<PolynomialFunction><coefficients>0.001 -0.02 0.3</coefficients>"
                            "</PolynomialFunction>",
                            "q"),
               "<coordinate_paths>", "<coordinates>"),
      "</coordinate_paths>", "</coordinates>");
  const Model older = read(withFunction("<path>" + old + "</path>"));
  EXPECT_EQ(std::get<Function>(older.muscles[0].path.function->length),
            (Function{1, PolynomialFunction{{0.001, -0.02, 0.3}}}));
}

TEST_F(OsimRules, AFunctionIsWrittenBackToTheDigit) {
  const std::string text = withFunction(
      functionPath(polynomialText("0.14239856695841807 -0.004885711477468105 1e-300", 1, 2)));
  const Model model = read(text);
  Model changed = model;
  changed.bodies[1].mass = 2;
  rewriteOsim(folder_.file("m.osim", text), changed, folder_.path() / "changed.osim");
  EXPECT_THAT(support::contentOf(folder_.path() / "changed.osim"),
              HasSubstr("<coefficients>0.14239856695841807 -0.004885711477468105 1e-300<"));
  EXPECT_EQ(readOsim(folder_.path() / "changed.osim").muscles, model.muscles);
  writeOsim(model, folder_.path() / "fresh.osim");
  EXPECT_EQ(readOsim(folder_.path() / "fresh.osim").muscles, model.muscles);
}

TEST_F(OsimRules, FunctionsOfALength) {
  const auto complaint = [&](const std::string& length, const std::string& paths = "q") {
    return messageOf(withFunction(functionPath(length, paths)));
  };
  const std::string line = polynomialText("0.3 -0.02", 1, 1);
  EXPECT_THAT(complaint(line, "z"),
              HasSubstr("coordinate_paths = 'z', must name a coordinate of the model"));
  EXPECT_THAT(complaint(line, "q q"), HasSubstr("coordinate_paths has 'q' twice"));
  EXPECT_THAT(complaint(line, ""), HasSubstr("coordinate_paths is empty"));
  EXPECT_THAT(complaint(""), HasSubstr("length_function is missing"));
  EXPECT_THAT(complaint(polynomialText("0.3 -0.02 1", 1, 1)),
              HasSubstr("has 3 coefficients, must have 2 (dimension 1, order 1)"));
  EXPECT_THAT(complaint(polynomialText("1 1 1", 2, 1)),
              HasSubstr("dimension = 2, must be 1, the number of coordinates"));
  EXPECT_THAT(complaint(polynomialText("1", 7, 0)), HasSubstr("dimension = 7, must be 1 to 6"));
  EXPECT_THAT(complaint(polynomialText("1", 1, -1)), HasSubstr("order"));
  EXPECT_THAT(complaint(replaced(line, "<order>1", "<order>1.5")),
              HasSubstr("order = 1.5, must be a whole number"));
  EXPECT_THAT(complaint(polynomialText("1 x", 1, 1)), HasSubstr("coefficients"));
  EXPECT_THAT(complaint("<StepFunction/>"), HasSubstr("function of class StepFunction"));
  EXPECT_THAT(messageOf(withFunction("")),
              HasSubstr("GeometryPath or FunctionBasedPath is missing"));
  const Model unused = read(withFunction(
      replaced(functionPath(line), "</FunctionBasedPath>",
               "<moment_arm_functions>" + line + "</moment_arm_functions></FunctionBasedPath>")));
  EXPECT_THAT(unused.remarks, testing::Contains(HasSubstr("moment_arm_functions of its path")));
}

}  // namespace
}  // namespace bio
