#include "output/progress_bar.h"

#include <gtest/gtest.h>

#include <limits>

namespace app {
namespace {

TEST(ProgressBar, ShowsTheShareDoneAndTheTimeLeft) {
  EXPECT_EQ(progressLine("replay", 0.5, 10),
            "replay [###############...............]  50 %  10 s left");
  EXPECT_EQ(progressLine("replay", 0.25, 30),
            "replay [#######.......................]  25 %  1 min 30 s left");
  EXPECT_EQ(progressLine("replay", 0.1, 1000),
            "replay [###...........................]  10 %  2 h 30 min left");
}

TEST(ProgressBar, GuessesNoTimeBeforeThereIsAnyProgress) {
  EXPECT_EQ(progressLine("x", 0, 10), "x [..............................]   0 %  ");
  EXPECT_EQ(progressLine("x", std::numeric_limits<double>::quiet_NaN(), 10),
            progressLine("x", 0, 10));
}

TEST(ProgressBar, NeverOverflows) {
  EXPECT_EQ(progressLine("x", 1.5, 10), "x [##############################] 100 %  0 s left");
}

}  // namespace
}  // namespace app
