#include "bio/sensitivity/coupled_sensitivity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "simulation/step_tape.h"
#include "support/sensitivity_differences.h"
#include "support/shipped_elbow.h"

namespace bio {
namespace {

using fixtures::DiscoveryProblem;
using fixtures::forSeconds;
using fixtures::ShippedElbow;

DiscoveryProblem compare(const ShippedElbow& elbow, const std::vector<std::size_t>& wanted,
                         const SimulationOptions& options) {
  DiscoveryProblem d = fixtures::compareWithDifferences(
      elbow.system, ShippedElbow::options(), elbow.excitation, elbow.catalogue, wanted, options);
  fixtures::tell(d);
  return d;
}

stepping::StepTape tapeOf(const MusculoskeletalSystem& system, const ExcitationSignal& excitation,
                          const SystemState& start, const SimulationOptions& options) {
  stepping::StepTape tape;
  stepping::simulateVariational(system, excitation, start, options, &tape);
  return tape;
}

std::ptrdiff_t timesWithLaw(const stepping::StepTape& tape, stepping::StepTape::Time::Law law) {
  return std::count_if(tape.times().begin(), tape.times().end(),
                       [&](const auto& time) { return time.law == law; });
}

TEST(CoupledSensitivity, MatchesDifferencesForEveryParameterOfTheShippedModel) {
  const ShippedElbow elbow;
  const DiscoveryProblem d = compare(elbow, elbow.catalogue.select({"all"}), forSeconds(0.3));
  EXPECT_EQ(d.parameters, 285);
  EXPECT_LT(d.worst, 1e-5) << d.of;
  EXPECT_LE(d.undecidedMotion.size(), 4u) << ::testing::PrintToString(d.undecidedMotion);
}

// The passive model's own numbers, where the arm is beyond a limit and across the switch of BRA.
TEST(CoupledSensitivity, MatchesDifferencesForPassiveForcesAndAcrossASwitch) {
  const ShippedElbow elbow("elbow8_passive", "curl_fast");
  const auto options = forSeconds(0.8);
  const stepping::StepTape tape =
      tapeOf(elbow.system, elbow.excitation,
             startOf(elbow.system, elbow.catalogue.nominal(), elbow.excitation, 0), options);
  EXPECT_GT(timesWithLaw(tape, stepping::StepTape::Time::Law::onSwitch), 0);
  const DiscoveryProblem d =
      compare(elbow,
              elbow.catalogue.select({"elbow_flexion_*", "BRA.point*", "BRA.*_length", "TRI.*",
                                      "emg.*", "initial.*", "activation.activation1", "hand.*"}),
              options);
  EXPECT_LT(d.worst, 1e-5) << d.of;
}

TEST(CoupledSensitivity, MatchesDifferencesForTheLeftForcedScheme) {
  const ShippedElbow elbow;
  SimulationOptions options = forSeconds(0.4);
  options.integrator = Integrator::variationalLeft;
  const DiscoveryProblem d = compare(
      elbow, elbow.catalogue.select({"TRI.*", "BIClong.*", "ulna.*", "initial.*"}), options);
  EXPECT_LT(d.worst, 1e-5) << d.of;
}

TEST(CoupledSensitivity, MatchesDifferencesForTwoCoordinatesThatStartMoving) {
  Model model = readOsim(ShippedElbow::root() + "/models/elbow8.osim");
  model.springForces.push_back({"elbow_spring", "elbow_flexion", 3.0, 0.8, 0.2, true});
  const SystemOptions systemOptions{{{"elbow_flexion", "pro_sup"}, {}}, {}, {}};
  const MusculoskeletalSystem system(model, systemOptions);
  const Trial trial = readTrial(ShippedElbow::root() + "/emg_data/curl_slow.sto", model);
  const ExcitationSignal excitation = excitationOf(trial, system);
  const ParameterCatalogue catalogue(model, system,
                                     {Eigen::Vector2d(0.6, 0.1), Eigen::Vector2d(0.5, -0.4)});
  const auto wanted =
      catalogue.select({"BIClong.max_isometric_force", "BIClong.point9.x", "BIClong.point10.y",
                        "BRD.point3.z", "TRI.radius", "TRI.rotation.x", "hand.mass",
                        "radius.mass_center.x", "hand.inertia.yy", "elbow_spring.*", "initial.*"});
  const DiscoveryProblem d = fixtures::compareWithDifferences(system, systemOptions, excitation,
                                                              catalogue, wanted, forSeconds(0.12));
  fixtures::tell(d);
  EXPECT_LT(d.worst, 1e-5) << d.of;
}

// Excitations that jump make Newton fail: steps are halved, also behind a switch.
TEST(CoupledSensitivity, MatchesDifferencesWhereStepsAreHalved) {
  const Model model = readOsim(ShippedElbow::root() + "/models/elbow8.osim");
  const MusculoskeletalSystem system(model, ShippedElbow::options());
  std::vector<double> times;
  Eigen::MatrixXd u(12, static_cast<Eigen::Index>(system.numMuscles()));
  for (int k = 0; k < 12; ++k) {
    times.push_back(0.05 * k);
    for (Eigen::Index i = 0; i < u.cols(); ++i) u(k, i) = (k / 3 + i) % 2 == 0 ? 0.02 : 0.9;
  }
  const ExcitationSignal excitation(times, u);
  const ParameterCatalogue catalogue(model, system, {Eigen::VectorXd::Constant(1, 0.75), {}});
  SimulationOptions options = forSeconds(0.5);
  options.step = 0.05;
  options.maxIterations = 3;
  const stepping::StepTape tape =
      tapeOf(system, excitation, startOf(system, catalogue.nominal(), excitation, 0), options);
  EXPECT_GT(timesWithLaw(tape, stepping::StepTape::Time::Law::middle), 0);
  const DiscoveryProblem d = fixtures::compareWithDifferences(
      system, ShippedElbow::options(), excitation, catalogue,
      catalogue.select({"BRA.*", "TRI.radius", "hand.mass", "initial.*"}), options);
  fixtures::tell(d);
  EXPECT_LT(d.worst, 1e-5) << d.of;
}

TEST(CoupledSensitivity, MatchesDifferencesForEmgThatIsDelayedAndShaped) {
  const ShippedElbow elbow("elbow8", "curl_slow", EmgMapping{{{"BRA", 1.1}}, 0.0123, -0.8});
  const DiscoveryProblem d =
      compare(elbow, elbow.catalogue.select({"emg.*", "BRA.activation*"}), forSeconds(0.6));
  EXPECT_LT(d.worst, 1e-5) << d.of;
}

// Also through the delay, the shape and fatigue of what is recorded.
TEST(CoupledSensitivity, MatchesDifferencesForALatentExcitation) {
  EmgMapping mapping{{{"BRA", 1.1}}, 0.0123, -0.8};
  mapping.fatigue = 0.2;
  mapping.latent["BRA"] = {{0, 0.21, 0.4, 0.6}, Eigen::Vector4d(0.3, -0.5, 0.2, 0.4), 1};
  const ShippedElbow elbow("elbow8", "curl_slow", mapping);
  const auto wanted = elbow.catalogue.select({"emg.BRA.latent*", "emg.BRA.gain", "hand.mass"});
  ASSERT_EQ(wanted.size(), 6u);
  const DiscoveryProblem d = compare(elbow, wanted, forSeconds(0.6));
  EXPECT_LT(d.worst, 1e-5) << d.of;
}

TEST(CoupledSensitivity, AGroupIsTheSumOfItsMembers) {
  const ShippedElbow elbow;
  std::vector<std::size_t> wanted = elbow.catalogue.select({"*.time_scale"});
  const auto members = static_cast<Eigen::Index>(wanted.size());
  wanted.push_back(elbow.catalogue.find("activation.time_scale"));
  const SensitivityTrajectory s =
      simulateWithSensitivities(elbow.system, elbow.catalogue, elbow.catalogue.nominal(), wanted,
                                elbow.excitation, {forSeconds(1), false});
  EXPECT_EQ(members, 8);
  const Eigen::VectorXd sum = s.q[0].leftCols(members).rowwise().sum();
  EXPECT_LT((sum - s.q[0].col(members)).norm(), 1e-12 * sum.norm());
}

// A cylinder without friction knows neither a shift along nor a turn about its axis.
TEST(CoupledSensitivity, AWrapShiftedAlongItsAxisMovesNothing) {
  const ShippedElbow elbow;
  const auto wanted = elbow.catalogue.select({"TRI.translation.*"});
  const SensitivityTrajectory s =
      simulateWithSensitivities(elbow.system, elbow.catalogue, elbow.catalogue.nominal(), wanted,
                                elbow.excitation, {forSeconds(2.5), false});
  const Eigen::Vector3d& o = findWrapObject(elbow.model, "TRI").frame.orientation;
  const Eigen::Vector3d axis = Eigen::AngleAxisd(o.x(), Eigen::Vector3d::UnitX()) *
                               (Eigen::AngleAxisd(o.y(), Eigen::Vector3d::UnitY()) *
                                Eigen::Vector3d(Eigen::Vector3d::UnitZ()));
  EXPECT_GT(s.q[0].norm(), 1);
  EXPECT_LT((s.q[0] * axis).norm(), 1e-9 * s.q[0].norm());
}

TEST(CoupledSensitivity, TheMotionIsThatOfSimulate) {
  const ShippedElbow elbow;
  const SensitivityTrajectory s = simulateWithSensitivities(
      elbow.system, elbow.catalogue, elbow.catalogue.nominal(),
      elbow.catalogue.select({"TRI.radius"}), elbow.excitation, {forSeconds(2), true});
  const Trajectory motion =
      simulateSetting(elbow.system, elbow.catalogue.nominal(), elbow.excitation, forSeconds(2));
  EXPECT_EQ(s.motion.q, motion.q);
  EXPECT_EQ(s.q[0].rows(), motion.q.cols());
}

TEST(CoupledSensitivity, OtherIntegratorsAreRefused) {
  const ShippedElbow elbow;
  SimulationOptions options = forSeconds(1);
  options.integrator = Integrator::cvode;
  EXPECT_THROW(simulateWithSensitivities(elbow.system, elbow.catalogue, elbow.catalogue.nominal(),
                                         {}, elbow.excitation, {options, false}),
               std::invalid_argument);
  options = forSeconds(-1);
  EXPECT_THROW(simulateWithSensitivities(elbow.system, elbow.catalogue, elbow.catalogue.nominal(),
                                         {}, elbow.excitation, {options, false}),
               std::invalid_argument);
}

}  // namespace
}  // namespace bio
