#include "bio/model/nearest_name.h"

#include <gtest/gtest.h>

namespace bio {
namespace {

TEST(NearestName, CountsEdits) {
  EXPECT_EQ(editDistance("", "abc"), 3U);
  EXPECT_EQ(editDistance("abc", ""), 3U);
  EXPECT_EQ(editDistance("kitten", "sitting"), 3U);
  EXPECT_EQ(editDistance("BRA", "bra"), 0U);
}

TEST(NearestName, IsNearOrNothing) {
  const std::vector<std::string> names = {"replay", "render", "robot", "BRA", "BRD"};
  EXPECT_EQ(nearestName("repaly", names), "replay");
  EXPECT_EQ(nearestName("rendr", names), "render");
  EXPECT_EQ(nearestName("BRX", names), "BRA");  // the first of equals
  EXPECT_EQ(nearestName("calibrate", names), "");
  EXPECT_EQ(nearestName("", names), "");
  EXPECT_EQ(nearestName("replay", {}), "");
  EXPECT_EQ(meantInstead("rboot", names), ", did you mean 'robot'?");
  EXPECT_EQ(meantInstead("xyz", names), "");
}

}  // namespace
}  // namespace bio
