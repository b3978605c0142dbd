#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace hidden {

/// The same numbers on every machine: std::mt19937_64 (its bits are standardised) and the transform
/// of Box and Muller.
class RandomNumbers {
 public:
  RandomNumbers(std::uint64_t seed, std::uint64_t stream) : bits_(mixed(seed, stream)) {}

  /// Uniform between two numbers.
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(bits_() >> 11) * 0x1.0p-53;
  }
  /// Standard normal.
  double normal() {
    const double radius = std::sqrt(-2 * std::log(1 - between(0, 1)));
    return radius * std::cos(2 * std::numbers::pi * between(0, 1));
  }
  /// Standard normal, drawn again until within ±bound.
  double normalWithin(double bound) {
    double x = normal();
    while (std::abs(x) > bound) x = normal();
    return x;
  }

 private:
  static std::uint64_t mixed(std::uint64_t seed, std::uint64_t stream) {
    return (seed + 1) * 0x9E3779B97F4A7C15u ^ (stream + 1) * 0xD1B54A32D192ED03u;
  }
  std::mt19937_64 bits_;
};

}  // namespace hidden
