#pragma once

#include <optional>
#include <vector>

#include "bio/simulation/musculoskeletal_system.h"
#include "simulation/simd/lane_model.h"

namespace bio::lanes {

/// The lists behind a LaneModel.
template <class Of>
struct HingeModel {
  using T = typename Of::Number;
  std::vector<LaneMuscle<Of>> muscles;
  std::vector<Condition<Of>> conditions;
  std::vector<Variant<Of>> variants;
  std::vector<LaneSpan<Of>> spans;
  std::vector<Cylinder<Of>> cylinders;
  T mass, gravityCosine, gravitySine;
  bool hasForces = false;
  const CoordinateForces* forces[Of::width] = {};

  LaneModel<Of> view() {
    LaneModel<Of> system{static_cast<int>(muscles.size()),
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
    for (int l = 0; l < Of::width; ++l) system.forces[l] = forces[l];
    return system;
  }
};

/// a system with one segment that turns about one hinge, in the form of the lanes: every point and
/// what is seen of it from a cylinder is middle + along·cos q + across·sin q. Muscles' laws and
/// passive forces are those of `system`, which must outlive it; they are set in lane 0.
/// Nothing if the system has more coordinates, a slider, path points that move in their bodies,
/// conditions on a coupled coordinate, or paths over spheres.
std::optional<HingeModel<Single>> hingeModel(const MusculoskeletalSystem& system);

/// Whether two systems differ in numbers alone.
bool sameStructure(const HingeModel<Single>& a, const HingeModel<Single>& b);

/// Lists for systems of this structure, for four or eight lanes; every lane must be set before use.
template <class Of>
HingeModel<Of> lanesFor(const HingeModel<Single>& system);

/// A system of the same structure into a lane.
template <class Of>
void setLane(HingeModel<Of>& lanes, int lane, const HingeModel<Single>& system);

}  // namespace bio::lanes
