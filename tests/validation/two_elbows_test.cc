#include <gtest/gtest.h>

#include <numbers>

#include "stiff_solver.h"
#include "support/shipped_elbow.h"
#include "true_elbow.h"

// The benchmark's elbow beside libbio's: two programs for the same equations, each written without
// the other.
namespace hidden {
namespace {

TEST(TwoElbows, MoveAlikeWhereNothingIsHidden) {
  const bio::fixtures::ShippedElbow theirs;
  bio::SimulationOptions options;
  options.integrator = bio::Integrator::cvode;
  options.duration = 4.5;
  options.step = 0.005;
  const Eigen::VectorXd q0 = bio::startCoordinates(theirs.trial, theirs.arm, {});
  const bio::Trajectory reference =
      bio::simulate(theirs.arm, theirs.excitation,
                    bio::initialState(theirs.arm, q0, theirs.excitation, 0), options);

  const TrueElbow elbow(readElbow(theirs.root() + "/models/elbow8.osim"), {}, {});
  Recording recording;
  for (Eigen::Index k = 0; k < theirs.trial.times.size(); ++k) {
    recording.times.push_back(theirs.trial.times[k]);
    std::array<double, 8> row{};
    for (std::size_t i = 0; i < 8; ++i) {
      row[i] = theirs.trial.excitations(k, static_cast<Eigen::Index>(i));
    }
    recording.emg.push_back(row);
  }
  StiffSolver solver(elbow, recording, elbow.start(recording, q0[0]));
  double largest = 0, largestFibre = 0;
  for (std::size_t k = 0; k < recording.times.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    const Eigen::VectorXd& y = solver.advanceTo(recording.times[k]);
    largest = std::max(largest, std::abs(y[0] - reference.q(0, row)));
    largestFibre = std::max(
        largestFibre, (y.segment(10, 8) - reference.fibreLength.col(row)).cwiseAbs().maxCoeff());
  }
  EXPECT_LT(largest / degree, 1e-5);  // measured 6e-7°
  EXPECT_LT(largestFibre, 1e-8);      // [m]
}

TEST(TwoElbows, HaveTheSameLengthsAndMomentArms) {
  const bio::fixtures::ShippedElbow theirs;
  const TrueElbow elbow(readElbow(theirs.root() + "/models/elbow8.osim"), {}, {});
  const Eigen::VectorXd angles = Eigen::VectorXd::LinSpaced(261, 0, 130 * degree);
  const bio::PathSample sample = bio::samplePaths(theirs.model, theirs.arm.skeleton(), {}, angles);
  ASSERT_EQ(sample.muscles.size(), 8u);
  for (Eigen::Index i = 0; i < 8; ++i) {
    EXPECT_EQ(sample.muscles[static_cast<std::size_t>(i)],
              elbow.numbers().muscles[static_cast<std::size_t>(i)].name);
    for (Eigen::Index k = 0; k < angles.size(); ++k) {
      const TrueElbow::Arm arm = elbow.arm(i, angles[k]);
      EXPECT_NEAR(arm.length, sample.length(k, i), 1e-13);
      EXPECT_NEAR(-arm.slope, sample.momentArm(k, i), 1e-12);
      EXPECT_EQ(arm.wraps, sample.wrapped(k, i) == 1) << i << " at " << angles[k] / degree;
    }
  }
}

}  // namespace
}  // namespace hidden
