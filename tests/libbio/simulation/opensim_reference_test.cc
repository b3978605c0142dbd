// The reduced elbow beside what OpenSim 4.6 computed for it.
#include <gtest/gtest.h>

#include <numbers>

#include "bio/analysis/path_postures.h"
#include "support/numbers.h"
#include "support/reference.h"

namespace bio {
namespace {

using support::degree;

TEST(OpenSimReference, LengthsAndMomentArmsAgreeOverTheWholeRange) {
  FISHERHILL_NEEDS_REFERENCE();
  const Table table = readTable(fixtures::reference("elbow8_paths.csv"), TableKind::any);
  const Model model = readOsim(fixtures::reference("elbow8_reference.osim"));
  const Skeleton skeleton(model, {{"elbow_flexion"}, {}});
  const Eigen::VectorXd q = table.values.col(columnIndex(table, "elbow_flexion_deg")) * degree;
  const PathSample sample = samplePaths(model, skeleton, {}, q);
  ASSERT_EQ(sample.muscles.size(), 8u);
  double worstLength = 0, worstArm = 0, worstFree = 0;
  for (std::size_t i = 0; i < 8; ++i) {
    const auto c = static_cast<Eigen::Index>(i);
    const std::string& muscle = sample.muscles[i];
    const auto length = table.values.col(columnIndex(table, muscle + ".length_m"));
    const auto arm = table.values.col(columnIndex(table, muscle + ".moment_arm_m"));
    const auto wrapped = table.values.col(columnIndex(table, muscle + ".wrapped"));
    for (Eigen::Index k = 0; k < q.size(); ++k) {
      worstLength = std::max(worstLength, std::abs(sample.length(k, c) - length[k]));
      worstArm = std::max(worstArm, std::abs(sample.momentArm(k, c) - arm[k]));
      if (wrapped[k] == 0) {
        worstFree = std::max(worstFree, std::abs(sample.length(k, c) - length[k]));
      }
      EXPECT_EQ(sample.wrapped(k, c), static_cast<int>(wrapped[k])) << muscle << " " << k;
    }
  }
  std::printf("worst length %.2g m, moment arm %.2g m, unwrapped length %.2g m\n", worstLength,
              worstArm, worstFree);
  EXPECT_LT(worstLength, 2e-6);
  EXPECT_LT(worstArm, 1e-5);
  EXPECT_LT(worstFree, 1e-8);
}

struct Comparison {
  double angle_deg;
  double fibre_m;
  double force_N;
};

Comparison compare(const std::string& trial, Integrator integrator, double step) {
  const MusculoskeletalSystem arm = fixtures::referenceArm();
  const Model model = readOsim(fixtures::reference("elbow8_reference.osim"));
  const Trial excitations = readTrial(fixtures::reference("excitations_" + trial + ".sto"), model);
  const Table motion = readTable(fixtures::reference("forward_" + trial + ".csv"));
  const auto q = motion.values.col(columnIndex(motion, "elbow_flexion_rad"));
  const ExcitationSignal excitation = excitationOf(excitations, arm);
  SimulationOptions options;
  options.integrator = integrator;
  options.step = step;
  options.duration = 4.5;
  const SystemState start = initialState(arm, Eigen::VectorXd::Constant(1, q[0]), excitation, 0);
  const Trajectory ours = simulate(arm, excitation, start, options);
  EXPECT_EQ(ours.outcome, Outcome::completed) << ours.why;
  const MuscleReport muscles = reportMuscles(arm, ours);
  const auto stride = static_cast<Eigen::Index>(std::lround(0.01 / step));
  Comparison worst{0, 0, 0};
  double sum = 0;
  for (Eigen::Index k = 0; k < q.size(); ++k) {
    const double difference = ours.q(0, k * stride) - q[k];
    sum += difference * difference;
    for (std::size_t i = 0; i < arm.numMuscles(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const std::string& name = arm.muscles()[i].name;
      const double fibre = motion.values(k, columnIndex(motion, name + ".fiber_length_m"));
      const double force = motion.values(k, columnIndex(motion, name + ".tendon_force_N"));
      worst.fibre_m = std::max(worst.fibre_m, std::abs(ours.fibreLength(row, k * stride) - fibre));
      worst.force_N =
          std::max(worst.force_N, std::abs(muscles.tendonForce(row, k * stride) - force));
    }
  }
  worst.angle_deg = std::sqrt(sum / static_cast<double>(q.size())) / degree;
  std::printf("%s: angle %.4g deg rms, fibre %.3g m, force %.3g N\n", trial.c_str(),
              worst.angle_deg, worst.fibre_m, worst.force_N);
  return worst;
}

TEST(OpenSimReference, CvodeMovesAsOpenSimDoes) {
  FISHERHILL_NEEDS_REFERENCE();
  for (const char* trial : {"101", "116"}) {
    const Comparison c = compare(trial, Integrator::cvode, 0.01);
    EXPECT_LT(c.angle_deg, 0.05) << trial;
    EXPECT_LT(c.fibre_m, 5e-5) << trial;
    EXPECT_LT(c.force_N, 1.0) << trial;
  }
}

TEST(OpenSimReference, TheVariationalIntegratorStaysCloseAtOneHundredthOfASecond) {
  FISHERHILL_NEEDS_REFERENCE();
  for (const char* trial : {"101", "116"}) {
    EXPECT_LT(compare(trial, Integrator::variational, 0.01).angle_deg, 0.15) << trial;
  }
}

}  // namespace
}  // namespace bio
