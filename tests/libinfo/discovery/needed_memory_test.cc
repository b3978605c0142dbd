#include "info/discovery/search/needed_memory.h"

#include <gmock/gmock.h>

#include "libinfo/discovery/drawn_problem.h"

namespace {

using namespace drawn_problem;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(NeededMemory, IsFourMatricesOfSamplesAndNodesOfTheTrialsThatAreFitted) {
  const LinearDisagreement data = drawn(3, 40, 0);
  double numbers = 0;
  for (const int t : {0, 2}) {
    numbers += static_cast<double>(data.times(t).size() * data.nodes(t).size());
  }
  EXPECT_EQ(neededMemory(data, {0, 2}), 32 * numbers);
}

TEST(NeededMemory, MoreThanThereIsIsRefusedInOneLine) {
  const LinearDisagreement data = drawn(2, 40, 0);
  const double needed = neededMemory(data, {0, 1});
  EXPECT_NO_THROW(requireMemory(data, {0, 1}, needed));
  EXPECT_THAT(
      [&] {
        requireMemory(data, {0, 1}, needed - 1);
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("cut it into several shorter trials")));
}

TEST(NeededMemory, IsKnownOfThisSystem) {
  EXPECT_GT(availableMemory(), 1e6);
  EXPECT_LT(availableMemory(), 1e15);  // /proc/meminfo was read
}

}  // namespace
