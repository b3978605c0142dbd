#include "true_elbow.h"

#include <gtest/gtest.h>

#include <numbers>

#include "stiff_solver.h"
#include "support/shipped_elbow.h"

namespace hidden {
namespace {

constexpr double degree = std::numbers::pi / 180;

ElbowNumbers shipped() {
  return readElbow(std::string(FISHERHILL_SOURCE_DIR) + "/models/elbow8.osim");
}

// An effort with every muscle at its own pace, straight between 20 ms.
Recording effort(double seconds) {
  Recording recording;
  for (int k = 0; k <= static_cast<int>(seconds / 0.02 + 0.5); ++k) {
    const double t = 0.02 * k;
    recording.times.push_back(t);
    std::array<double, 8> u{};
    for (std::size_t i = 0; i < 8; ++i) {
      const double pace = 1.0 + 0.2 * static_cast<double>(i);
      u[i] = (i < 4 ? 0.03 : 0.06) * (1 + 0.8 * std::sin(2 * pace * t + static_cast<double>(i)));
    }
    recording.emg.push_back(u);
  }
  return recording;
}

TEST(TrueElbow, MovesAsLibbioSaysWhereNothingIsHidden) {
  const bio::testing::ShippedElbow theirs;
  bio::SimulationOptions options;
  options.integrator = bio::Integrator::cvode;
  options.duration = 4.5;
  options.step = 0.005;
  options.relativeTolerance = 1e-11;
  const Eigen::VectorXd q0 = bio::startCoordinates(theirs.trial, theirs.arm, {});
  const bio::Trajectory reference =
      bio::simulate(theirs.arm, theirs.excitation,
                    bio::initialState(theirs.arm, q0, theirs.excitation, 0), options);

  const TrueElbow elbow(shipped(), {}, {});
  Recording recording;
  for (Eigen::Index k = 0; k < theirs.trial.times.size(); ++k) {
    recording.times.push_back(theirs.trial.times[k]);
    std::array<double, 8> row{};
    for (Eigen::Index i = 0; i < 8; ++i) {
      row[static_cast<std::size_t>(i)] = theirs.trial.excitations(k, i);
    }
    recording.emg.push_back(row);
  }
  StiffSolver solver(elbow, recording, elbow.start(recording, q0[0]));
  double largest = 0;
  for (std::size_t k = 0; k < recording.times.size(); ++k) {
    const double q = solver.advanceTo(recording.times[k])[0];
    largest = std::max(largest, std::abs(q - reference.q(0, static_cast<Eigen::Index>(k))));
  }
  RecordProperty("largest_deg", std::to_string(largest / degree));
  std::printf("largest %.3g deg\n", largest / degree);
  EXPECT_LT(largest / degree, 1e-4);
}

}  // namespace
}  // namespace hidden
