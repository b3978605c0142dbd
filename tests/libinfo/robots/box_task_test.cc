#include "robots/box_task.h"

#include <gmock/gmock.h>

#include "robots/active_estimation.h"

namespace {

using namespace info;
using testing::HasSubstr;

TEST(BoxTask, SucceedsWithTheLengthsOfTheThesisAndNoOther) {
  std::vector<bool> success;
  for (double length : initialLengths()) {
    const SwingPlan plan = planSwing(length);
    EXPECT_TRUE(plan.search.converged) << describe(plan.search.why);
    EXPECT_LT(plan.crossingError, 1e-3);
    for (double u : plan.acceleration) EXPECT_LT(std::abs(u), 7);
    const SwingRun run = executeSwing(plan, 0.368);
    success.push_back(run.success);
    EXPECT_EQ(run.success, run.why == "in the box");
  }
  EXPECT_THAT(success,
              testing::ElementsAre(false, false, false, true, true, false, false, false, false));
}

TEST(BoxTask, PutsTheBallWhereItWasPlannedIfTheArmDoesNotLag) {
  const SwingPlan plan = planSwing(0.368);
  SystemOptions stiff{.naturalFrequency = 300, .maxAcceleration = 50, .start = 0};
  const SwingRun run = executeSwing(plan, 0.368, {}, stiff);
  EXPECT_TRUE(run.success);
  EXPECT_NEAR(run.crossingHeight, 0.01, 0.003);
  // at rest in the middle of the box when the plan ends
  const std::size_t end = 800;
  EXPECT_NEAR(run.time[end], 4.0, 1e-9);
  EXPECT_NEAR(run.gripper[end], -0.575, 0.02);
  EXPECT_NEAR(run.ballX[end], -0.575, 0.05);
}

TEST(BoxTask, JudgesByGeometry) {
  const Box box;  // −0.45 … −0.70, edge −0.30
  EXPECT_TRUE(judge({0, -0.4, -0.5, -0.55}, {-0.368, -0.25, -0.25, -0.35}, box).inside);
  const auto low = judge({0, -0.4, -0.5, -0.55}, {-0.368, -0.33, -0.33, -0.35}, box);
  EXPECT_FALSE(low.inside);
  EXPECT_THAT(low.why, HasSubstr("hits the near wall 3.0 cm below its edge"));
  EXPECT_NEAR(low.crossingHeight, -0.03, 1e-12);
  EXPECT_THAT(judge({0, -0.4, -0.6, -0.8}, {-0.3, -0.2, -0.2, -0.35}, box).why,
              HasSubstr("over the far wall"));
  EXPECT_THAT(judge({0, -0.4, -0.5, -0.3}, {-0.3, -0.2, -0.2, -0.35}, box).why,
              HasSubstr("leaves the box again"));
  EXPECT_THAT(judge({0, -0.4, 0}, {-0.3, -0.2, -0.3}, box).why, HasSubstr("never reaches"));
  // the height is that on the line between two points: −0.25 at the wall
  EXPECT_NEAR(judge({-0.4, -0.5}, {-0.2, -0.3}, box).crossingHeight, 0.05, 1e-12);
}

TEST(BoxTask, NamesTheRuleThatIsBroken) {
  const auto message = [](double length, Box box, SwingOptions options) {
    try {
      planSwing(length, box, options);
      return std::string();
    } catch (const std::domain_error& e) {
      return std::string(e.what());
    }
  };
  EXPECT_THAT(message(0.28, {}, {}), HasSubstr("string: 0.28 m, must be > 0.29"));
  EXPECT_THAT(message(NAN, {}, {}), HasSubstr("string: nan m"));
  EXPECT_THAT(message(0.368, {.opening = 0}, {}), HasSubstr("opening of the box: 0 m"));
  EXPECT_THAT(message(0.368, {.edge = 0.1}, {}), HasSubstr("edge of the box: 0.1 m"));
  EXPECT_THAT(message(0.368, {}, {.timeStep = 0}), HasSubstr("time step: 0 s"));
  EXPECT_THAT(message(0.368, {}, {.crossing = 5}), HasSubstr("duration: 4 s, must be > crossing"));
  EXPECT_THAT(message(0.368, {}, {.clearance = -1}), HasSubstr("clearance: -1 m"));
  EXPECT_THAT(message(0.368, {}, {.inputWeight = 0}), HasSubstr("input weight: 0"));
}

}  // namespace
