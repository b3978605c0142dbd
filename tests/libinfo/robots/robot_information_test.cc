#include "robots/robot_information.h"

#include <gmock/gmock.h>

#include <cmath>

#include "support/throws_saying.h"

namespace {

using namespace info;
using support::throwsSaying;

// (4.5) of the source prints the bound with three digits.
TEST(RobotInformation, IsThatOfTheThesis) {
  const auto plan = robot::plannedExperiment({});
  const robot::ExperimentInformation found = robot::informationOf(plan);
  EXPECT_EQ(found.identifiability.rank, 2);
  EXPECT_NEAR(found.bound(0, 0), 2.71e-4, 0.05 * 2.71e-4);
  EXPECT_NEAR(found.bound(1, 1), 1.05, 0.05 * 1.05);
  EXPECT_TRUE(found.bound.isApprox(robot::boundOf(plan), 1e-12));
  EXPECT_NEAR(found.eigenvalues.prod(), found.information.determinant(),
              1e-9 * found.eigenvalues.prod());
}

TEST(RobotInformation, HasNoBoundWithoutDampingWhereOnlyTheRatioOfMassesCounts) {
  const robot::ExperimentInformation found =
      robot::informationOf(robot::plannedExperiment({.bothMasses = true, .undamped = true}));
  EXPECT_EQ(found.identifiability.rank, 1);
  EXPECT_EQ(found.bound.size(), 0);
}

TEST(RobotInformation, TakesAnotherMotionOfTheCart) {
  const auto lively =
      robot::plannedExperiment({.pendulum = false, .amplitude = 0.1, .period = 1.2});
  const auto quiet = robot::plannedExperiment({.pendulum = false});
  EXPECT_GT(robot::informationOf(lively).eigenvalues[0],
            1e3 * robot::informationOf(quiet).eigenvalues[0]);
  EXPECT_TRUE(robot::informationOf(lively).information.isApprox(
      robot::informationOf(suspendedMassExperiment(suspendedMassLively())).information, 1e-12));
}

TEST(RobotInformation, SaysWhichRuleARequestBreaks) {
  throwsSaying([] { robot::plannedExperiment({.pendulum = false, .bothMasses = true}); },
               "must be of the double pendulum");
  throwsSaying([] { robot::plannedExperiment({.undamped = true}); }, "undamped");
  throwsSaying([] { robot::plannedExperiment({.period = std::nan("")}); }, "must be > 0");
}

TEST(RobotInformation, ProgressEndsSimulatedTrialsByAnException) {
  struct Enough {};
  const auto plan = robot::plannedExperiment({.period = 2});
  int told = 0;
  const auto progress = [&](const char* doing, double) {
    EXPECT_STREQ(doing, "tries");
    if (++told == 2) throw Enough();
  };
  EXPECT_THROW(robot::simulateTrials(plan, 50, 1, 2, "tries", progress), Enough);
  EXPECT_LT(told, 10);
}

}  // namespace
