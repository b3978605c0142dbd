#include "simulation/simd/lane_step.h"

namespace bio::lanes {

LaneSolver* wideSolver(const LaneModel<Lanes>& arm) {
  return new StepSolver(arm);
}

}  // namespace bio::lanes
