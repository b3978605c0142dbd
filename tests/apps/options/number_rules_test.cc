#include "options/number_rules.h"

#include <gtest/gtest.h>

namespace app {
namespace {

TEST(NumberRules, SayWhatANumberMustBe) {
  EXPECT_EQ(positive()("0.5"), "");
  EXPECT_EQ(positive()("0"), "0 must be > 0");
  EXPECT_EQ(notNegative()("0"), "");
  EXPECT_EQ(notNegative()("-1"), "-1 must be ≥ 0");
  EXPECT_EQ(between(0.05, 1.5)("1.5"), "");
  EXPECT_EQ(between(0.05, 1.5)("2"), "2 must be 0.05 to 1.5");
  EXPECT_EQ(finite()("-3e5"), "");
}

TEST(NumberRules, AreAllBrokenByWhatIsNoFiniteNumber) {
  for (const CLI::Validator& rule : {finite(), positive(), notNegative(), between(-1, 1)}) {
    for (const char* text : {"nan", "inf", "-inf", "", "1,5", "5 deg"}) {
      EXPECT_EQ(rule(text), "'" + std::string(text) + "' is not a finite number");
    }
  }
}

}  // namespace
}  // namespace app
