#pragma once

#include <cstdint>

namespace info {

/// Random numbers that are a function of (seed, stream, counter): the n-th number of a stream is
/// the same on every machine with IEEE arithmetic, independent of other streams and of the thread
/// that draws it.
///
/// The 64 bits of draw n are Stafford's mix 13 of k + n·0x9E3779B97F4A7C15 (the finaliser of
/// SplitMix64, Steele, Lea & Flood 2014), where the key k is mixed from seed and stream. Period 2⁶⁴
/// per stream; for simulation, not for cryptography.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::uint64_t stream);

  std::uint64_t bits();
  /// Uniform in [0, 1), 53 bits.
  double uniform();
  /// Standard normal, by Box and Muller's transform.
  double normal();

 private:
  std::uint64_t counter_;
  double spare_ = 0;
  bool hasSpare_ = false;
};

}  // namespace info
