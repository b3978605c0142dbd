#include "discover/excess_error_text.h"

#include <gtest/gtest.h>

namespace app {
namespace {

/// In degrees.
info::discover::ExcessError excess(double calibrated, double after, double floor) {
  info::discover::ExcessError result;
  result.nominal = result.calibrated = calibrated;
  result.after = after;
  result.floor = floor;
  info::discover::explainExcess(result);
  return result;
}

std::string words(const info::discover::ExcessError& one, bool heldOut) {
  return excessErrorWords(one, 1, "°", heldOut);
}

TEST(GapWords, SayWhatBecameOfTheExcessErrorInPlainWords) {
  EXPECT_EQ(words(excess(9.9, 0.487, 0.5), false), "The residual is at the noise floor (0.49°).");
  EXPECT_EQ(words(excess(9.9, 0.54, 0.5), true),
            "The residual on the held-out trial is at the noise floor (0.54°).");
  EXPECT_EQ(words(excess(3, 1.2, 0.5), false), "86 % of the excess error is explained.");
  EXPECT_EQ(words(excess(3, 1.2, 0.5), true),
            "86 % of the excess error is explained on the held-out trial.");
  EXPECT_EQ(words(excess(3, 3.2, 0.5), false),
            "None of the excess error is explained (3.2°, noise 0.5°).");
}

// Never more than all of it, never less than nothing.
TEST(GapWords, HaveNoPercentageBeyondWhatThereIs) {
  EXPECT_EQ(words(excess(90, 0.6, 0.5), false), "99 % of the excess error is explained.");
  EXPECT_EQ(words(excess(3, 2.999, 0.5), false), "1 % of the excess error is explained.");
  EXPECT_EQ(excessErrorCell(excess(9.9, 0.487, 0.5)), "at the noise floor");
  EXPECT_EQ(excessErrorCell(excess(3, 1.2, 0.5)), "86 %");
  EXPECT_EQ(excessErrorCell(excess(3, 3.9, 0.5)), "none");
}

TEST(GapWords, CompareHeldOutTrialsWithWhatWasToBeExpected) {
  info::discover::ExcessError one = excess(3, 3.2, 0.5);
  one.expected = 0.6;
  EXPECT_EQ(words(one, true),
            "The fit does not carry over to the held-out trial (3.2°, expected 0.6°).");
  one = excess(3, 0.95, 0.5);
  one.expected = 0.9;
  EXPECT_EQ(
      words(one, true),
      "The residual on the held-out trial is about as large as expected (0.95°, expected 0.9°).");
  one.expected = 1.4;
  EXPECT_EQ(
      words(one, true),
      "The residual on the held-out trial is no larger than expected (0.95°, expected 1.4°).");
  EXPECT_EQ(excessErrorCell(one), "as expected");
  // little is explained where much uncertainty was to be expected
  one = excess(3.7, 3.3, 0.5);
  one.expected = 4.7;
  EXPECT_EQ(words(one, true), "21 % of the excess error is explained on the held-out trial.");
  // nearer than the calibrated model, but further off than the model as it came
  one = excess(10.4, 9.1, 0.5);
  one.nominal = 7;
  one.expected = 0.6;
  EXPECT_EQ(words(one, true),
            "The fit does not carry over to the held-out trial (9.1°, expected 0.6°).");
}

TEST(GapWords, HaveTheUnitThatIsShown) {
  EXPECT_EQ(excessErrorWords(excess(0.3, 0.32, 0.05), 10, symbolOf("N"), false),
            "None of the excess error is explained (3.2 N, noise 0.5 N).");
  EXPECT_EQ(symbolOf("deg"), "°");
  EXPECT_EQ(symbolOf(""), "");
  EXPECT_EQ(excessErrorWords(excess(9.9, 0.98, 1), 1, symbolOf("sd"), false),
            "The residual is at the noise floor (0.98 sd of the noise).");
}

}  // namespace
}  // namespace app
