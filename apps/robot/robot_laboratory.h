#pragma once

#include <array>
#include <functional>

#include "robot/robot_figures.h"

/// Analogues of tables 4.4 and 4.7 of Wilson's thesis: both motions are simulated with effects that
/// the model lacks, and the parameters are estimated from each recording.
namespace app {

/// A robot in the simulated laboratory.
struct LaboratoryRobot {
  std::function<info::PlannedExperiment(const info::CartMotion&)> experiment;
  std::function<Eigen::MatrixXd(const info::CartMotion&, std::uint64_t seed)> measure;
  Eigen::Vector2d truth;  ///< of the plant
  /// As printed in the thesis: initial guess, true value, estimate from the initial motion and its
  /// errors, estimate from the optimised motion and its errors.
  std::array<std::array<std::string, 2>, 6> thesis;
  std::string thesisTable;
  std::vector<std::pair<double, double>> range;  ///< of the maps of β
};

/// Adds `laboratory` to the summary, and table and maps to the report. The recording shown has the
/// given seed; errors are medians of 25 recordings.
void tellLaboratory(const LaboratoryRobot& robot, const info::LaboratoryEffects& effects,
                    const info::CartMotion& before, const info::CartMotion& after,
                    const CommandContext& context, Summary& summary, Report& report);

/// Estimates from the simulated recordings of a motion.
struct LaboratoryEstimates {
  info::Estimate shown;         ///< from the recording of the first seed
  Eigen::Vector2d error;        ///< its error, |estimate/truth − 1|
  Eigen::Vector2d medianError;  ///< median error over all recordings
  Eigen::MatrixXd recording;    ///< the first
};
LaboratoryEstimates estimateInLaboratory(const LaboratoryRobot& robot,
                                         const info::CartMotion& motion, int recordings,
                                         const CommandContext& context);

}  // namespace app
