#pragma once

#include <chrono>
#include <mutex>
#include <string>

namespace app {

/// A progress bar with the remaining time, on standard error if that is a terminal.
///
///     replay [##########..........]  50 %  12 s left
class ProgressBar {
 public:
  /// @param quiet never draw
  explicit ProgressBar(std::string label, bool quiet = false);
  /// Clears the bar's line.
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Draws the bar, at most ten times a second. Safe to call from several threads.
  /// @param fraction of the work done, 0 to 1
  /// @throws Interrupted after Ctrl-C, so that long work stops where it reports its progress
  void update(double fraction);

 private:
  using Clock = std::chrono::steady_clock;

  std::string label_;
  bool visible_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point drawn_ = start_;
  std::mutex mutex_;
};

/// One line of the bar, without line break.
std::string progressLine(const std::string& label, double fraction, double elapsedSeconds);

}  // namespace app
