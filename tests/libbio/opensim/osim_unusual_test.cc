#include "libbio/opensim/osim_rules.h"

// What the reader takes from unusual but good files.
namespace bio {
namespace {

using osim_rules::OsimRules;
using osim_rules::replaced;
using osim_rules::valid;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

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

}  // namespace
}  // namespace bio
