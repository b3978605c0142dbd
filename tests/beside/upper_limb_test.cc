// The full MoBL-ARMS upper limb, elbow free, everything else locked at its defaults. Its terms keep
// it out of the project; CMake leaves this program out where it does not lie beside it.
#include <gtest/gtest.h>

#include "bio/analysis/replay.h"
#include "bio/opensim/osim_file.h"
#include "second_ways/simbody_tree.h"
#include "support/scratch_folder.h"

namespace bio {
namespace {

std::filesystem::path upperLimb() {
  return std::filesystem::path(FISHERHILL_SOURCE_DIR) /
         "../shared/data/models/MoBL_ARMS_v3_schutte.osim";
}

class UpperLimb : public ::testing::Test {
 protected:
  const Model model_ = readOsim(upperLimb());
};

TEST_F(UpperLimb, ForearmInertiaAndGravityMomentAreThoseOfSimbodyOnTheFullModel) {
  const Skeleton skeleton(model_, {{"elbow_flexion"}, {}});
  EXPECT_TRUE(skeleton.hasConstantInertia());
  const SimbodyTree tree(model_);
  std::vector<RigidMotion<double, 1>> moved(skeleton.numSegments());
  for (double q = 0; q < 2.3; q += 0.1) {
    const Eigen::Matrix<double, 1, 1> at(q);
    skeleton.motions<double, 1>(at, moved.data());
    const auto jet = skeleton.inertia<1>(at, moved.data());
    const auto reference = tree.reducedTo({"elbow_flexion"}, {{"elbow_flexion", q}});
    EXPECT_NEAR(jet.massMatrix(0, 0), reference.massMatrix(0, 0), 1e-13);
    EXPECT_NEAR(-jet.dV[0], reference.gravityForce[0], 1e-12);
  }
}

TEST_F(UpperLimb, SimulatesWithEveryMuscleThatHasAnExactPath) {
  const MusculoskeletalSystem system(model_, {{{"elbow_flexion"}, {}}, {"Elbow_BIC_BRD"}, {}});
  EXPECT_GE(system.numMuscles(), 8u);
  for (const std::string& warning : system.warnings()) ADD_FAILURE() << warning;
  Eigen::MatrixXd u =
      Eigen::MatrixXd::Constant(2, static_cast<Eigen::Index>(system.numMuscles()), 0.02);
  for (std::size_t i = 0; i < system.numMuscles(); ++i) {
    if (system.muscles()[i].name.starts_with("BIC"))
      u.col(static_cast<Eigen::Index>(i)).setConstant(0.15);
  }
  const ExcitationSignal excitation({0, 4.5}, u);
  const SystemState start = initialState(system, Eigen::VectorXd::Constant(1, 0.6), excitation, 0);
  SimulationOptions options;
  options.duration = 4.5;
  const Trajectory variational = simulate(system, excitation, start, options);
  ASSERT_EQ(variational.outcome, Outcome::completed) << variational.why;
  options.integrator = Integrator::cvode;
  const Trajectory reference = simulate(system, excitation, start, options);
  ASSERT_EQ(reference.outcome, Outcome::completed) << reference.why;
  EXPECT_LT((variational.q - reference.q).cwiseAbs().maxCoeff(), 0.01);  // 0.6 deg
}

TEST_F(UpperLimb, EllipsoidsAndToriNeedNoOption) {
  const MusculoskeletalSystem system(model_, {{{"elbow_flexion"}, {}}, {}, {}});
  for (const std::string& warning : system.warnings()) ADD_FAILURE() << warning;
}

TEST_F(UpperLimb, WritingItBackAndReadingItAgainChangesNothing) {
  const support::ScratchFolder folder;
  rewriteOsim(upperLimb(), model_, folder / "copy.osim");
  EXPECT_EQ(readOsim(folder / "copy.osim"), model_);
}

}  // namespace
}  // namespace bio
