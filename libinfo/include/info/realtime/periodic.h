#pragma once

#include <chrono>
#include <functional>
#include <stop_token>
#include <string>
#include <vector>

namespace info {

/// Timing statistics of a periodic task. A cycle is due at the start of its period, and its
/// deadline is the start of the next one.
struct DeadlineReport {
  std::size_t cycles = 0;
  std::size_t misses = 0;   ///< cycles that missed their deadline
  std::size_t skipped = 0;  ///< cycles skipped to catch up
  double median = 0;        ///< [s] from wake-up to completion
  double worst = 0;         ///< [s] likewise
  double worstLate = 0;     ///< [s] from due time to wake-up
};

/// Times of cycles, recorded without allocation.
class CycleTimes {
 public:
  explicit CycleTimes(std::size_t capacity) { busy_.reserve(capacity); }
  /// @param late from due time to wake-up, @param busy from wake-up to completion [s]
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
/// between, and records every cycle. After a cycle that ends late, the next one starts at the next
/// due time; those in between are skipped, so that a slow task does not accumulate delay.
/// @param stop ends the loop between two cycles, while sleeping within a tenth of a second
void runPeriodically(Clock::time_point start, Clock::time_point end, double period,
                     CycleTimes& times, const std::function<bool(std::size_t)>& body,
                     const std::stop_token& stop = {});

/// Requests real-time scheduling of the calling thread (SCHED_FIFO); false if not permitted.
bool askForRealTime(int priority);

}  // namespace info
