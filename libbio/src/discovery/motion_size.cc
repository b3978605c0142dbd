#include "bio/discovery/motion_size.h"

#include <Eigen/Dense>
#include <cmath>

namespace bio::discover {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr double smallestStep = 0.25;  ///< of the spread: beyond noise, and still a small part

/// Root mean square of the speed; 0 if the coordinate does not move.
double speedOf(const VectorXd& times, const VectorXd& values, double spread) {
  const Index n = values.size();
  for (Index lag = 1; 2 * lag < n; lag *= 2) {
    const VectorXd steps = values.tail(n - lag) - values.head(n - lag);
    if (std::sqrt(steps.squaredNorm() / double(n - lag)) < smallestStep * spread) continue;
    const VectorXd durations = times.tail(n - lag) - times.head(n - lag);
    return std::sqrt((steps.array() / durations.array()).square().mean());
  }
  return 0;
}

}  // namespace

std::map<std::string, MotionSize> motionSizes(const std::vector<Trial>& trials,
                                              const std::vector<std::string>& coordinates) {
  std::map<std::string, MotionSize> sizes;
  for (const std::string& name : coordinates) {
    double speeds = 0, spreads = 0, count = 0;
    for (const Trial& trial : trials) {
      const MeasuredChannel* channel = trial.measurementOf(ofCoordinate(name));
      if (!channel || channel->values.size() < 3) continue;
      const double variance = (channel->values.array() - channel->values.mean()).square().mean();
      speeds += std::pow(speedOf(channel->times, channel->values, std::sqrt(variance)), 2);
      spreads += variance;
      ++count;
    }
    if (speeds > 0 && spreads > 0)
      sizes[name] = {std::sqrt(speeds / count), std::sqrt(spreads / count)};
  }
  return sizes;
}

}  // namespace bio::discover
