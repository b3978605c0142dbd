#include "info/realtime/periodic.h"

#include <gtest/gtest.h>

#include <thread>

namespace {

using namespace info;
using std::chrono::milliseconds;

TEST(CycleTimes, TellsMedianWorstAndMisses) {
  CycleTimes times(10);
  for (double busy : {1.0, 5.0, 2.0, 4.0, 3.0}) times.add(0.25, busy, 4.5);
  times.add(2, 3, 4.5);
  times.skip(2);
  const DeadlineReport report = times.report();
  EXPECT_EQ(report.cycles, 6u);
  EXPECT_EQ(report.misses, 2u);  // 0.25 + 5 and 2 + 3
  EXPECT_EQ(report.skipped, 2u);
  EXPECT_EQ(report.median, 3);
  EXPECT_EQ(report.worst, 5);
  EXPECT_EQ(report.worstLate, 2);
}

TEST(RunPeriodically, RunsEveryCycleOnceAndCatchesUpBySkipping) {
  const auto start = Clock::now();
  std::vector<std::size_t> cycles;
  CycleTimes times(100);
  runPeriodically(start, start + milliseconds(500), 0.05, times, [&](std::size_t cycle) {
    cycles.push_back(cycle);
    if (cycle == 3) std::this_thread::sleep_for(milliseconds(120));
    return true;
  });
  const DeadlineReport report = times.report();
  EXPECT_EQ(report.cycles, cycles.size());
  EXPECT_EQ(report.cycles + report.skipped, 10u);
  EXPECT_GE(report.skipped, 2u);
  EXPECT_GE(report.misses, 1u);
  EXPECT_GE(report.worst, 0.12);
  for (std::size_t i = 1; i < cycles.size(); ++i) EXPECT_GT(cycles[i], cycles[i - 1]);
  EXPECT_GE(Clock::now(), start + milliseconds(450));
}

TEST(RunPeriodically, EndsWhenTheBodySaysSo) {
  const auto start = Clock::now();
  CycleTimes times(10);
  int runs = 0;
  runPeriodically(start, start + std::chrono::hours(1), 0.001, times,
                  [&](std::size_t) { return ++runs < 3; });
  EXPECT_EQ(runs, 3);
}

TEST(RunPeriodically, WakesWhenItIsStopped) {
  const auto start = Clock::now();
  CycleTimes times(10);
  int runs = 0;
  {
    const std::jthread task([&](const std::stop_token& stop) {
      const auto count = [&](std::size_t) { return ++runs > 0; };
      runPeriodically(start, start + std::chrono::seconds(40), 20, times, count, stop);
    });
    std::this_thread::sleep_for(milliseconds(1000));
  }
  EXPECT_EQ(runs, 1);
  EXPECT_LT(Clock::now() - start, std::chrono::seconds(5));  // 1.1 s where nothing else runs
}

}  // namespace
