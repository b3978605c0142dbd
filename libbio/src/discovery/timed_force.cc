#include "bio/discovery/timed_force.h"

#include <algorithm>

#include "bio/discovery/encompassing_model.h"
#include "bio/observation/smoothed_motion.h"

namespace bio::discover {

using Eigen::Index;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double ramp = 0.15;  // [s]

}  // namespace

TimedShare timedShare(double t, double change, bool ends) {
  const double x = std::clamp((t - change) / ramp + 0.5, 0.0, 1.0);
  const double value = x * x * (3 - 2 * x), slope = 6 * x * (1 - x) / ramp;
  return ends ? TimedShare{1 - value, slope} : TimedShare{value, -slope};
}

VectorXd weightOfHeldMass(const EncompassingModel& model, const std::vector<double>& times,
                          const VectorXd& measured, const std::vector<double>& nodes) {
  VectorXd weight = VectorXd::Zero(static_cast<Index>(nodes.size()));
  if (model.movedBodies().empty() || times.size() < 4) return weight;
  const std::string& hand = model.movedBodies().back();
  const Vector3d& gravity = model.base().gravity;
  const SmoothedMotion course = smoothed(times, measured);
  const double spacing = course.times[1] - course.times[0];
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const auto j =
        std::clamp<Index>(static_cast<Index>((nodes[k] - course.times.front()) / spacing + 0.5), 1,
                          course.values.size() - 2);
    const double q = course.values[j], speed = course.speeds[j];
    const double acceleration = (course.speeds[j + 1] - course.speeds[j - 1]) / (2 * spacing);
    constexpr double aside = 1e-3;
    const Vector3d v = model.velocityOf(hand, q);
    const Vector3d bend =
        (model.velocityOf(hand, q + aside) - model.velocityOf(hand, q - aside)) / (2 * aside);
    weight[static_cast<Index>(k)] =
        gravity.dot(v) - v.squaredNorm() * acceleration - v.dot(bend) * speed * speed;
  }
  return weight;
}

}  // namespace bio::discover
