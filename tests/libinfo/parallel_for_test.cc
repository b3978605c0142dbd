#include "info/parallel_for.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace info {
namespace {

/// On how many threads a loop of bodies that take a while runs.
std::size_t threadsOf(int asked) {
  std::mutex mutex;
  std::set<std::thread::id> seen;
  parallelFor(64, asked, [&](int) {
    std::this_thread::sleep_for(std::chrono::milliseconds(3));
    const std::lock_guard lock(mutex);
    seen.insert(std::this_thread::get_id());
  });
  return seen.size();
}

TEST(ParallelFor, RunsEveryBodyOnce) {
  std::vector<std::atomic<int>> runs(1000);
  parallelFor(1000, 0, [&](int i) { ++runs[static_cast<std::size_t>(i)]; });
  for (const auto& count : runs) EXPECT_EQ(count, 1);
}

TEST(ParallelFor, RethrowsWhatABodyThrows) {
  EXPECT_THROW(parallelFor(10, 2,
                           [](int i) {
                             if (i == 7) throw std::domain_error("seven");
                           }),
               std::domain_error);
}

TEST(ParallelFor, UsesNoMoreThreadsThanItsLimitAllows) {
  const std::size_t free = threadsOf(0);
  EXPECT_EQ(threadsOf(1), 1u);
  {
    const ThreadLimit limit(1);
    EXPECT_EQ(threadsOf(0), 1u);
    EXPECT_EQ(threadsOf(2), 1u);
  }
  if (std::thread::hardware_concurrency() > 1) {
    EXPECT_GT(free, 1u);
    EXPECT_GT(threadsOf(0), 1u) << "the limit ended with its object";
  }
}

}  // namespace
}  // namespace info
