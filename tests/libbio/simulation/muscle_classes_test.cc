// Models with muscles of OpenSim's other classes, from the file to the motion and its derivatives.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bio/model/convert_muscles.h"
#include "support/scratch_folder.h"
#include "support/sensitivity_differences.h"
#include "support/shipped_elbow.h"
#include "support/throws_saying.h"

namespace bio {
namespace {

using fixtures::DiscoveryProblem;
using fixtures::forSeconds;
using fixtures::ShippedElbow;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr std::array classes{"Thelen2003", "Millard2012", "DeGrooteFregly2016", "RigidTendon",
                             "RigidTendonMuscle"};

/// The shipped elbow with muscles of another class.
struct ElbowOfClass {
  explicit ElbowOfClass(const std::string& className, const std::string& trialName = "curl_slow")
      : model(converted(className)),
        system(model, ShippedElbow::options()),
        trial(readTrial(ShippedElbow::root() + "/emg_data/" + trialName + ".sto", model)),
        excitation(excitationOf(trial, system)),
        catalogue(model, system,
                  {startCoordinates(trial, system, {}), Eigen::VectorXd::Constant(1, startSpeed)}) {
  }

  static Model converted(const std::string& className) {
    Model model = readOsim(ShippedElbow::root() + "/models/elbow8.osim");
    convertMuscles(model, className);
    return model;
  }

  Trajectory motion(Integrator integrator, double step, double duration) const {
    SimulationOptions options = forSeconds(duration);
    options.integrator = integrator;
    options.step = step;
    return simulateSetting(system, catalogue.nominal(), excitation, options);
  }

  /// [rad/s]; at rest a rigid tendon's force may sit on the kink where it is cut at 0.
  static constexpr double startSpeed = 0.3;

