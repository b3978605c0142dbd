#include "info/probability/random_stream.h"

#include <cmath>
#include <numbers>

namespace info {
namespace {

constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15;

std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
  return z ^ (z >> 31);
}

}  // namespace

RandomStream::RandomStream(std::uint64_t seed, std::uint64_t stream)
    : counter_(mix(mix(seed + kGolden) + mix(stream * kGolden + 1))) {}

std::uint64_t RandomStream::bits() {
  return mix(counter_ += kGolden);
}

double RandomStream::uniform() {
  return static_cast<double>(bits() >> 11) * 0x1.0p-53;
}

double RandomStream::normal() {
  if (hasSpare_) {
    hasSpare_ = false;
    return spare_;
  }
  // 1 − uniform lies in (0, 1], where the logarithm is finite
  const double radius = std::sqrt(-2 * std::log(1 - uniform()));
  const double phase = 2 * std::numbers::pi * uniform();
  spare_ = radius * std::sin(phase);
  hasSpare_ = true;
  return radius * std::cos(phase);
}

}  // namespace info
