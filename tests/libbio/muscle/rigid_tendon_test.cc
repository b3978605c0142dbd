// RigidTendonMuscle: OpenSim's law of it, its derivatives, its file.
#include <gtest/gtest.h>

#include <cmath>

#include "bio/muscle/muscle_sensitivity.h"
#include "bio/muscle/simulated_muscle.h"
#include "bio/opensim/osim_file.h"
#include "support/scratch_folder.h"
#include "support/shipped_elbow.h"
#include "support/throws_saying.h"

namespace bio::muscles {
namespace {

using Parameters = RigidTendonParameters<double>;

Parameters pennate() {
  Parameters p;
  p.maxIsometricForce = 800;
  p.optimalFibreLength = 0.09;
  p.tendonSlackLength = 0.21;
  p.pennation = 0.35;
  p.maxContractionVelocity = 9;
  return p;
}

/// The law once more, from the functions' own evaluator.
double force(const Parameters& p, double u, double L, double speed) {
  const FunctionEvaluator active(Function{1, p.curves.activeForceLength});
  const FunctionEvaluator passive(Function{1, p.curves.passiveForceLength});
  const FunctionEvaluator velocity(Function{1, p.curves.forceVelocity});
  const double z = std::max(L - p.tendonSlackLength, 0.0);
  const double length = std::hypot(z, p.optimalFibreLength * std::sin(p.pennation));
  if (length == 0) return 0;
  const double l = length / p.optimalFibreLength;
  const double v = speed / (p.maxContractionVelocity * p.optimalFibreLength);
  return p.maxIsometricForce *
         (u * active.evaluate(l).value * velocity.evaluate(v).value +
          std::clamp(passive.evaluate(l).value, 0.0, 10.0)) *
         z / length;
}

TEST(RigidTendonMuscle, HasOpenSimsCurves) {
  const RigidTendon<double> shape{Parameters()};
  EXPECT_NEAR(shape.forceVelocity(0.0, 0.5).value, 1, 1e-15);
  EXPECT_NEAR(shape.forceVelocity(-1.0, 0.5).value, 0, 1e-15);
  EXPECT_NEAR(shape.forceVelocity(1.0, 0.5).value, 1.774455, 1e-15);
  EXPECT_GT(shape.forceVelocity(1.5, 0.5).value, 1.774455);  // goes on in a line
  EXPECT_NEAR(shape.activeForce(1.045).value, 0.993333, 1e-15);
  EXPECT_NEAR(shape.passiveForce(1.3).value, 0.26, 1e-15);
  EXPECT_GE(shape.passiveForce(0.9985).value, 0);
}

TEST(RigidTendonMuscle, PullsWithTheForceOfItsLaw) {
  for (const Parameters& p : {pennate(), Parameters()}) {
    const HillMuscle<RigidTendon<double>> muscle(p);
    for (double u : {0.0, 0.3, 1.0, 1.2})
      for (double l : {0.5, 0.9, 1.3, 1.7})
        for (double speed : {-1.2, -0.3, 0.0, 0.1, 2.0}) {
          const double L = p.tendonSlackLength + l * p.optimalFibreLength;
          const RigidRate<double> r = muscle.rigidRate(u, L, speed);
          EXPECT_NEAR(r.tendonForce, force(p, u, L, speed), 1e-9);
          EXPECT_EQ(r.fibreVelocity, speed);
        }
    EXPECT_EQ(muscle.rigidRate(0.5, 0.99 * p.tendonSlackLength, 0.1).tendonForce, 0);
  }
}

TEST(RigidTendonMuscle, KnowsItsDerivatives) {
  const Parameters p = pennate();
  const HillMuscle<RigidTendon<double>> muscle(p);
  constexpr double h = 1e-6;
  for (double l : {0.58, 0.93, 1.34})
    for (double speed : {-0.41, -0.02, 0.13}) {
      const double L = p.tendonSlackLength + l * p.optimalFibreLength, u = 0.6;
      const RigidRate<double> r = muscle.rigidRate(u, L, speed);
      const auto slope = [&](double du, double dL, double dSpeed) {
        return (force(p, u + du, L + dL, speed + dSpeed) -
                force(p, u - du, L - dL, speed - dSpeed)) /
               (2 * h);
      };
      EXPECT_NEAR(r.dF_dActivation, slope(h, 0, 0), 1e-5);
      EXPECT_NEAR(r.dF_dPathLength, slope(0, h, 0), 1e-6 * (1000 + std::abs(r.dF_dPathLength)));
      EXPECT_NEAR(r.dF_dPathSpeed, slope(0, 0, h), 1e-5 * (10 + r.dF_dPathSpeed));

      const auto inNumbers = rigidForceInNumbers(muscle, u, L, speed);
      for (std::size_t i = 0; i < Parameters::count; ++i) {
        const double step = 1e-6 * Parameters::at(p, i);
        Parameters above = p, below = p;
        Parameters::at(above, i) += step;
        Parameters::at(below, i) -= step;
        const double expected =
            (force(above, u, L, speed) - force(below, u, L, speed)) / (2 * step);
        EXPECT_NEAR(inNumbers[i], expected, 1e-6 * (10 + std::abs(expected)))
            << Parameters::properties[i].name;
      }
    }
}

TEST(RigidTendonMuscle, RefusesCurvesWithoutASpline) {
  Parameters p;
  p.curves.forceVelocity.x[3] = p.curves.forceVelocity.x[7];
  support::throwsSaying([&] { p.requireRules(); }, "force_velocity_curve: ");
}

/// The shipped elbow's file with its muscles renamed to the class.
std::string elbowFile(const std::string& inMuscle) {
  std::string text = support::contentOf(fixtures::ShippedElbow::root() + "/models/elbow8.osim");
  const std::string old = "Schutte1993Muscle_Deprecated";
  for (std::size_t at = 0; (at = text.find(old, at)) != text.npos;) {
    text.replace(at, old.size(), "RigidTendonMuscle");
    const std::size_t end = text.find('>', at) + 1;
    if (text[at - 1] != '/') text.insert(end, inMuscle);
    at = end;
  }
  return text;
}

TEST(RigidTendonMuscle, IsReadWithWhateverSwitchesAndItsOwnCurves) {
  const support::ScratchFolder folder;
  const std::string file =
      folder.file("rigid.osim",
                  elbowFile("<ignore_tendon_compliance>false</ignore_tendon_compliance>"
                            "<force_velocity_curve><SimmSpline><x>-1 -0.5 0 1</x><y>0 0.2 1 1.5</y>"
                            "</SimmSpline></force_velocity_curve>"));
  const Model model = readOsim(file);
  ASSERT_TRUE(model.muscles[0].hill);
  const auto& p = std::get<Parameters>(*model.muscles[0].hill);
  EXPECT_TRUE(p.ignoreTendonCompliance && p.ignoreActivationDynamics);
  EXPECT_EQ(p.curves.forceVelocity.y, (std::vector<double>{0, 0.2, 1, 1.5}));
  // the other two are those that the file gives, or OpenSim's
  const Model schutte = readOsim(fixtures::ShippedElbow::root() + "/models/elbow8.osim");
  const auto& given = schutte.muscles[0].schutte->passiveForceLength;
  EXPECT_TRUE(p.curves.passiveForceLength ==
              (given ? *given : openSimRigidTendonCurves().passiveForceLength));

  const Model broken = readOsim(
      folder.file("broken.osim", elbowFile("<force_velocity_curve><Sine/></force_velocity_curve>")));
  EXPECT_FALSE(broken.muscles[0].canBeSimulated());
  EXPECT_NE(broken.warnings.front().find("curve of class Sine"), std::string::npos)
      << broken.warnings.front();
}

}  // namespace
}  // namespace bio::muscles
