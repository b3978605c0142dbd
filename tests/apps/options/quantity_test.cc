#include "options/quantity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <stdexcept>

namespace app {
namespace {

TEST(Quantity, AnglesAreDegreesOnlyWhenTheySaySo) {
  EXPECT_DOUBLE_EQ(parseAngle("180deg"), std::numbers::pi);
  EXPECT_DOUBLE_EQ(parseAngle("-34.5deg"), -34.5 * std::numbers::pi / 180);
  EXPECT_DOUBLE_EQ(parseAngle("0.5"), 0.5);
  EXPECT_DOUBLE_EQ(parseAngle("+2.5e-1rad"), 0.25);
}

TEST(Quantity, NumbersAreReadWholeOrNotAtAll) {
  EXPECT_DOUBLE_EQ(parseNumber("1e-3"), 1e-3);
  for (const char* bad : {"", " 1", "1 ", "1,5", "0x10", "nan", "inf", "-inf", "1e999", "--1",
                          "+-1", "++1", "+", "1.2.3", "12abc"}) {
    EXPECT_THROW(parseNumber(bad), std::invalid_argument) << bad;
  }
}

TEST(Quantity, ABadAngleIsQuotedAndTheRuleIsTold) {
  for (const char* bad : {"", "deg", "rad", "34 deg", "34degrees", "34°", "nandeg", "infdeg"}) {
    try {
      parseAngle(bad);
      ADD_FAILURE() << bad;
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(),
                  testing::AllOf(testing::HasSubstr(bad), testing::HasSubstr("34deg")));
    }
  }
}

TEST(Quantity, AssignmentsSplitAtTheFirstEqualsSign) {
  const Assignment assignment = parseAssignment("elbow_flexion=90deg");
  EXPECT_EQ(assignment.name, "elbow_flexion");
  EXPECT_DOUBLE_EQ(assignment.value, std::numbers::pi / 2);
  for (const char* bad : {"", "elbow_flexion", "=1", "elbow_flexion=", "a==1", "a=1=2"}) {
    EXPECT_THROW(parseAssignment(bad), std::invalid_argument) << bad;
  }
}

}  // namespace
}  // namespace app
