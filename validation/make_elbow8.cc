// Writes models/elbow8.osim and models/elbow8_passive.osim from the numbers of MoBL-ARMS (Saul et
// al. 2015); models/README.md tells their origin, their terms, and where these models depart from
// it.
//     make_elbow8 FOLDER
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "bio/opensim/osim_file.h"

namespace {

using bio::Function;
using bio::Model;
using Eigen::Vector3d;

constexpr double degree = std::numbers::pi / 180;

// Segments ----------------------------------------------------------------------------------------

// Between clavicle, scapula and humerus stand bodies without substance, which only carry joints.
bio::Body phantom(const char* name) {
  return {name, 1e-4, Vector3d::Zero(), {1e-6, 1e-6, 1e-6, 0, 0, 0}, {}};
}

std::vector<bio::Body> segments() {
  return {
      {"thorax", 0, Vector3d::Zero(), {0, 0, 0, 0, 0, 0}, {}},
      {"clavicle",
       0.156,
       {-0.011096, 0.0063723, 0.054168},
       {0.00024259, 0.00025526, 4.442e-5, -1.898e-5, -6.994e-5, 5.371e-5},
       {}},
      phantom("clavphant"),
      {"scapula",
       0.70396,
       {-0.054694, -0.035032, -0.043734},
       {0.0012429, 0.0011504, 0.0013651, 0.0004494, 0.00040922, 0.0002411},
       {}},
      phantom("scapphant"),
      phantom("humphant"),
      phantom("humphant1"),
      {"humerus",
       1.99757,
       {0.018064, -0.140141, -0.012746},
       {0.01227763, 0.00255133, 0.01257888, -0.00034741, -0.0002325, 0.0012293},
       {}},
      {"ulna",
       1.1053,
       {0.00971783, -0.0959509, 0.024286},
       {0.00541309, 0.00115318, 0.00494361, 0.00031686, -7.615e-5, 0.00109169},
       {}},
      {"radius",
       0.23359,
       {0.0336341, -0.181559, 0.0156},
       {0.00043855, 8.859e-5, 0.00040258, 3.014e-5, -4.24e-6, 6.418e-5},
       {}},
      {"proximal_row", 0.0001, Vector3d::Zero(), {1e-5, 1e-5, 1e-5, 0, 0, 0}, {}},
      {"hand",
       0.5819,
       {-0.00301314, -0.0424993, -0.00112205},
       {0.00011, 6e-5, 0.00015, 9e-7, -2e-7, 1.2e-5},
       {}},
  };
}

// Joints ------------------------------------------------------------------------------------------

struct Turn {
  int place;  // 1, 2 or 3: the place in the order of rotations
  const char* coordinate;
  Vector3d axis;
  double rangeMin, rangeMax;  // [rad]
  Function function = {1, bio::LinearFunction{1, 0}};
};

constexpr double free = 3.14159265;  // where the source gives no range

// Fills the places without a coordinate with directions that complete a basis.
void completeAxes(bio::Joint& joint) {
  std::vector<Vector3d> given;
  for (int i = 0; i < 3; ++i) {
    if (!joint.axes[static_cast<std::size_t>(i)].coordinate.empty()) {
      given.push_back(joint.axes[static_cast<std::size_t>(i)].axis.normalized());
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (!joint.axes[i].coordinate.empty()) continue;
    if (given.size() == 1) {
      const Vector3d helper = std::abs(given[0].y()) < 0.9 ? Vector3d::UnitY() : Vector3d::UnitX();
      given.push_back(given[0].cross(helper).normalized());
    } else {
      given.push_back(given[0].cross(given[1]).normalized());
    }
    joint.axes[i].axis = given.back();
  }
  for (std::size_t i = 3; i < 6; ++i) {
    joint.axes[i].axis = Vector3d::Unit(static_cast<Eigen::Index>(i - 3));
  }
}

bio::Joint joint(const char* name, const char* parent, const char* child, const Vector3d& location,
                 const std::vector<Turn>& turns) {
  bio::Joint made;
  made.name = name;
  made.kind = bio::JointKind::custom;
  made.parentBody = parent;
  made.parentFrame.translation = location;
  made.childBody = child;
  for (const Turn& turn : turns) {
    const bool moves = std::string(turn.coordinate) == "elbow_flexion";
    made.coordinates.push_back({.name = turn.coordinate,
                                .isRotation = true,
                                .defaultValue = 0,
                                .rangeMin = turn.rangeMin,
                                .rangeMax = turn.rangeMax,
                                .locked = !moves,
                                .clamped = false});
    made.axes[static_cast<std::size_t>(turn.place - 1)] = {turn.coordinate, turn.axis,
                                                           turn.function};
  }
  completeAxes(made);
  return made;
}

std::vector<bio::Joint> joints() {
  const Vector3d zero = Vector3d::Zero();
  const Vector3d sc2(0.0153, 0.9892987, -0.14509996), sc3(-0.99447254, 0, -0.10499695);
  const Vector3d ac1(0.63769985, 0.11859997, 0.76109982);
  const Vector3d ac2(0.15709493, 0.94726859, -0.27929088);
  const Vector3d ac3(-0.75408404, 0.29759402, 0.58548703);
  const Vector3d humeral(0.0048, 0.99908918, 0.04240001);
  const Function sd = {1, bio::SplineFunction{{-0.174533, 0, 0.436332}, {-0.174533, 0, 0.436332}}};
  const Function halved = {1, bio::SplineFunction{{-1.5708, 1.5708}, {-0.785398, 0.785398}}};
  return {
      joint("groundthorax", "ground", "thorax", zero,
            {{3, "r_z", {0, 0, 1}, -6.28318531, 6.28318531}}),
      joint("sternoclavicular", "thorax", "clavicle", {0.006325, 0.00693, 0.025465},
            {{1, "sternoclavicular_r2", sc2, -free, free},
             {2, "sternoclavicular_r3", sc3, -free, free}}),
      joint("unrotscap", "clavicle", "clavphant", {-0.01433, 0.02007, 0.135535},
            {{1, "unrotscap_r3", sc3, -free, free}, {2, "unrotscap_r2", sc2, -free, free}}),
      joint("acromioclavicular", "clavphant", "scapula", zero,
            {{1, "acromioclavicular_r2", ac2, -free, free},
             {2, "acromioclavicular_r3", ac3, -free, free},
             {3, "acromioclavicular_r1", ac1, -free, free}}),
      joint("unrothum", "scapula", "scapphant", {-0.00955, -0.034, 0.009},
            {{1, "unrothum_r1", ac1, -free, free},
             {2, "unrothum_r3", ac3, -free, free},
             {3, "unrothum_r2", ac2, -free, free}}),
      joint("shoulder0", "scapphant", "humphant", zero,
            {{1, "elv_angle", humeral, -1.57079633, 2.26892803}}),
      joint("shoulder1", "humphant", "humphant1", zero,
            {{1, "shoulder_elv", {-0.99826136, 0.0023, 0.05889802}, 0, 3.14159265},
             {2, "shoulder1_r2", humeral, -free, free}}),
      joint("shoulder2", "humphant1", "humerus", zero,
            {{1, "shoulder_rot", humeral, -1.57079633, 0.34906585}}),
      joint("elbow", "humerus", "ulna", {0.0061, -0.2904, -0.0123},
            {{1, "elbow_flexion", {0.04940001, 0.03660001, 0.99810825}, 0, 2.26892803}}),
      joint("radioulnar", "ulna", "radius", {0.0004, -0.011503, 0.019999},
            {{1, "pro_sup", {-0.01716099, 0.99266564, -0.11966796}, -1.57079633, 1.57079633}}),
      joint(
          "radiocarpal", "radius", "proximal_row", {0.018, -0.242, 0.025},
          {{1, "deviation", {-0.819064, -0.135611, -0.557444}, -0.17453293, 0.43633231, sd},
           {3, "flexion", {0.95642673, -0.25220693, 0.14710396}, -1.22173048, 1.22173048, halved}}),
      joint("wrist_hand", "proximal_row", "hand", {0.003992, -0.015054, 0.002327},
            {{1, "wrist_hand_r1", {0.8991357, -0.34905288, -0.26403991}, -free, free},
             {2, "wrist_hand_r3", {0.99711853, 0.01069999, -0.07510096}, -free, free}}),
  };
}

// Muscles -----------------------------------------------------------------------------------------

std::vector<bio::WrapObject> cylinders() {
  bio::WrapObject triceps;
  triceps.name = "TRI";
  triceps.body = "humerus";
  triceps.frame = {{0.0028, -0.2919, -0.0119}, {-0.14015, -0.00628319, 0.154985}};
  triceps.quadrant = "all";
  triceps.radius = 0.016;
  triceps.length = 0.1;
  bio::WrapObject flexors;
  flexors.name = "BIC_BRD";
  flexors.body = "humerus";
  flexors.frame = {{0.0019, -0.289, -0.014}, {-0.128631, 0.137532, 0.0307178}};
  flexors.quadrant = "x";
  flexors.radius = 0.015;
  flexors.length = 0.2;
  return {triceps, flexors};
}

bio::SchutteParameters schutte(double force, double fibre, double slack, double pennation) {
  bio::SchutteParameters p;
  p.maxIsometricForce = force;
  p.optimalFibreLength = fibre;
  p.tendonSlackLength = slack;
  p.pennation = pennation;
  p.timeScale = 0.1;
  p.activation1 = 7.667;
  p.activation2 = 1.459854;
  p.damping = 0.017;
  p.tendonForceLength = {{-10, -0.002, -0.001, 0, 0.00131, 0.00281, 0.00431, 0.00581, 0.00731,
                          0.00881, 0.0103, 0.0118, 0.0123, 9.2, 9.201, 9.202, 20},
                         {0, 0, 0, 0, 0.0108, 0.0257, 0.0435, 0.0652, 0.0915, 0.123, 0.161, 0.208,
                          0.227, 345, 345, 345, 345}};
  p.activeForceLength = {
      {-35, 0, 0.401, 0.402, 0.4035, 0.52725, 0.62875, 0.71875, 0.86125, 1.045, 1.2175, 1.43875,
       1.61875, 1.62, 1.621, 2.2, 35},
      {0, 0, 0, 0, 0, 0.226667, 0.636667, 0.856667, 0.95, 0.993333, 0.77, 0.246667, 0, 0, 0, 0, 0}};
  p.passiveForceLength = {{-35, 1, 1.05, 1.1, 1.125, 1.14, 1.145, 1.15, 1.15, 1.25, 1.35, 1.45,
                           1.55, 1.65, 1.75, 1.7501, 1.7502, 35},
                          {0, 0, 0, 0, 0, 0, 0, 0, 0, 0.035, 0.12, 0.26, 0.55, 1.17, 2, 2, 2, 2}};
  return p;
}

struct Place {
  const char* body;
  Vector3d location;
};

bio::Muscle muscle(const char* name, const bio::SchutteParameters& parameters,
                   const std::vector<Place>& places, const std::vector<bio::PathWrap>& wraps) {
  bio::Muscle made;
  made.name = name;
  made.className = "Schutte1993Muscle_Deprecated";
  made.schutte = parameters;
  for (const Place& place : places) {
    bio::PathPoint point;
    point.name = fmt::format("{}-P{}", name, made.path.points.size() + 1);
    point.body = place.body;
    point.location = place.location;
    made.path.points.push_back(point);
  }
  made.path.wraps = wraps;
  return made;
}

// Where the biceps runs over the radius: the point travels with the forearm's rotation.
void letMove(bio::PathPoint& point) {
  bio::PointMotion motion;
  motion.coordinate = {"pro_sup", "pro_sup", "pro_sup"};
  motion.location = {
      Function{1, bio::SplineFunction{{-1.57561, 1.57823}, {-0.0055, 0.01096}}},
      Function{1, bio::PiecewiseLinearFunction{{-1.57561, 0, 1.57561}, {-0.0282, -0.035, -0.0392}}},
      Function{1,
               bio::SplineFunction{{-1.57561, 0.0866167, 1.57561}, {-0.01, -0.01358, -0.01083}}}};
  point.motion = motion;
}

std::vector<bio::Muscle> muscles() {
  const Place tri3 = {"humerus", {-0.03184, -0.22637, -0.01217}};
  const Place tri4 = {"humerus", {-0.01743, -0.26757, -0.01208}};
  const Place tri5 = {"ulna", {-0.0219, 0.01046, -0.00078}};
  const Place biceps = {"humerus", {0.0228, -0.1754, -0.0063}};
  const Place moving = {"radius", Vector3d::Zero()};
  const Place insertion = {"radius", {-0.002, -0.0375, -0.002}};
  std::vector<bio::Muscle> all = {
      muscle("TRIlong", schutte(771.8, 0.134, 0.143, 0.20943951),
             {{"scapula", {-0.04565, -0.04073, -0.01377}},
              {"humerus", {-0.02714, -0.11441, -0.00664}},
              tri3,
              tri4,
              tri5},
             {{"TRI", 4, 5}}),
      muscle("TRIlat", schutte(717.5, 0.1138, 0.098, 0.15707963),
             {{"humerus", {-0.00599, -0.12646, 0.00428}},
              {"humerus", {-0.02344, -0.14528, 0.00928}},
              tri3,
              tri4,
              tri5},
             {{"TRI", 4, 5}}),
      muscle("TRImed", schutte(717.5, 0.1138, 0.0908, 0.15707963),
             {{"humerus", {-0.00838, -0.13695, -0.00906}},
              {"humerus", {-0.02601, -0.15139, -0.0108}},
              tri3,
              tri4,
              tri5},
             {{"TRI", 4, 5}}),
      muscle("ANC", schutte(283.2, 0.027, 0.018, 0),
             {{"humerus", {-0.00744, -0.28359, 0.00979}}, {"ulna", {-0.02532, -0.00124, 0.006}}},
             {}),
      muscle("BIClong", schutte(525.1, 0.1157, 0.2723, 0),
             {{"scapula", {-0.03123, -0.02353, -0.01305}},
              {"scapula", {-0.02094, -0.01309, -0.00461}},
              {"humerus", {0.02131, 0.01793, 0.01028}},
              {"humerus", {0.02378, -0.00511, 0.01201}},
              {"humerus", {0.01345, -0.02827, 0.00136}},
              {"humerus", {0.01068, -0.07736, -0.00165}},
              {"humerus", {0.01703, -0.12125, 0.00024}},
              biceps,
              moving,
              insertion},
             {{"BIC_BRD", 8, 9}}),
      muscle("BICshort", schutte(316.8, 0.1321, 0.1923, 0),
             {{"scapula", {0.01268, -0.03931, -0.02625}},
              {"scapula", {0.00093, -0.06704, -0.01593}},
              {"humerus", {0.01117, -0.07576, -0.01101}},
              {"humerus", {0.01703, -0.12125, -0.01079}},
              biceps,
              moving,
              insertion},
             {{"BIC_BRD", 5, 6}}),
      muscle("BRA", schutte(1177.37, 0.0858, 0.0535, 0),
             {{"humerus", {0.0068, -0.1739, -0.0036}},
              {"humerus", {0.01894, -0.28559, -0.01105}},
              {"ulna", {0.00498, -0.01463, 0.00128}},
              {"ulna", {-0.0032, -0.0239, 0.0009}}},
             {}),
      muscle("BRD", schutte(276, 0.1726, 0.133, 0),
             {{"humerus", {-0.0098, -0.19963, 0.00223}},
              {"radius", {0.03577, -0.12742, 0.02315}},
              {"radius", {0.0419, -0.221, 0.0224}}},
             {{"BIC_BRD", 1, 2}}),
  };
  letMove(all[4].path.points[8]);
  letMove(all[5].path.points[5]);
  const bio::PointCondition nearExtension = {"elbow_flexion", 0, 0.813149};
  all[6].path.points[1].condition = nearExtension;
  all[6].path.points[2].condition = nearExtension;
  return all;
}

// -------------------------------------------------------------------------------------------------

Model elbow8() {
  Model model;
  model.name = "elbow8";
  model.credits =
      "FisherHill; numbers from MoBL-ARMS by K. R. Saul, W. M. Murray, C. M. Goehler, M. Daly, "
      "M. E. Vidt, D. L. Crouch; see models/README.md for terms and departures";
  model.publications =
      "Saul KR, Hu X, Goehler CM, Daly M, Vidt ME, Velisar A, Murray WM (2015) Benchmarking of "
      "dynamic simulation predictions in two software platforms using an upper limb "
      "musculoskeletal model. Comput Methods Biomech Biomed Engin 18(13):1445-1458";
  model.bodies = segments();
  model.joints = joints();
  model.wrapObjects = cylinders();
  model.muscles = muscles();
  return model;
}

// Ligaments and damping of the source's elbow: limits in deg, stiffness N m/deg, damping N m s/deg.
Model withPassiveElbow(Model model) {
  model.name = "elbow8_passive";
  model.limitForces.push_back({.name = "elbow_flexion_ligaments",
                               .coordinate = "elbow_flexion",
                               .upperLimit = 85 * degree,
                               .upperStiffness = 0.3037 / degree,
                               .lowerLimit = 14 * degree,
                               .lowerStiffness = 100 / degree,
                               .damping = 0,
                               .transition = 139.5813 * degree});
  model.limitForces.push_back({.name = "elbow_flexion_damping",
                               .coordinate = "elbow_flexion",
                               .upperLimit = 190 * degree,
                               .upperStiffness = 1e-8 / degree,
                               .lowerLimit = 190 * degree,
                               .lowerStiffness = 1e-8 / degree,
                               .damping = 0.001745 / degree,
                               .transition = 1 * degree});
  return model;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: make_elbow8 FOLDER\n", stderr);
    return 2;
  }
  try {
    const std::filesystem::path folder = argv[1];
    bio::writeOsim(elbow8(), folder / "elbow8.osim");
    bio::writeOsim(withPassiveElbow(elbow8()), folder / "elbow8_passive.osim");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 0;
}
