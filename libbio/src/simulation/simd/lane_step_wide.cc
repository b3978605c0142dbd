#include "simulation/simd/lane_step.h"

namespace bio::lanes {

void solveWide(const LaneModel<Lanes>& arm, LaneStep& step) {
  solve(arm, step);
}

}  // namespace bio::lanes
