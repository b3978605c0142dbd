#include "report/axis_ticks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace app {
namespace {

/// A typographic minus, and no minus before zero.
std::string signedText(const std::string& digits) {
  if (!digits.starts_with('-')) return digits;
  const bool isZero = digits.find_first_not_of("-0.") == digits.npos;
  return (isZero ? "" : "−") + digits.substr(1);
}

std::string powerText(int power) {
  return fmt::format("10^{}", signedText(std::to_string(power)));
}

std::string tickLabel(double value, double step, double largest) {
  if (value == 0) return "0";
  if (largest >= 1e5 || largest < 1e-3) {
    const int power = static_cast<int>(std::floor(std::log10(std::abs(value)) + 1e-9));
    const double digits = value / std::pow(10.0, power);
    const int decimals =
        std::clamp(power - static_cast<int>(std::floor(std::log10(step) + 1e-9)), 0, 6);
    const std::string mantissa = signedText(fmt::format("{:.{}f}", digits, decimals));
    return mantissa == "1" ? powerText(power) : fmt::format("{}·{}", mantissa, powerText(power));
  }
  const int decimals = std::clamp(-static_cast<int>(std::floor(std::log10(step) + 1e-9)), 0, 12);
  return signedText(fmt::format("{:.{}f}", value, decimals));
}

std::vector<AxisTick> linearTicks(const AxisRange& range, int most) {
  const double rough = (range.high - range.low) / most;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double digit : {5.0, 2.0, 1.0}) {
    if (digit * power >= rough * (1 - 1e-9)) step = digit * power;
  }
  const double largest = std::max(std::abs(range.low), std::abs(range.high));
  std::vector<AxisTick> ticks;
  const double slack = 1e-6;
  for (double k = std::ceil(range.low / step - slack); k <= range.high / step + slack; ++k) {
    ticks.push_back({k * step, tickLabel(k * step, step, largest)});
  }
  return ticks;
}

std::vector<AxisTick> logarithmicTicks(const AxisRange& range, int most) {
  const double decades = std::log10(range.high / range.low);
  if (decades < 0.7) return linearTicks(range, most);
  const int first = static_cast<int>(std::floor(std::log10(range.low)));
  const int last = static_cast<int>(std::ceil(std::log10(range.high)));
  const int every = std::max(1, static_cast<int>(std::ceil(decades / most)));
  std::vector<AxisTick> ticks;
  for (int power = first; power <= last; ++power) {
    for (int digit = 1; digit <= (decades < 3.5 ? 9 : 1); ++digit) {
      const double value = digit * std::pow(10.0, power);
      if (value < range.low * (1 - 1e-9) || value > range.high * (1 + 1e-9)) continue;
      std::string label;
      if (digit == 1 && power % every == 0) label = powerText(power);
      if (decades < 1.5 && (digit == 2 || digit == 5)) {
        label = power == 0 ? std::to_string(digit) : fmt::format("{}·{}", digit, powerText(power));
      }
      if (digit == 1 && power == 0) label = "1";
      ticks.push_back({value, label});
    }
  }
  return ticks;
}

}  // namespace

AxisRange rangeOf(const std::vector<double>& values, AxisScale scale, double margin) {
  const bool isLogarithmic = scale == AxisScale::logarithmic;
  constexpr double most = 1e300;  // so that a span is a number
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const double value : values) {
    if (!std::isfinite(value) || (isLogarithmic && value <= 0)) continue;
    const double shown = std::clamp(value, isLogarithmic ? 1 / most : -most, most);
    low = std::min(low, shown);
    high = std::max(high, shown);
  }
  if (low > high) return isLogarithmic ? AxisRange{0.1, 10} : AxisRange{0, 1};
  if (isLogarithmic) {
    const double factor = std::pow(high / low, margin);
    return high > low * (1 + 1e-9) ? AxisRange{low / factor, high * factor}
                                   : AxisRange{low / 3, high * 3};
  }
  const double size = std::max(std::abs(low), std::abs(high));
  if (size < 1e-300) return {-1, 1};
  // a constant is drawn as a level line, not as its rounding errors
  if (high - low < 1e-9 * size) return {low - 0.1 * size, high + 0.1 * size};
  const double space = margin * (high - low);
  return {low - space, high + space};
}

std::vector<AxisTick> ticksOf(const AxisRange& range, AxisScale scale, int most) {
  return scale == AxisScale::logarithmic ? logarithmicTicks(range, most) : linearTicks(range, most);
}

}  // namespace app
