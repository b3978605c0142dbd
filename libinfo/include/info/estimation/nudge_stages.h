#pragma once

#include <array>

namespace info {

/// One stage of an estimation with nudging, in which the model is pulled towards the data, from
/// stage to stage less strongly.
struct NudgeStage {
  double frequency;  ///< natural frequency of the nudging spring [rad/s]
  double spread;     ///< error of the nudged model, in standard deviations of the noise
};

/// From strong nudging, with which no model is unstable, to weak nudging; the original model
/// follows afterwards.
inline constexpr std::array nudgeStages = {NudgeStage{12, 3}, NudgeStage{8, 3},   NudgeStage{5, 2},
                                           NudgeStage{3, 2},  NudgeStage{2, 1.5}, NudgeStage{1, 1}};

}  // namespace info
