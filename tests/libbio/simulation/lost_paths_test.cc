// A posture in which a path has no taut string ends a motion by name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bio/path/path_lengths.h"
#include "bio/simulation/simulate.h"
#include "simulation/integrators.h"
#include "support/elbow_model.h"

namespace bio {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// The elbow whose brachialis passes two ellipsoids that intersect: beyond 67° no string is found.
Model withIntersectingObjects() {
  Model model = fixtures::elbowModel();
  WrapObject one;
  one.name = "one";
  one.body = "humerus";
  one.shape = WrapShape::ellipsoid;
  one.semiAxes = {0.012, 0.02, 0.05};
  one.frame.translation = {0.01, -0.24, 0};
  one.frame.orientation = {1.3, 9.1, 3.9};
  WrapObject other = one;
  other.name = "other";
  other.semiAxes = {0.05, 0.015, 0.01};
  other.frame.orientation = {2.6, -3.9, 14.3};
  model.wrapObjects.push_back(one);
  model.wrapObjects.push_back(other);
  for (Muscle& muscle : model.muscles) {
    if (muscle.name == "BRA") muscle.path.wraps = {{"one", -1, -1}, {"other", -1, -1}};
  }
  return model;
}

TEST(LostPath, EndsAMotionWithMusclePostureAndTime) {
  const Model model = withIntersectingObjects();
  {
    SystemOptions options;
    options.skeleton.freeCoordinates = {"elbow_flexion"};
    const MusculoskeletalSystem system(model, options);
    const Eigen::VectorXd good = Eigen::VectorXd::Constant(1, 1.0);
    const Eigen::VectorXd lost = Eigen::VectorXd::Constant(1, 1.25);
    EXPECT_EQ(stepping::describeLostPath(system, good), "");
    EXPECT_THAT(stepping::describeLostPath(system, lost),
                AllOf(HasSubstr("muscle 'BRA': its path has no taut string"),
                      HasSubstr("elbow_flexion = 71.6197 deg")));
    Eigen::MatrixXd u(2, system.numMuscles());
    for (Eigen::Index i = 0; i < u.cols(); ++i) {
      const bool flexes = system.muscles()[static_cast<std::size_t>(i)].name.starts_with("B");
      u.col(i).setConstant(flexes ? 0.6 : 0.02);
    }
    const ExcitationSignal excitation({0, 1}, u);
    try {
      initialState(system, lost, excitation, 0);
      FAIL() << "starts without a path";
    } catch (const NoStaticEquilibrium& e) {
      EXPECT_THAT(e.what(), AllOf(HasSubstr("at the start, 0 s: muscle 'BRA'"),
                                  HasSubstr("elbow_flexion = 71.6197 deg")));
    }
    const SystemState start = initialState(system, good, excitation, 0);
    for (const Integrator integrator : {Integrator::variational, Integrator::rungeKutta4}) {
      SimulationOptions run;
      run.integrator = integrator;
      run.step = integrator == Integrator::rungeKutta4 ? 2e-4 : 0.01;
      run.duration = 0.3;
      run.maxHalvings = 2;  // a search for a string that does not exist takes long
      const Trajectory motion = simulate(system, excitation, start, run);
      EXPECT_NE(motion.outcome, Outcome::completed);
      EXPECT_GT(motion.failedAt, 0);
      EXPECT_TRUE(motion.q.allFinite());
      EXPECT_THAT(motion.why, AllOf(HasSubstr("at t = "), HasSubstr("muscle 'BRA'"),
                                    HasSubstr("elbow_flexion = 6")));
    }
    MusclePath path = system.muscles()[0].path;
    for (const SystemMuscle& muscle : system.muscles()) {
      if (muscle.name == "BRA") path = muscle.path;
    }
    PathLengths lengths(system.skeleton());
    lengths.add(findMuscle(model, "BRA"), path);
    lengths.moveTo(lost);
    try {
      lengths.along(0);
      FAIL() << "has a length without a path";
    } catch (const std::domain_error& e) {
      EXPECT_THAT(e.what(), AllOf(HasSubstr("muscle 'BRA'"), HasSubstr("71.6197 deg")));
    }
  }
}

}  // namespace
}  // namespace bio
