// The shipped elbows beside what OpenSim 4.6 computed for them (tests/libbio/reference/opensim).
#include <gtest/gtest.h>

#include "bio/analysis/path_postures.h"
#include "libbio/simulation/opensim_motion.h"
#include "support/reference.h"
#include "support/shipped_elbow.h"

namespace bio {
namespace {

using support::degree;

TEST(OpenSimReference, LengthsAndMomentArmsAgreeOverTheWholeRange) {
  const Table table = readTable(fixtures::reference("opensim/elbow8_paths.csv"), TableKind::any);
  const Eigen::VectorXd all = table.values.col(columnIndex(table, "elbow_flexion_deg"));
  // the rows from 0 to 108 degrees; beyond, OpenSim's BRD comes to wrap the long way round
  constexpr Eigen::Index first = 45, rows = 109;
  ASSERT_EQ(all[first], 0);
  ASSERT_EQ(all[first + rows - 1], 108);
  const Eigen::VectorXd q = all.segment(first, rows) * degree;
  const Model model = fixtures::ShippedElbow().model;
  const Skeleton skeleton(model, {{"elbow_flexion"}, {}});
  const PathSample sample = samplePaths(model, skeleton, {}, q);
  ASSERT_EQ(sample.muscles.size(), 8u);
  double worstLength = 0, worstArm = 0, worstFree = 0;
  for (std::size_t i = 0; i < 8; ++i) {
    const auto c = static_cast<Eigen::Index>(i);
    const std::string& muscle = sample.muscles[i];
    const auto column = [&](const char* what) {
      return table.values.col(columnIndex(table, muscle + what)).segment(first, rows);
    };
    const auto length = column(".length_m"), system = column(".moment_arm_m"),
               wrapped = column(".wrapped");
    for (Eigen::Index k = 0; k < q.size(); ++k) {
      worstLength = std::max(worstLength, std::abs(sample.length(k, c) - length[k]));
      worstArm = std::max(worstArm, std::abs(sample.momentArm(k, c) - system[k]));
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
  EXPECT_LT(worstFree, 1e-7);
}

// elbow6.osim is arm26 under other names. The heads that OpenSim leads over an ellipsoid are left
// out: there its path is not the shortest one (docs/theory/wrapping.md).
TEST(OpenSimReference, TheFreeElbowHasThePathsOfArm26) {
  const Model model = readOsim(fixtures::ShippedElbow::root() + "/models/elbow6.osim");
  const LengthTable theirs = readLengths(fixtures::reference("opensim/postures_arm26.csv"), model);
  const PathPostures ours = pathsAt(model, theirs.postures, {}, {});
  ASSERT_EQ(theirs.postures.values.rows(), 30);
  ASSERT_EQ(theirs.muscles.size(), 4u);
  double worstFree = 0, worstLength = 0, worstSlope = 0;
  for (std::size_t k = 0; k < theirs.muscles.size(); ++k) {
    const auto found = std::ranges::find(ours.muscles, theirs.muscles[k]);
    ASSERT_NE(found, ours.muscles.end()) << theirs.muscles[k];
    const auto i = static_cast<std::size_t>(found - ours.muscles.begin());
    const Eigen::VectorXd length = ours.length.col(static_cast<Eigen::Index>(i)) -
                                   theirs.length.col(static_cast<Eigen::Index>(k));
    const Eigen::MatrixXd slope = ours.slope[i] - theirs.slope[k];
    for (Eigen::Index row = 0; row < length.size(); ++row) {
      const bool touches = !ours.touched[i][static_cast<std::size_t>(row)].empty();
      double& worst = touches ? worstLength : worstFree;
      worst = std::max(worst, std::abs(length[row]));
    }
    worstSlope = std::max(worstSlope, slope.cwiseAbs().maxCoeff());
  }
  std::printf("worst length %.2g m, unwrapped %.2g m, slope %.2g m/rad\n", worstLength, worstFree,
              worstSlope);
  EXPECT_LT(worstFree, 1e-9);
  EXPECT_LT(worstLength, 2e-5);  // OpenSim does not slide its contacts along the cylinder
  EXPECT_LT(worstSlope, 6e-5);
}

// The first 1.5 s of five motions, one of every muscle class at least.
std::vector<fixtures::OpenSimMotion> motions() {
  std::vector<fixtures::OpenSimMotion> list;
  const auto add = [&](const std::string& muscles, const std::string& trial,
                       const std::string& model) {
    list.push_back(
        {muscles + " " + trial, fixtures::ShippedElbow::root() + "/models/" + model + ".osim",
         fixtures::reference("opensim/excitations_" + trial + ".sto"),
         fixtures::reference("opensim/motion_" + muscles + "_" + trial + ".csv"),
         "elbow_flexion_rad", ".fibre_length_m", ".tendon_force_N", muscles != "Schutte1993"});
  };
  add("Schutte1993", "101", "elbow8");
  add("Schutte1993", "116", "elbow8");
  for (const auto& [muscles, trial] :
       {std::pair("Thelen2003", "201"), {"Millard2012", "201"}, {"DeGrooteFregly2016", "203"}}) {
    add(muscles, trial, std::string("elbow8_") + muscles);
  }
  return list;
}

TEST(OpenSimReference, CvodeMovesAsOpenSimDoes) {
  for (const fixtures::OpenSimMotion& motion : motions()) {
    const auto difference = fixtures::differenceFrom(motion, Integrator::cvode, 0.01);
    EXPECT_LT(difference.angle_deg, 0.05) << motion.name;
    EXPECT_LT(difference.fibre_m, 5e-5) << motion.name;
    EXPECT_LT(difference.force_N, 1.0) << motion.name;
  }
}

TEST(OpenSimReference, TheVariationalIntegratorStaysCloseAtOneHundredthOfASecond) {
  for (const fixtures::OpenSimMotion& motion : motions()) {
    EXPECT_LT(fixtures::differenceFrom(motion, Integrator::variational, 0.01).angle_deg, 0.15)
        << motion.name;
  }
}

// What remains is OpenSim's path of the long heads over the ellipsoids at the shoulder: as far
// apart as validation/muscles says of arm26 itself.
TEST(OpenSimReference, TheFreeElbowMovesAsArm26) {
  const fixtures::OpenSimMotion motion = {"arm26 301",
                                          fixtures::ShippedElbow::root() + "/models/elbow6.osim",
                                          fixtures::reference("opensim/excitations_arm26_301.sto"),
                                          fixtures::reference("opensim/motion_arm26_301.csv"),
                                          "elbow_flexion_rad",
                                          ".fibre_length_m",
                                          ".tendon_force_N"};
  const auto difference = fixtures::differenceFrom(motion, Integrator::cvode, 0.01);
  EXPECT_LT(difference.angle_deg, 0.15);
  EXPECT_LT(difference.fibre_m, 1e-4);
  EXPECT_LT(difference.force_N, 0.3);
}

}  // namespace
}  // namespace bio
