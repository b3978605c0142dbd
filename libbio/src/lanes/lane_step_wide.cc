#include "lanes/lane_step.h"

namespace bio::lanes {

void solveWide(const LaneArm<Lanes>& arm, LaneStep& step) {
  solve(arm, step);
}

}  // namespace bio::lanes
