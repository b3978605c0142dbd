#include "info/discovery/likelihood/truncated.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace info::discover {

double logNormalBelow(double x) {
  if (x > -20) return std::log(0.5 * std::erfc(-x / std::numbers::sqrt2));
  // Mills's ratio by its asymptotic series
  const double y = 1 / (x * x);
  return -0.5 * x * x - std::log(-x) - 0.5 * std::log(2 * std::numbers::pi) +
         std::log1p(-y + 3 * y * y - 15 * y * y * y);
}

double logNormalWithin(double lowest, double highest) {
  if (lowest > highest) return -std::numeric_limits<double>::infinity();
  // in the smaller tail differences do not lose digits
  if (lowest > 0) return logNormalWithin(-highest, -lowest);
  const double upper = logNormalBelow(highest), lower = logNormalBelow(lowest);
  return upper + std::log1p(-std::exp(lower - upper));
}

double logMassAtBound(double g, double h, double w) {
  // complete the square: a normal distribution about −g/h, truncated at 0 and w
  const double root = std::sqrt(h), shift = g / root;
  return 0.5 * shift * shift - std::log(root) + logNormalWithin(shift, shift + w * root);
}

}  // namespace info::discover
