#include "robots/string_length.h"

#include <gmock/gmock.h>

#include <cmath>

#include "support/throws_saying.h"

namespace {

using namespace info;
using support::throwsSaying;

TEST(StringLength, IsLearntInATrialAndTheSwingSucceedsWithIt) {
  const robot::StringLengthResult found =
      robot::estimateStringLength({.duration = 3, .initialLengths = {0.45, 0.31}, .seed = 2});
  ASSERT_EQ(found.trials.size(), 2u);
  EXPECT_EQ(found.firstDecision, ActionEnd::acts);
  EXPECT_EQ(found.successesWithout, 0u);
  EXPECT_EQ(found.successesWith, 2u);
  const double first = found.trials[0].learnt.length(), second = found.trials[1].learnt.length();
  EXPECT_DOUBLE_EQ(found.mean, (first + second) / 2);
  EXPECT_NEAR(found.sd, std::abs(first - second) / std::sqrt(2), 1e-15);
  EXPECT_LT(found.largestError, 0.02);
  EXPECT_EQ(found.largestError, std::max(std::abs(first - 0.368), std::abs(second - 0.368)));
}

TEST(StringLength, NothingMovesWithoutATrackingWeight) {
  const robot::StringLengthResult found = robot::estimateStringLength({.trackingWeight = 0});
  EXPECT_TRUE(found.trials.empty());
  EXPECT_NE(found.firstDecision, ActionEnd::acts);
}

TEST(StringLength, SaysWhichRuleARequestBreaks) {
  const auto refused = [](const robot::StringLengthRequest& request, const char* words) {
    throwsSaying([&] { robot::estimateStringLength(request); }, words);
  };
  refused({.duration = 0}, "duration: 0 s, must be > 0");
  refused({.initialLengths = {2}}, "initial length: 2 m");
  refused({.payload = -1}, "payload: -1 kg");
  refused({.trueLength = std::nan("")}, "true length: nan m");
  refused({.noise = 0}, "noise: 0 N");
  refused({.disturbance = -1}, "disturbance: -1 m/s²");
  refused({.trackingWeight = -1}, "tracking weight: -1");
  refused({.window = 0.01}, "window: 0.01 s");
}

}  // namespace
