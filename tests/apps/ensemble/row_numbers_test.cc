#include <gmock/gmock.h>

#include "ensemble/worker_pool.h"

namespace app {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(RowNumbers, ArePartsOfWhatWasAdded) {
  RowNumbers numbers;
  for (const std::uint64_t number : {0, 1, 2, 5, 7, 8, 9, 20}) numbers.add(number);
  EXPECT_EQ(numbers.size(), 8u);
  EXPECT_THAT(numbers.part(0, 8), ElementsAre(0, 1, 2, 5, 7, 8, 9, 20));
  EXPECT_THAT(numbers.part(2, 3), ElementsAre(2, 5, 7));
  EXPECT_THAT(numbers.part(5, 2), ElementsAre(8, 9));
  EXPECT_THAT(numbers.part(6, 64), ElementsAre(9, 20));
  EXPECT_THAT(numbers.part(8, 64), IsEmpty());
  EXPECT_THAT(RowNumbers().part(0, 64), IsEmpty());
}

}  // namespace
}  // namespace app
