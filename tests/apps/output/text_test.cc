#include "output/text.h"

#include <gtest/gtest.h>

namespace app {
namespace {

TEST(IdentifiableWords, CountParametersAsAPersonWould) {
  EXPECT_EQ(identifiableWords(1, 1), "The parameter is identifiable");
  EXPECT_EQ(identifiableWords(0, 1), "The parameter is not identifiable");
  EXPECT_EQ(identifiableWords(2, 2), "Both parameters are identifiable");
  EXPECT_EQ(identifiableWords(3, 3), "All 3 parameters are identifiable");
  EXPECT_EQ(identifiableWords(0, 3), "None of the 3 parameters is identifiable");
  EXPECT_EQ(identifiableWords(1, 3), "1 of 3 parameters is identifiable");
  EXPECT_EQ(identifiableWords(2, 3), "2 of 3 parameters are identifiable");
}

}  // namespace
}  // namespace app
