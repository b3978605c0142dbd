#include "info/dynamics/online_least_squares.h"

#include <fmt/format.h>

#include <stdexcept>

namespace info {

void checkOnlineOptions(const OnlineOptions& options, Eigen::Index states) {
  if (options.maxIterations < 1)
    throw std::domain_error(
        fmt::format("on-line estimate, iterations: {}, must be ≥ 1", options.maxIterations));
  if (!(options.decrementTolerance > 0 && std::isfinite(options.decrementTolerance)))
    throw std::domain_error(fmt::format("on-line estimate, decrement tolerance: {}, must be > 0",
                                        options.decrementTolerance));
  if (options.window == 0) return;
  if (options.window < 2)
    throw std::domain_error(
        fmt::format("on-line estimate, window: {} samples, must be 0 or ≥ 2", options.window));
  requireLength("standard deviations of a window's start", options.startSd.size(), states);
  for (double sd : options.startSd)
    if (!(sd >= 0 && std::isfinite(sd)))
      throw std::domain_error(fmt::format(
          "on-line estimate, standard deviation of a window's start: {}, must be ≥ 0 and finite",
          sd));
}

}  // namespace info
