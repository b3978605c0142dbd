#include "bio/observation/nudge.h"

#include "bio/observation/smoothed_motion.h"
#include "simulation/integrators.h"

namespace bio {
namespace {

/// Mass matrix's entry of a coordinate at mid-range, the others at their defaults.
double inertiaOf(const MusculoskeletalSystem& system, int freeIndex) {
  return stepping::withCoordinates(system.skeleton(), [&](auto N) {
    Eigen::Matrix<double, decltype(N)::value, 1> at = system.skeleton().defaultValues();
    const Coordinate& coordinate =
        system.skeleton().coordinates()[static_cast<std::size_t>(freeIndex)];
    at[freeIndex] = (coordinate.rangeMin + coordinate.rangeMax) / 2;
    SystemConfiguration<decltype(N)::value> configuration(system);
    configuration.moveSkeletonTo(at);
    return double(configuration.massMatrix()(freeIndex, freeIndex));
  });
}

}  // namespace

Nudge nudgeTo(const MusculoskeletalSystem& system, int freeIndex, const std::vector<double>& times,
              const Eigen::VectorXd& values, double frequency) {
  const SmoothedMotion course = smoothed(times, values);
  const double inertia = inertiaOf(system, freeIndex);
  Nudge nudge{system.skeleton().coordinates()[static_cast<std::size_t>(freeIndex)].name,
              inertia * frequency * frequency,
              1.4 * inertia * frequency,
              {}};
  Eigen::MatrixXd pull =
      Eigen::MatrixXd::Zero(course.values.size(), system.skeleton().numCoordinates());
  pull.col(freeIndex) = nudge.stiffness * course.values + nudge.damping * course.speeds;
  nudge.pull = ExternalForce(course.times, pull);
  return nudge;
}

void apply(const Nudge& nudge, Model& model, ExternalForce& external) {
  model.springForces.push_back(
      {"nudge_" + nudge.coordinate, nudge.coordinate, nudge.stiffness, 0, nudge.damping, true});
  external = sum(external, nudge.pull);
}

}  // namespace bio
