#include <gtest/gtest.h>

#include <numbers>

#include "bio/analysis/path_postures.h"
#include "bio/discovery/add_effects.h"
#include "bio/discovery/musculoskeletal_problem.h"
#include "generator/data_set.h"
#include "generator/passive_trial.h"
#include "generator/stiff_solver.h"
#include "generator/true_elbow.h"
#include "info/discovery/likelihood/joint_fit.h"
#include "support/scratch_folder.h"
#include "support/shipped_elbow.h"

// The benchmark's elbow beside libbio's: two programs for the same equations, each written without
// the other.
namespace hidden {
namespace {

Recording recordingOf(const bio::Trial& trial) {
  Recording recording;
  for (Eigen::Index k = 0; k < trial.times.size(); ++k) {
    recording.times.push_back(trial.times[k]);
    std::array<double, 8> row{};
    for (std::size_t i = 0; i < 8; ++i) {
      row[i] = trial.excitations(k, static_cast<Eigen::Index>(i));
    }
    recording.emg.push_back(row);
  }
  return recording;
}

/// How far the two are apart under a shipped trial.
struct Apart {
  double angle = 0;  ///< [deg]
  double fibre = 0;  ///< [m]
};
Apart apart(const bio::Model& model, const bio::Trial& trial, const TrueElbow& elbow) {
  const bio::MusculoskeletalSystem arm(model, bio::fixtures::ShippedElbow::options());
  const bio::ExcitationSignal excitation = bio::excitationOf(trial, arm);
  bio::SimulationOptions options;
  options.integrator = bio::Integrator::cvode;
  options.duration = 4.5;
  options.step = 0.005;
  const Eigen::VectorXd q0 = bio::startCoordinates(trial, arm, {});
  const bio::Trajectory reference =
      bio::simulate(arm, excitation, bio::initialState(arm, q0, excitation, 0), options);
  const Recording recording = recordingOf(trial);
  StiffSolver solver(elbow, recording, elbow.start(recording, q0[0]));
  Apart largest;
  for (std::size_t k = 0; k < recording.times.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    const Eigen::VectorXd& y = solver.advanceTo(recording.times[k]);
    largest.angle = std::max(largest.angle, std::abs(y[0] - reference.q(0, row)) / degree);
    largest.fibre = std::max(
        largest.fibre, (y.segment(10, 8) - reference.fibreLength.col(row)).cwiseAbs().maxCoeff());
  }
  return largest;
}

TEST(TwoElbows, MoveAlikeWhereNothingIsHidden) {
  const bio::fixtures::ShippedElbow theirs;
  const TrueElbow elbow(readElbow(theirs.root() + "/models/elbow8.osim"), {}, {});
  const Apart largest = apart(theirs.model, theirs.trial, elbow);
  EXPECT_LT(largest.angle, 1e-5);  // measured 6e-7°
  EXPECT_LT(largest.fibre, 1e-8);
}

/// The shipped elbow with an effect of the catalogue moves as the independent one with its
/// `extras`.
void mustMoveAlike(const Extras& extras, const std::string& id, const Eigen::Vector2d& values,
                   double tolerance) {
  const bio::fixtures::ShippedElbow theirs;
  const TrueElbow elbow(readElbow(theirs.root() + "/models/elbow8.osim"), {}, extras);
  const bio::Model model =
      bio::discover::addEffects(theirs.model, theirs.options(), "elbow_flexion",
                                {{id, values, {}, 0, 0}}, {"a test", {}})
          .model;
  EXPECT_LT(apart(model, theirs.trial, elbow).angle, tolerance);
  EXPECT_GT(apart(theirs.model, theirs.trial, elbow).angle, 1);
}

TEST(TwoElbows, MoveAlikeOnAnElasticBand) {
  Extras extras;
  extras.band = 40;
  mustMoveAlike(extras, "spring", {extras.band, extras.bandRest}, 1e-4);
}

TEST(TwoElbows, MoveAlikeWithACubicStiffness) {
  Extras extras;
  extras.cubic = 1.5;
  mustMoveAlike(extras, "cubic", {extras.cubic, 1.2}, 1e-5);  // about the rest of Extras::cubic
}

// A relaxed arm that somebody else moves, turned as a whole and with a known mass in the hand:
// where gravity and a force on the hand come from then.
TEST(TwoElbows, MoveAlikeWhereTheArmIsTurned) {
  const bio::fixtures::ShippedElbow theirs;
  const support::ScratchFolder scratch;
  Truth truth;
  truth.numbers = readElbow(theirs.root() + "/models/elbow8.osim");
  truth.numbers.forearm.push_back({"known", 1, truth.numbers.hand, Eigen::Matrix3d::Zero()});
  truth.extras.handForce = 2;
  truth.extras.tilt = -0.1;
  truth.extras.turn = -45 * degree;
  TrialPlan plan;
  plan.angleNoise = 0;
  RandomNumbers random(8, 0);
  const NamedTrial made{"moved", makePassiveTrial(truth, plan, random), 1, -45};
  const auto file = scratch.file("moved.sto", asTable(made, "moved"));
  bio::discover::MusculoskeletalProblemOptions options;
  options.simulation.step = 0.002;
  const bio::discover::MusculoskeletalProblem data(
      theirs.model, theirs.options(), "elbow_flexion",
      {bio::readTrial(file, theirs.model, {.experimentalConditions = true})}, options);
  Eigen::VectorXd values = info::discover::nominalValues(data);
  const auto at = [&](const char* name) -> double& {
    std::size_t i = 0;
    while (data.quantities().at(i).name != name) ++i;
    return values[static_cast<Eigen::Index>(i)];
  };
  const auto largest = [&] {
    const Eigen::VectorXd angle = data.outputs(0, values, {});
    double far = 0;
    for (std::size_t k = 0; k < made.trial.angle.size(); ++k) {
      far = std::max(far, std::abs(angle[static_cast<Eigen::Index>(k)] - made.trial.angle[k]));
    }
    return far / degree;
  };
  EXPECT_GT(largest(), 5);
  at("trial1.initial.elbow_flexion") = made.trial.angle.front();
  at("handforce.force") = 2;
  at("tilt.angle") = -0.1;
  EXPECT_LT(largest(), 0.02);
  at("handforce.force") = -2;
  EXPECT_GT(largest(), 5);
}

TEST(TwoElbows, HaveTheSameLengthsAndMomentArms) {
  const bio::fixtures::ShippedElbow theirs;
  const TrueElbow elbow(readElbow(theirs.root() + "/models/elbow8.osim"), {}, {});
  const Eigen::VectorXd angles = Eigen::VectorXd::LinSpaced(261, 0, 130 * degree);
  const bio::PathSample sample =
      bio::samplePaths(theirs.model, theirs.system.skeleton(), {}, angles);
  ASSERT_EQ(sample.muscles.size(), 8u);
  for (Eigen::Index i = 0; i < 8; ++i) {
    EXPECT_EQ(sample.muscles[static_cast<std::size_t>(i)],
              elbow.numbers().muscles[static_cast<std::size_t>(i)].name);
    for (Eigen::Index k = 0; k < angles.size(); ++k) {
      const TrueElbow::MusculoskeletalSystem arm = elbow.arm(i, angles[k]);
      EXPECT_NEAR(arm.length, sample.length(k, i), 1e-13);
      EXPECT_NEAR(-arm.slope, sample.momentArm(k, i), 1e-12);
      EXPECT_EQ(arm.wraps, sample.wrapped(k, i) == 1) << i << " at " << angles[k] / degree;
    }
  }
}

}  // namespace
}  // namespace hidden
