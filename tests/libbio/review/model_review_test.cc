#include "bio/review/model_review.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <functional>

#include "bio/opensim/osim_file.h"

namespace bio {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;

const std::filesystem::path root = FISHERHILL_SOURCE_DIR;

std::vector<std::string> linesOf(const Model& model) {
  std::vector<std::string> lines;
  for (const Remark& r : reviewModel(model)) lines.push_back(r.subject + ": " + r.message);
  return lines;
}

// The shipped elbow without the products of inertia that draw remarks of their own.
Model reviewedElbow() {
  Model model = readOsim(root / "models/elbow8_passive.osim");
  for (Body& body : model.bodies) {
    if (body.name != "clavicle" && body.name != "scapula") continue;
    for (std::size_t i = 3; i < 6; ++i) body.inertia[i] = 0;
  }
  return model;
}

Coordinate& elbowFlexion(Model& model) {
  for (Joint& joint : model.joints) {
    if (joint.name == "elbow") return joint.coordinates.at(0);
  }
  throw std::logic_error("no elbow");
}

// models/README.md tells of these two.
TEST(ModelReview, FindsOnlyTheSourcesInertiasUnusualInTheShippedElbow) {
  for (const char* name : {"models/elbow8.osim", "models/elbow8_passive.osim"}) {
    EXPECT_THAT(linesOf(readOsim(root / name)),
                ElementsAre(StartsWith("body 'clavicle': principal moment of inertia = 0.000298"),
                            StartsWith("body 'scapula': principal moment of inertia = 0.00199")));
  }
  EXPECT_THAT(linesOf(reviewedElbow()), IsEmpty());
}

// The source of the shipped elbow gives its phantom bodies of 1e-4 kg an inertia of 1 kg m².
TEST(ModelReview, FindsThePhantomBodiesOfTheSourceModel) {
  Model model = readOsim(root / "models/elbow8.osim");
  for (Body& body : model.bodies) {
    if (body.name.find("phant") != std::string::npos) body.inertia = {1, 1, 1, 0, 0, 0};
  }
  std::vector<std::string> gyration;
  for (const Remark& r : reviewModel(model)) {
    if (r.message.starts_with("radius of gyration = 100 m")) gyration.push_back(r.subject);
  }
  EXPECT_THAT(gyration, ElementsAre("body 'clavphant'", "body 'scapphant'", "body 'humphant'",
                                    "body 'humphant1'"));
}

// Each change of the shipped elbow draws exactly one remark.
TEST(ModelReview, NamesEachUnusualQuantityOnce) {
  struct Case {
    std::function<void(Model&)> spoil;
    std::string remark;
  };
  const Case cases[] = {
      {[](Model& m) { elbowFlexion(m).rangeMax = 130; },
       "coordinate 'elbow_flexion': range = 0 to 130 rad, usually within ±4π: degrees?"},
      {[](Model& m) { elbowFlexion(m).defaultValue = -0.5; },
       "coordinate 'elbow_flexion': default = -0.5, outside its range 0 to 2.26892803"},
      {[](Model& m) { elbowFlexion(m).clamped = true; },
       "coordinate 'elbow_flexion': is clamped, but the simulation does not stop it at the ends of "
       "its range"},
      {[](Model& m) { elbowFlexion(m).locked = true; },
       "model: has no free coordinate: nothing can move"},
      {[](Model& m) { m.bodies[11].inertia = {1e-4, 1e-4, 3e-4, 0, 0, 0}; },
       "body 'hand': moment of inertia = 0.0003 kg m², violates the triangle inequality: above the "
       "sum of the other two (0.0002)"},
      {[](Model& m) { m.bodies[11].inertia = {1e-4, 1e-4, 1e-4, 2e-4, 0, 0}; },
       "body 'hand': least principal moment of inertia = -0.0001 kg m², must be ≥ 0"},
      {[](Model& m) { m.bodies[11].inertia = {1e-4, 1e-4, 1.9e-4, 0, 9e-5, 0}; },
       "body 'hand': principal moment of inertia = 0.0002456 kg m², violates the triangle "
       "inequality: above the sum of the other two (0.0001444)"},
      {[](Model& m) {
         m.bodies[11].massCenter = {0, -42, 0};
       },
       "body 'hand': mass centre 42 m from its origin, usually below 3 m: millimetres?"},
      {[](Model& m) { m.bodies[11].mass = 581.9; },
       "body 'hand': mass = 581.9 kg, usually below 200 kg: grams?"},
      {[](Model& m) { m.joints[8].axes[0].axis *= 2; },
       "joint 'elbow': axis 1 has length 2, usually 1"},
      {[](Model& m) { m.wrapObjects[0].radius = 16; },
       "wrap object 'TRI': radius = 16 m, usually below 0.5 m: millimetres?"},
      {[](Model& m) {
         m.muscles[0].path.points[0].location = {0, -45, 0};
       },
       "muscle 'TRIlong': point 'TRIlong-P1' is 45 m from its body's origin, usually below 3 m: "
       "millimetres?"},
      {[](Model& m) { m.muscles[6].path.points[1].condition->upper = 46; },
       "muscle 'BRA': point 'BRA-P2' is active from 0 to 46 rad, usually within ±4π: degrees?"},
      {[](Model& m) { m.muscles[0].schutte->maxIsometricForce = 0.77; },
       "muscle 'TRIlong': maximum isometric force = 0.77 N, usually 1 to 20000 N"},
      {[](Model& m) { m.muscles[0].schutte->tendonSlackLength = 0.0013; },
       "muscle 'TRIlong': tendon slack length / optimal fibre length = 0.0097, usually 0.1 to 15"},
      {[](Model& m) { m.muscles[0].schutte->optimalFibreLength = 0.7; },
       "muscle 'TRIlong': optimal fibre length = 0.7 m, usually 0.005 to 0.6 m"},
      {[](Model& m) { m.muscles[0].schutte->pennation = 1.2; },
       "muscle 'TRIlong': pennation = 1.2 rad, usually below π/4: degrees?"},
      {[](Model& m) { m.muscles[0].schutte->timeScale = 100; },
       "muscle 'TRIlong': time scale = 100 s, usually 0.01 to 1 s"},
      {[](Model& m) { m.muscles[0].schutte->damping = 17; },
       "muscle 'TRIlong': damping = 17, usually below 1"},
      {[](Model& m) { m.muscles[0].schutte->tendonForceLength.y[8] = 0.5; },
       "muscle 'TRIlong': the tendon curve falls somewhere, usually it rises"},
      {[](Model& m) { m.muscles[0].schutte->passiveForceLength->y[10] = 0.6; },
       "muscle 'TRIlong': the passive curve falls somewhere, usually it rises"},
      {[](Model& m) { m.muscles[0].schutte->activeForceLength.y[0] = -0.1; },
       "muscle 'TRIlong': a curve has a value below 0, usually muscle forces pull"},
      {[](Model& m) { m.muscles[0].schutte->activeForceLength.y[9] = 1.5; },
       "muscle 'TRIlong': the active curve peaks with 1.5 at 1.045, usually with 1 at 1"},
      {[](Model& m) { m.limitForces[0].upperLimit = 0.02, m.limitForces[0].lowerLimit = 0.01; },
       "force 'elbow_flexion_ligaments': limits within 1.15 deg of 0, usually wider: written in "
       "radians?"},
      {[](Model& m) {
         m.springForces.push_back({"s", "elbow_flexion", 1, 90, 0, true});
       },
       "force 's': rest length = 90 rad, usually within ±4π: degrees?"},
      {[](Model& m) {
         m.springForces.push_back({"s", "elbow_flexion", -1, 0, 0, true});
       },
       "force 's': stiffness = -1, usually ≥ 0"},
      {[](Model& m) {
         m.gravity = {0, -981, 0};
       },
       "model: gravity = 981 m/s², usually 9.81 or 0"},
      {[](Model& m) {
         for (PathPoint& p : m.muscles[0].path.points) p = m.muscles[0].path.points[0];
       },
       "muscle 'TRIlong': all its points coincide: its path has no length"},
      {[](Model& m) { m.muscles.clear(); }, "model: has no muscle"},
  };
  for (const Case& c : cases) {
    Model model = reviewedElbow();
    c.spoil(model);
    EXPECT_THAT(linesOf(model), ElementsAre(c.remark));
  }
}

TEST(ModelReview, FindsAMasslessEndOfTheChain) {
  Model model = reviewedElbow();
  model.joints.back().coordinates[0].locked = false;
  model.bodies.back().mass = 0;
  EXPECT_THAT(
      linesOf(model),
      ElementsAre("body 'hand': mass = 0 kg at the end of the chain: joint 'wrist_hand' has "
                  "nothing to move"));
}

TEST(ModelReview, SaysWhyNothingOfAModelCanBeSimulated) {
  EXPECT_EQ(whyNotSimulated(reviewedElbow()), "");
  Model model = reviewedElbow();
  for (Muscle& muscle : model.muscles) muscle.schutte.reset();
  EXPECT_EQ(whyNotSimulated(model), "none of its 8 muscles is of a class that can be simulated");
  model = reviewedElbow();
  for (Body& body : model.bodies) body.mass = 0, body.inertia = {};
  EXPECT_EQ(whyNotSimulated(model), "no coordinate that is not locked moves a mass");
  EXPECT_THAT(linesOf(model), testing::Contains(StartsWith(
                                  "model: coordinate 'elbow_flexion' moves no mass (inertia = 0")));
  model = reviewedElbow();
  model.muscles.clear();  // falls
  EXPECT_EQ(whyNotSimulated(model), "");
}

}  // namespace
}  // namespace bio
