#include "robots/robot_motion.h"

#include <gmock/gmock.h>

#include <cmath>

#include "support/throws_saying.h"

namespace {

using namespace info;
using robot::MotionRequest;
using support::throwsSaying;

TEST(RobotMotion, StartsFromTheGivenInputs) {
  MotionRequest request{.discrete = true};
  request.iterations = 0;
  request.trials = 2;
  ASSERT_EQ(robot::numInputs(request), 251u);
  for (int k = 0; k <= 250; ++k) request.warmStart.push_back(0.02 * std::sin(0.05 * k));
  const robot::MotionResult found = robot::optimiseMotion(request);
  EXPECT_EQ(found.search.iterations, 0);
  for (std::size_t k = 0; k < 251; ++k) {
    EXPECT_EQ(found.before.u[k][0], request.warmStart[k]);
    EXPECT_EQ(found.after.u[k][0], request.warmStart[k]);
  }
  EXPECT_EQ(static_cast<Eigen::Index>(found.states.size()), found.before.x.front().size());
  EXPECT_TRUE((found.boundBefore * found.search.informationStart).isIdentity(1e-9));
  EXPECT_TRUE(found.before.grown.back().isApprox(found.search.informationStart, 1e-9));
}

// What the motions of several candidates have in common is the input.
TEST(RobotMotion, OfSeveralCandidatesIsThatOfTheFirst) {
  MotionRequest request{.discrete = true};
  request.iterations = 0;
  request.trials = 2;
  const robot::MotionResult alone = robot::optimiseMotion(request);
  request.robust = RobustRule::worst;
  const robot::MotionResult several = robot::optimiseMotion(request);
  ASSERT_EQ(several.robust->candidates.size(), 5u);
  EXPECT_EQ(several.before.x, alone.before.x);
  EXPECT_EQ(several.before.u, alone.before.u);
  EXPECT_EQ(several.robust->initial[0], several.robust->nominal[0]);
  EXPECT_LT(several.robust->initial.minCoeff(), several.robust->initial[0]);
}

TEST(RobotMotion, ProgressEndsTheSearchByAnException) {
  struct Enough {};
  MotionRequest request{.discrete = true};
  request.progress = [](const char*, double) { throw Enough(); };
  EXPECT_THROW(robot::optimiseMotion(request), Enough);
}

TEST(RobotMotion, HasNoInformationToStartFromWhereTheCartStandsStill) {
  EXPECT_THROW(robot::optimiseMotion({.amplitude = 0}), NoInformation);
}

TEST(RobotMotion, SaysWhichRuleARequestBreaks) {
  const auto refused = [](const MotionRequest& request, const char* words) {
    throwsSaying([&] { robot::optimiseMotion(request); }, words);
  };
  refused({.amplitude = -1}, "amplitude: -1 m, must be ≥ 0");
  refused({.period = 0}, "period: 0 s, must be > 0");
  refused({.perturb = std::nan("")}, "perturb: nan, must be > 0");
  refused({.tolerance = -1}, "tolerance: -1, must be ≥ 0");
  refused({.iterations = -1}, "iterations: -1");
  refused({.trials = 0}, "trials: 0");
  refused({.discrete = true, .stepsPerSample = 0}, "steps between measurements: 0");
  refused({.stepsPerSample = 2}, "must be of a discrete motion");
  refused({.pendulum = false, .discrete = true}, "must be of the double pendulum");
  refused({.discrete = true, .laboratory = LaboratoryEffects{}}, "laboratory");
  refused({.candidates = {{1, 1}}}, "must be of a robust search");
  refused({.warmStart = {1, 2}}, "warm start: 2 inputs, must be 601");
  refused({.pendulum = false, .warmStart = std::vector<double>(501, std::nan(""))},
          "warm start: input 1 is nan");
}

}  // namespace
