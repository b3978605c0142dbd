#pragma once

#include <functional>
#include <memory>

namespace info {

/// While it lives, the process as a whole uses at most so many threads, whatever parallelFor() is
/// asked for.
class ThreadLimit {
 public:
  /// @param threads  ≥ 1; more than there are cores means all cores
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct Control;
  std::unique_ptr<Control> control_;
};

/// body(0) … body(n−1) on at most `threads` threads (0: all cores). An exception in a body ends the
/// loop and is rethrown.
void parallelFor(int n, int threads, const std::function<void(int)>& body);

}  // namespace info
