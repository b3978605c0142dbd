#pragma once

#include <atomic>
#include <type_traits>
#include <vector>

namespace info {

/// A lock-free recording with one writer and any number of readers: appended samples never move or
/// change, and their number is published last.
template <class T>
class SampleLog {
  static_assert(std::is_trivially_destructible_v<T>, "a sample that owns memory would allocate");

 public:
  /// @param capacity largest number of samples; all memory is allocated at once
  explicit SampleLog(std::size_t capacity) : samples_(capacity) {}

  /// Writer's thread only. False, without an effect, if the log is full.
  bool append(const T& sample) {
    const std::size_t at = size_.load(std::memory_order_relaxed);
    if (at >= samples_.size()) return false;
    samples_[at] = sample;
    size_.store(at + 1, std::memory_order_release);
    return true;
  }

  /// Samples 0 … size() − 1 are complete and may be read from any thread.
  std::size_t size() const { return size_.load(std::memory_order_acquire); }
  std::size_t capacity() const { return samples_.size(); }
  const T& operator[](std::size_t k) const { return samples_[k]; }

 private:
  std::vector<T> samples_;
  alignas(64) std::atomic<std::size_t> size_{0};
};

}  // namespace info
