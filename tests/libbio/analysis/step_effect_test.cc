#include "bio/analysis/step_effect.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "bio/opensim/osim_file.h"

namespace bio {
namespace {

const std::string root = FISHERHILL_SOURCE_DIR;

/// What half the step changes in a shipped trial; nothing where the motion holds.
std::optional<StepEffect> effectOf(const std::string& name, const std::string& recording,
                                   Integrator integrator, double step) {
  const Model model = readOsim(root + "/models/" + name + ".osim");
  SystemOptions asked;
  asked.skeleton.freeCoordinates = {"elbow_flexion"};
  const MusculoskeletalSystem system(model, asked);
  const Trial trial = readTrial(root + "/emg_data/" + recording + ".sto", model, {});
  SimulationOptions options;
  options.integrator = integrator;
  options.step = step;
  const TrialReplay replay =
      replayTrial(system, trial, options, beginningOf(trial, model, system, {}));
  EXPECT_EQ(replay.motion.outcome, Outcome::completed) << replay.motion.why;
  return stepEffect(system, trial, replay);
}

// One step for the whole trial ends 46 degrees off, and goes where no arm goes in between.
TEST(StepEffect, IsLargeWhereOneStepIsTheWholeTrial) {
  const auto effect = effectOf("elbow8", "curl_slow", Integrator::variational, 4.5);
  ASSERT_TRUE(effect);
  EXPECT_EQ(effect->coordinate, "elbow_flexion");
  EXPECT_EQ(effect->halfStep, 2.25);
  EXPECT_GT(effect->difference, 0.7);
  EXPECT_THAT(describe(*effect),
              testing::AllOf(testing::StartsWith("with half the step (2.25 s) elbow_flexion "
                                                 "differs by up to "),
                             testing::HasSubstr(" deg, at "),
                             testing::EndsWith(": the step of 4.5 s is too long for this trial")));
}

TEST(StepEffect, IsNoneWhereTheMotionHolds) {
  EXPECT_FALSE(effectOf("elbow8", "curl_slow", Integrator::variational, 0.01));
  EXPECT_FALSE(effectOf("elbow8", "curl_fast", Integrator::variationalLeft, 0.01));
  EXPECT_FALSE(effectOf("elbow8", "curl_slow", Integrator::cvode, 0.01));
  EXPECT_FALSE(effectOf("elbow8", "curl_slow", Integrator::rungeKutta4, 3e-4));
}

// CVODE's rows are right however far apart, but do not show what happens in between.
TEST(StepEffect, IsLargeWhereRowsAreTooFarApart) {
  const auto effect = effectOf("elbow8", "curl_slow", Integrator::cvode, 4.5);
  ASSERT_TRUE(effect);
  EXPECT_GT(effect->difference, 0.3);
}

// 0.6 ms leaps over the limit of stability that 0.3 ms meets.
TEST(StepEffect, FindsAnUnstableStepThatReachesTheEnd) {
  const auto leaping =
      effectOf("elbow8_Millard2012", "cocontraction", Integrator::rungeKutta4, 6e-4);
  ASSERT_TRUE(leaping);
  EXPECT_THAT(describe(*leaping),
              testing::HasSubstr("with half the step (0.0003 s) the motion does not reach the end "
                                 "(unstable at t = "));
}

}  // namespace
}  // namespace bio
