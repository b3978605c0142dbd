#include "lanes/lane_step.h"

namespace bio::lanes {

void solvePlain(const LaneArm<Lanes>& arm, LaneStep& step) {
  solve(arm, step);
}

}  // namespace bio::lanes
