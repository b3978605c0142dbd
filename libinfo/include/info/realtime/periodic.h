#pragma once

#include <chrono>
#include <functional>
#include <stop_token>
#include <string>
#include <vector>

namespace info {

/// How a task with deadlines fared. A cycle is due at the start of its period and has until the
/// next one.
struct DeadlineReport {
  std::size_t cycles = 0;
  std::size_t misses = 0;   ///< cycles that ended after the next was due
  std::size_t skipped = 0;  ///< cycles left out to catch up
  double median = 0;        ///< [s] from waking to done
  double worst = 0;         ///< [s] likewise
  double worstLate = 0;     ///< [s] from due to waking
};

/// Times of cycles, recorded without allocation.
class CycleTimes {
 public:
  explicit CycleTimes(std::size_t capacity) { busy_.reserve(capacity); }
  /// @param late from due to waking, @param busy from waking to done [s]
  void add(double late, double busy, double period);
  void skip(std::size_t cycles) { skipped_ += cycles; }
  DeadlineReport report() const;
  const std::vector<double>& busy() const { return busy_; }

 private:
  std::vector<double> busy_;
  std::size_t misses_ = 0, skipped_ = 0, cycles_ = 0;
  double worstLate_ = 0;
};

using Clock = std::chrono::steady_clock;

/// Runs body(cycle) at start, start + period, … until `end` or until it returns false, sleeping in
/// between, and records every cycle. A cycle that ends late makes the next one start at the next
/// time that is due; those in between are skipped, so that a slow task never falls behind for good.
/// @param stop ends it between two cycles, within a tenth of a second also where it sleeps
void runPeriodically(Clock::time_point start, Clock::time_point end, double period,
                     CycleTimes& times, const std::function<bool(std::size_t)>& body,
                     const std::stop_token& stop = {});

/// Asks for real-time scheduling of the calling thread (SCHED_FIFO); false if not allowed.
bool askForRealTime(int priority);

}  // namespace info
