#include "simulation/simd/lane_step.h"

namespace bio::lanes {

LaneSolver* plainSolver(const LaneModel<Lanes>& system) {
  return new StepSolver(system);
}

}  // namespace bio::lanes
