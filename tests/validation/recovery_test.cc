#include "score/recovery.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "validation/labels_and_verdicts.h"

namespace hidden {
namespace {

TEST(Recovery, CountsRightNamesByHowVisibleTheEffectIs) {
  Json verdict = verdictOf("named", Json::array({effectOf("drag", "structure", 0.99, 0.34, 0.02)}));
  verdict["undetectable_below"] = {{"visc", 0.1}};
  const auto set = [&](double amplitude, const char* suite = "single") {
    Json truth = truthOf("visc", amplitude);
    truth["amplitude"] = -amplitude;
    return judge("a", labelOf(suite, Json::array({truth})), verdict);
  };
  std::vector<Outcome> outcomes = {set(0.12), set(0.149), set(0.16), set(0.3), set(0.3, "out")};
  outcomes[0].firstIsRight = outcomes[2].firstIsRight = true;
  EXPECT_NEAR(outcomes[0].visibility.value(), 1.2, 1e-12);
  const auto bins = hidden::recoveryByDetectability(outcomes);
  ASSERT_EQ(bins.size(), 6U);
  EXPECT_EQ(bins[2].from, 1);
  EXPECT_EQ(bins[2].n, 2);
  EXPECT_EQ(bins[2].right, 1);
  EXPECT_EQ(bins[3].n, 1);
  EXPECT_EQ(bins[4].n, 1);
  EXPECT_EQ(bins[0].n + bins[1].n + bins[5].n, 0);
  EXPECT_THAT(hidden::recoveryTable(outcomes),
              testing::HasSubstr("| 1 to 1.5 | 1 of 2 | 50.0 % |"));
}

TEST(Recovery, WhatIsNamedIsAsVisibleAsItsOwnDeviationSays) {
  // truth 0.3, estimate 0.34 ± 0.02, factor 0.6 and estimate 0.5 ± 0.1
  const auto visibility = [](const Json& effect, const Json& truth) {
    return judge("a", labelOf("single", Json::array({truth})),
                 verdictOf("named", Json::array({effect})))
        .visibility;
  };
  EXPECT_NEAR(
      visibility(effectOf("visc", "structure", 1, 0.34, 0.02), truthOf("visc", 0.3)).value(), 3,
      1e-12);
  Json gain = truthOf("gain_TRI", 0.6);
  gain["readings"][0]["name"] = "factor";
  EXPECT_NEAR(visibility(effectOf("gain_TRI", "input", 1, 0.5, 0.1, "factor"), gain).value(),
              0.4 / 0.1 / 5, 1e-12);
  // a value that was multiplied by 0.8: 0.14 m, 0.028 m of it the change
  Json centre = truthOf("com_1", 0.112);
  centre["readings"][0]["name"] = "com_1";
  centre["unit"] = "change";
  centre["amplitude"] = -0.2;
  EXPECT_NEAR(visibility(effectOf("com_1", "parameter", 1, 0.11, 0.002, "com_1"), centre).value(),
              0.028 / 0.002 / 5, 1e-12);
  Json silent = verdictOf("none", Json::array());
  silent["undetectable_below"] = {{"com_1", 0.037}};
  EXPECT_NEAR(judge("a", labelOf("parameter", Json::array({centre})), silent).visibility.value(),
              0.028 / 0.037, 1e-12);
  // an equivalent by its own amplitude
  EXPECT_NEAR(
      visibility(effectOf("clock", "sensor", 1, 0.04, 0.002), truthOf("delay", 0.03, {"clock"}))
          .value(),
      4, 1e-12);
}

TEST(Recovery, ErrorIsTheRootMeanSquareOfDeviations) {
  std::vector<Outcome> outcomes(3);
  EXPECT_FALSE(hidden::recoveryError(outcomes).has_value());
  outcomes[0].z = 3;
  outcomes[2].z = -4;
  EXPECT_NEAR(hidden::recoveryError(outcomes).value(), std::sqrt(12.5), 1e-12);
}

}  // namespace
}  // namespace hidden
