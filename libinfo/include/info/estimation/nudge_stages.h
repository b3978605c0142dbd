#pragma once

#include <array>

namespace info {

/// One stage of an estimate that is led to its minimum by a model held near the data, less and less
/// firmly.
struct NudgeStage {
  double frequency;  ///< natural frequency of the spring that holds it [rad/s]
  double spread;     ///< deviations of the noise by which the held model may be off
};

/// From so firm that nothing is unstable to hardly any hold; after them comes the model itself.
inline constexpr std::array nudgeStages = {NudgeStage{12, 3}, NudgeStage{8, 3},   NudgeStage{5, 2},
                                           NudgeStage{3, 2},  NudgeStage{2, 1.5}, NudgeStage{1, 1}};

}  // namespace info
