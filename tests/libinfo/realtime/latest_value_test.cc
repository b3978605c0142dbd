#include "info/realtime/latest_value.h"

#include <gtest/gtest.h>

#include <array>
#include <numeric>
#include <thread>

#include "info/realtime/sample_log.h"

namespace {

using namespace info;

TEST(LatestValue, GivesTheLatestOnce) {
  LatestValue<int> box;
  int value = -1;
  EXPECT_FALSE(box.take(value));
  EXPECT_EQ(value, -1);
  box.publish(1);
  box.publish(2);
  EXPECT_TRUE(box.take(value));
  EXPECT_EQ(value, 2);
  EXPECT_FALSE(box.take(value));
  for (int k = 3; k < 20; ++k) {
    box.publish(k);
    if (k % 3 == 0) {
      EXPECT_TRUE(box.take(value));
      EXPECT_EQ(value, k);
    }
  }
}

// One writer, one reader, as fast as they can: values never torn, never older than one seen before,
// and the last one arrives.
TEST(LatestValue, NeverTearsAValueBetweenThreads) {
  struct Wide {
    std::array<long, 32> numbers;
  };
  LatestValue<Wide> box;
  constexpr long last = 1'000'000;
  std::jthread writer([&] {
    Wide wide;
    for (long k = 1; k <= last; ++k) {
      wide.numbers.fill(k);
      box.publish(wide);
    }
  });
  long seen = 0, reads = 0;
  bool torn = false, older = false;
  Wide wide{};
  while (seen != last) {
    if (!box.take(wide)) continue;
    ++reads;
    for (long number : wide.numbers) torn |= number != wide.numbers[0];
    older |= wide.numbers[0] <= seen;
    seen = wide.numbers[0];
  }
  EXPECT_FALSE(torn);
  EXPECT_FALSE(older);
  EXPECT_GT(reads, 1);
}

TEST(SampleLog, KeepsEverySampleInOrderForEveryReader) {
  struct Sample {
    long number, square;
  };
  constexpr std::size_t count = 200'000;
  SampleLog<Sample> log(count);
  std::array<long, 2> wrong{};
  const auto read = [&](long& errors) {
    std::size_t next = 0;
    while (next < count)
      for (const std::size_t end = log.size(); next < end; ++next) {
        const auto k = static_cast<long>(next);
        errors += log[next].number != k || log[next].square != k * k;
      }
  };
  {
    std::jthread first([&] { read(wrong[0]); }), second([&] { read(wrong[1]); });
    for (long k = 0; k < static_cast<long>(count); ++k) EXPECT_TRUE(log.append({k, k * k}));
  }
  EXPECT_EQ(wrong[0], 0);
  EXPECT_EQ(wrong[1], 0);
  EXPECT_FALSE(log.append({0, 0}));
  EXPECT_EQ(log.size(), count);
}

}  // namespace