  Model model;
  MusculoskeletalSystem system;
  Trial trial;
  ExcitationSignal excitation;
  ParameterCatalogue catalogue;
};

double lastAngle(const Trajectory& motion) {
  return motion.q(0, motion.q.cols() - 1);
}

TEST(MuscleClasses, AllIntegratorsGoToOneMotion) {
  for (const char* name : classes) {
    SCOPED_TRACE(name);
    const ElbowOfClass elbow(name);
    const Trajectory exact = elbow.motion(Integrator::cvode, 0.01, 0.6);
    ASSERT_EQ(exact.outcome, Outcome::completed) << exact.why;
    const double reached = lastAngle(exact);
    EXPECT_GT(std::abs(reached - exact.q(0, 0)), 0.02);
    const auto off = [&](double step) {
      const Trajectory motion = elbow.motion(Integrator::variational, step, 0.6);
      EXPECT_EQ(motion.outcome, Outcome::completed) << motion.why;
      return std::abs(lastAngle(motion) - reached);
    };
    const double coarse = off(0.01), fine = off(0.0025);
    EXPECT_LT(coarse, 3e-3);
    EXPECT_LT(fine, 3e-4);
    const Trajectory explicitly = elbow.motion(Integrator::rungeKutta4, 2e-5, 0.05);
    EXPECT_NEAR(lastAngle(explicitly), exact.q(0, 5), 1e-7);
  }
}

TEST(MuscleClasses, SensitivitiesMatchDifferencesForEveryNumberOfAMuscle) {
  for (const char* name : classes) {
    SCOPED_TRACE(name);
    const ElbowOfClass elbow(name);
    const std::vector<std::string> names{"BIClong.*",  "TRIlong.*", "ANC.*",
                                         "TRI.radius", "hand.mass", "initial.*"};
    const DiscoveryProblem d = fixtures::compareWithDifferences(
        elbow.system, ShippedElbow::options(), elbow.excitation, elbow.catalogue,
        elbow.catalogue.select(names), forSeconds(0.2));
    fixtures::tell(d);
    EXPECT_LT(d.worst, 1e-5) << d.of;
    EXPECT_GT(d.compared, 10 * d.parameters);
  }
}

TEST(MuscleClasses, EveryNumberIsWrittenAndReadBack) {
  const support::ScratchFolder folder;
  for (const char* name : classes) {
    SCOPED_TRACE(name);
    const ElbowOfClass elbow(name);
    writeOsim(elbow.model, folder / "plain.osim");
    EXPECT_EQ(readOsim(folder / "plain.osim").muscles, elbow.model.muscles);

    const std::vector<std::size_t> chosen = elbow.catalogue.select({"BIClong.*", "BRA.*_length"});
    const Eigen::VectorXd values = elbow.catalogue.values(chosen);
    Eigen::VectorXd changed = values;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      const ModelParameter& p = elbow.catalogue.parameters()[chosen[i]];
      const auto si = static_cast<Eigen::Index>(i);
      changed[si] = values[si] + 0.05 * (p.upper - values[si]);
    }
    const Model calibrated = elbow.catalogue.at(chosen, changed).model;
    rewriteOsim(folder / "plain.osim", calibrated, folder / "calibrated.osim");
    const Model again = readOsim(folder / "calibrated.osim");
    for (std::size_t i = 0; i < again.muscles.size(); ++i) {
      EXPECT_EQ(again.muscles[i].hill, calibrated.muscles[i].hill) << again.muscles[i].name;
    }
    EXPECT_NE(again.muscles, elbow.model.muscles);
  }
}

TEST(MuscleClasses, TheShippedVariantsAreTheShippedElbowConverted) {
  for (const char* name : {"Thelen2003", "Millard2012", "DeGrooteFregly2016"}) {
    const Model shipped = readOsim(ShippedElbow::root() + "/models/elbow8_" + name + ".osim");
    EXPECT_EQ(shipped.muscles, ElbowOfClass::converted(name).muscles) << name;
  }
}

TEST(MuscleClasses, ConversionCarriesWhatBothHaveAndNamesTheRest) {
  Model model = ElbowOfClass::converted("Thelen2003");
  auto& thelen = std::get<muscles::Thelen2003Parameters<double>>(*model.muscles[0].hill);
  EXPECT_NEAR(thelen.maxContractionVelocity, 10, 1e-12);
  thelen.tendonStrainAtMaxForce = 0.031;
  thelen.activationTime = 0.012;
  thelen.velocityShape = 0.33;
  const muscles::Thelen2003Parameters<double> before = thelen;
  const MuscleConversion there = convertMuscles(model, "Millard2012EquilibriumMuscle");
  EXPECT_EQ(there.converted, model.muscles.size());
  EXPECT_THAT(there.lost, Contains(StartsWith("Af")));
  EXPECT_EQ(model.muscles[0].className, "Millard2012EquilibriumMuscle");
  const auto& millard = std::get<muscles::Millard2012Parameters<double>>(*model.muscles[0].hill);
  EXPECT_EQ(millard.tendonUnitStrain, 0.031);
  EXPECT_EQ(millard.optimalFibreLength, before.optimalFibreLength);

  EXPECT_EQ(convertMuscles(model, "Millard2012").converted, 0u);
  convertMuscles(model, "Thelen2003");
  muscles::Thelen2003Parameters<double> expected = before;
  expected.velocityShape = muscles::Thelen2003Parameters<double>().velocityShape;
  EXPECT_EQ(std::get<muscles::Thelen2003Parameters<double>>(*model.muscles[0].hill), expected);

  convertMuscles(model, "Schutte1993");
  ASSERT_TRUE(model.muscles[0].schutte);
  EXPECT_DOUBLE_EQ(model.muscles[0].schutte->timeScale, 0.1);
  const MusculoskeletalSystem system(model, ShippedElbow::options());
  EXPECT_EQ(system.numMuscles(), 8u);
  support::throwsSaying([&] { convertMuscles(model, "Thelen"); },
                        "muscle class 'Thelen' is not known");
}

// A fibre at its class's least length shortens no further; the force on the skeleton is the
// tendon's.
TEST(MuscleClasses, AFibreIsHeldAtItsLeastLength) {
  muscles::Thelen2003Parameters<double> p;
  p.pennation = 0.5;
  const muscles::AnyMuscle any = muscles::compile(p);
  const SimulatedMuscle muscle(any);
  const double least = 0.1 * std::sin(0.5) / std::sqrt(0.99);
  EXPECT_NEAR(muscle.shortestFibre(), least, 1e-15);
  SchuttePieces none;
  const double slack = 0.2, pulled = 0.2075;
  const StaticEquilibrium rest = muscle.rest(0.5, slack);
  ASSERT_TRUE(rest.isUsable());
  EXPECT_NEAR(rest.fibreLength, least, 1e-15);
  EXPECT_LT(muscle.rate(0.5, 1.01 * least, slack, none).fibreVelocity, -0.1);
  EXPECT_EQ(muscle.rate(0.5, 0.99 * least, slack, none).fibreVelocity, 0);
  EXPECT_GT(muscle.rate(0.5, 0.99 * least, pulled, none).fibreVelocity, 0);

  // an implicit step from above ends there; from there with a pull it leaves
  constexpr double h = 0.001;
  const auto stepped = [&](double from, double length) {
    double next = from;
    for (int i = 0; i < 30; ++i) {
      const FibreRateDerivatives r =
          muscle.rateNear(0.5, (from + next) / 2, length, (next - from) / h, h, none);
      next -= ((next - from) / h - r.fibreVelocity) / (1 / h - r.dV_dFibreLength / 2);
    }
    return next;
  };
  EXPECT_GT(stepped(least + 1e-3, slack), least + 1e-4);
  EXPECT_NEAR(stepped(least + 1e-4, slack), least, 1e-14);
  EXPECT_NEAR(stepped(least, slack), least, 1e-15);
  EXPECT_GT(stepped(least, pulled), least + 1e-5);
}

}  // namespace
}  // namespace bio
