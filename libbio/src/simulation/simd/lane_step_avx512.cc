#include "simulation/simd/lane_step.h"

namespace bio::lanes {

LaneSolver<Here>* avx512Solver(const LaneModel<Here>& system) {
  return new StepSolver(system);
}

}  // namespace bio::lanes
