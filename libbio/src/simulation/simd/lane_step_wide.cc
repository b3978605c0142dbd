#include "simulation/simd/lane_step.h"

namespace bio::lanes {

LaneSolver* wideSolver(const LaneModel<Lanes>& system) {
  return new StepSolver(system);
}

}  // namespace bio::lanes
