#include "simulation/simd/lane_step.h"

namespace bio::lanes {

LaneSolver<Here>* plainSolver(const LaneModel<Here>& system) {
  return new StepSolver(system);
}

}  // namespace bio::lanes
