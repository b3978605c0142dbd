#include "libbio/opensim/osim_rules.h"

#include <random>

// Every rule of a model file, broken once.
namespace bio {
namespace {

using osim_rules::OsimRules;
using osim_rules::replaced;
using osim_rules::valid;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

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
  EXPECT_EQ(messageOf("<sdf/>"),
            "m.osim:1: sdf: root element is sdf, must be OpenSimDocument, robot (URDF) or mujoco "
            "(MJCF)");
  EXPECT_EQ(messageOf("<OpenSimDocument Version=\"40000\"/>"),
            "m.osim:1: OpenSimDocument: holds no Model, must hold one");
  EXPECT_EQ(messageAfter("Version=\"40000\"", "Version=\"four\""),
            "m.osim:2: OpenSimDocument: Version = 'four', must be 20000 or more");
  EXPECT_EQ(
      messageAfter("<JointSet name", "<JointSet file=\"joints.xml\" name"),
      "m.osim:13: JointSet 'jointset': is kept in another file ('joints.xml'), must be in this "
      "one");
  EXPECT_THAT([&] { readOsim(folder_ / "none.osim"); },
              testing::ThrowsMessage<FileError>(HasSubstr("none.osim: there is no such file")));
  EXPECT_THAT([&] { readOsim(folder_.path()); },
              testing::ThrowsMessage<FileError>(HasSubstr("is a directory, must be a file")));
}

// Whatever else such a file lacks: OpenSim 1 writes joints and engines that no reader knows.
TEST_F(OsimRules, FilesOfOpenSim1AreTooOld) {
  for (const std::string version : {"10500", "10900", "10905", "19999", "1.09", "1"}) {
    SCOPED_TRACE(version);
    const std::string attribute = "Version=\"" + version + "\"";
    const std::string expected =
        "OpenSimDocument: Version = '" + version +
        "', a file of OpenSim 1 is too old: open it once in OpenSim (3.3 or newer) and save it";
    EXPECT_EQ(messageAfter("Version=\"40000\"", attribute), "m.osim:2: " + expected);
    EXPECT_EQ(messageOf("<OpenSimDocument " + attribute + "><Model><SimbodyEngine/></Model>"
                        "</OpenSimDocument>"),
              "m.osim:1: " + expected);
  }
  for (const std::string version : {"2", "0.9", "9999", "-1", "nan", ""}) {
    EXPECT_EQ(messageAfter("Version=\"40000\"", "Version=\"" + version + "\""),
              "m.osim:2: OpenSimDocument: Version = '" + version + "', must be 20000 or more");
  }
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
  EXPECT_THAT(messageAfter("Body name=\"lower\"", "Body name=\"upper\""),
              HasSubstr("socket_child_frame = '/bodyset/lower', must name a frame of the model"));
  EXPECT_EQ(messageAfter("<mass>2</mass>", "<mass>2</mass><mass>3</mass>"),
            "m.osim:6: mass of Body 'upper': is given twice in Body 'upper': '2' in line 6 and '3' "
            "in line 6");
  EXPECT_EQ(messageAfter("<mass>2</mass>", "<mass>2<!-- kg -->5</mass>"),
            "m.osim:6: mass of Body 'upper': holds a comment inside its text, must be in one piece");
  EXPECT_EQ(read(replaced(valid, "<mass>2</mass>", "<mass><!-- kg -->2</mass>")).bodies[0].mass, 2);
  EXPECT_EQ(messageAfter("</Model>", "</Model><Model name=\"b\"/>"),
            "m.osim:38: Model 'b': is a second Model, a file must hold one");
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
  EXPECT_THAT(
      warningsAfter("</Coordinate>", "</Coordinate><Coordinate name=\"idle\"/>"),
      ElementsAre(
          "CustomJoint 'elbow': coordinate 'idle' drives none of the joint's axes and was left out"));
  EXPECT_THAT(messageAfter("</Coordinate>", "</Coordinate><Coordinate name=\"q\"/>"),
              HasSubstr("second coordinate called 'elbow/q'"));
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
  EXPECT_THAT(warningsAfter("\"egg\"", "\"roll\""),
              ElementsAre("line 9: WrapEllipsoid 'roll' of Body 'upper' is a further part of this "
                          "name and is called 'roll_0'"));
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
  // a number that no muscle has is no reason to refuse the rest of the model
  const auto saidAfter = [&](const std::string& old, const std::string& with) {
    const Model model = read(replaced(valid, old, with));
    EXPECT_FALSE(model.muscles.front().canBeSimulated());
    EXPECT_EQ(model.muscles.front().path.points.size(), 3u);
    constexpr std::string_view ending = "; the muscle is not simulated, only its path is used";
    const std::string said = model.warnings.empty() ? "" : model.warnings.front();
    EXPECT_TRUE(said.ends_with(ending)) << said;
    return said.substr(0, said.size() - std::min(said.size(), ending.size()));
  };
  EXPECT_EQ(saidAfter("<max_isometric_force>500<", "<max_isometric_force>0<"),
            "line 29: " + muscle + "max_isometric_force = 0 N, must be > 0");
  EXPECT_EQ(saidAfter("<optimal_fiber_length>0.1<", "<optimal_fiber_length>-0.1<"),
            "line 29: " + muscle + "optimal_fiber_length = -0.1 m, must be > 0");
  EXPECT_EQ(messageAfter("<tendon_slack_length>0.2<", "<tendon_slack_length>NaN<"),
            "m.osim:29: " + muscle + "tendon_slack_length = NaN m, must be finite");
  EXPECT_EQ(saidAfter("<pennation_angle_at_optimal>0.1<", "<pennation_angle_at_optimal>12<"),
            "line 29: " + muscle + "pennation_angle_at_optimal = 12 rad, must be < π/2");
  EXPECT_EQ(saidAfter("<time_scale>0.1<", "<time_scale>0<"),
            "line 30: " + muscle + "time_scale = 0 s, must be > 0");
  EXPECT_EQ(saidAfter("<damping>0.017<", "<damping>0<"),
            "line 30: " + muscle + "damping = 0, must be > 0");
  EXPECT_EQ(saidAfter("<damping>", "<min_control>1</min_control><damping>"),
            "line 22: " + muscle + "min_control = 1, must be < max_control = 1");
  const std::string curve = "line 31: SimmSpline 'active_force_length_curve' of " + muscle;
  EXPECT_EQ(saidAfter("<x>0 0.5 1 1.5 2<", "<x>0 0.5 0.4 1.5 2<"),
            curve + "x[2] = 0.4 after 0.5, must rise strictly");
  EXPECT_EQ(saidAfter("<x>0 0.5 1 1.5 2<", "<x>0 0.5 0.5 1.5 2<"),
            curve + "x[2] = 0.5 after 0.5, must rise strictly");
  EXPECT_EQ(saidAfter("<x>0 0.5 1 1.5 2<", "<x>0 0.5 1 1.5<"),
            curve + "has 4 x and 5 y, must have as many of each");
  EXPECT_EQ(saidAfter("<x>0 0.5 1 1.5 2</x><y>0 0.3 1 0.3 0<", "<x>1</x><y>1<"),
            curve + "has 1 points, must have at least 2");
  EXPECT_THAT(
      warningsAfter("<CoordinateLimitForce name=\"stop\"", "<CoordinateLimitForce name=\"flexor\""),
      ElementsAre("line 33: CoordinateLimitForce 'flexor' is a further part of this name and is "
                  "called 'flexor_0'"));
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

}  // namespace
}  // namespace bio
