#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

namespace info {

/// A wait-free mailbox for the latest value: one thread publishes, one thread reads; neither waits,
/// locks or allocates, and a value is never read half-written.
///
/// Three slots: the writer fills its own and swaps it with the middle one, the reader swaps the
/// middle one with its own when it is new. Intermediate values between two reads are lost by
/// design; SampleLog keeps all of them.
template <class T>
class LatestValue {
  static_assert(std::is_trivially_destructible_v<T>, "a value that owns memory would allocate");

 public:
  /// Writer's thread only.
  void publish(const T& value) {
    slots_[writing_] = value;
    writing_ = index(
        middle_.exchange(static_cast<std::uint8_t>(writing_ | kFresh), std::memory_order_acq_rel));
  }

  /// Reader's thread only: copies the latest value if it was published since the last call;
  /// otherwise returns false and does not change `value`.
  bool take(T& value) {
    if (!(middle_.load(std::memory_order_relaxed) & kFresh)) return false;
    reading_ = index(middle_.exchange(reading_, std::memory_order_acq_rel));
    value = slots_[reading_];
    return true;
  }

 private:
  static constexpr std::uint8_t kFresh = 4;
  static std::uint8_t index(std::uint8_t slot) { return static_cast<std::uint8_t>(slot & 3); }

  std::array<T, 3> slots_{};
  alignas(64) std::atomic<std::uint8_t> middle_{1};
  alignas(64) std::uint8_t writing_ = 0;
  alignas(64) std::uint8_t reading_ = 2;
};

}  // namespace info
