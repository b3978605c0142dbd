#pragma once

#include <functional>

#include "info/estimation/estimate.h"
#include "robots/laboratory.h"
#include "robots/robot_work.h"

/// Two motions are simulated with effects that the model lacks, and the parameters are estimated
/// from each recording, as in tables 4.4 and 4.7 of Wilson's thesis.
namespace info::robot {

/// A robot in the simulated laboratory.
struct LaboratoryRobot {
  std::function<PlannedExperiment(const CartMotion&)> experiment;
  std::function<Eigen::MatrixXd(const CartMotion&, std::uint64_t seed)> measure;
  Eigen::Vector2d truth;  ///< of the plant
};
LaboratoryRobot doublePendulumInLaboratory(const LaboratoryEffects& effects);
LaboratoryRobot suspendedMassInLaboratory(const LaboratoryEffects& effects);

/// Estimates from simulated recordings of one motion.
struct LaboratoryEstimates {
  LeastSquares problem;         ///< of the first recording
  Estimate first;               ///< from it
  Eigen::Vector2d error;        ///< of that, |estimate/truth − 1|
  Eigen::Vector2d medianError;  ///< over all recordings
};

/// @param recordings > 0; recording i has the seed `seed` + i
/// @param threads number of threads; 0: all cores
LaboratoryEstimates estimateInLaboratory(const LaboratoryRobot& robot, const CartMotion& motion,
                                         int recordings, std::uint64_t seed, int threads,
                                         const WorkProgress& progress = {});

/// Both motions in one laboratory.
struct LaboratoryComparison {
  LaboratoryEffects effects;
  int recordings;         ///< of each motion
  Eigen::Vector2d start;  ///< initial guess
  Eigen::Vector2d truth;
  LaboratoryEstimates before, after;
};
LaboratoryComparison compareInLaboratory(const LaboratoryRobot& robot,
                                         const LaboratoryEffects& effects, const CartMotion& before,
                                         const CartMotion& after, std::uint64_t seed, int threads,
                                         const WorkProgress& progress = {});

}  // namespace info::robot
