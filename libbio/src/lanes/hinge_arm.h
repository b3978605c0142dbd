#pragma once

#include <optional>
#include <vector>

#include "bio/arm.h"
#include "lanes/lane_model.h"

namespace bio::lanes {

/// The lists behind a LaneArm.
template <class T>
struct HingeArm {
  std::vector<LaneMuscle<T>> muscles;
  std::vector<Condition<T>> conditions;
  std::vector<Variant<T>> variants;
  std::vector<LaneSpan<T>> spans;
  std::vector<Cylinder<T>> cylinders;
  T mass, gravityCosine, gravitySine;
  bool hasForces = false;
  const CoordinateForces* forces[width] = {};

  LaneArm<T> view() {
    LaneArm<T> arm{static_cast<int>(muscles.size()),
                   mass,
                   gravityCosine,
                   gravitySine,
                   hasForces,
                   {},
                   muscles.data(),
                   conditions.data(),
                   variants.data(),
                   spans.data(),
                   cylinders.data()};
    for (int l = 0; l < width; ++l) arm.forces[l] = forces[l];
    return arm;
  }
};

/// An arm with one segment that turns about one hinge, in the form of the lanes: every point and
/// what is seen of it from a cylinder is middle + along·cos q + across·sin q. Curves and passive
/// forces are those of `arm`, which must outlive it; they are set in lane 0.
/// Nothing if the arm has more coordinates, a slider, path points that move in their bodies,
/// conditions on a coupled coordinate, or paths over spheres.
std::optional<HingeArm<double>> hingeArm(const Arm& arm);

/// Whether two arms differ in numbers alone.
bool sameStructure(const HingeArm<double>& a, const HingeArm<double>& b);

/// Lists for arms of this structure; every lane must be set before use.
HingeArm<Real> lanesFor(const HingeArm<double>& arm);

/// An arm of the same structure into a lane.
void setLane(HingeArm<Real>& lanes, int lane, const HingeArm<double>& arm);

}  // namespace bio::lanes
