#pragma once

#include <array>
#include <functional>

#include "robot_figures.h"

/// Tables 4.4 and 4.7 in kind: both motions run in a simulated laboratory that has effects the
/// model has not, and the parameters estimated from either recording.
namespace app {

/// A robot in the laboratory.
struct LaboratoryRobot {
  std::function<info::PlannedExperiment(const info::CartMotion&)> experiment;
  std::function<Eigen::MatrixXd(const info::CartMotion&, std::uint64_t seed)> measure;
  Eigen::Vector2d truth;  ///< of the plant
  /// As printed: initial estimate, actual value, from the initial motion and its errors, from the
  /// optimised motion and its errors.
  std::array<std::array<std::string, 2>, 6> thesis;
  std::string thesisTable;
  std::vector<std::pair<double, double>> range;  ///< of the maps of β
};

/// Adds `laboratory` to the summary, and table and maps to the report. The recording shown has the
/// seed asked for; errors are the medians of 25.
void tellLaboratory(const LaboratoryRobot& robot, const info::LaboratoryEffects& effects,
                    const info::CartMotion& before, const info::CartMotion& after,
                    const CommandContext& context, Summary& summary, Report& report);

/// What a motion's recordings of the laboratory make of the parameters.
struct LaboratoryEstimates {
  info::Estimate shown;         ///< from the recording of the first seed
  Eigen::Vector2d error;        ///< of it, |estimate/truth − 1|
  Eigen::Vector2d medianError;  ///< likewise, over all recordings
  Eigen::MatrixXd recording;    ///< the first
};
LaboratoryEstimates estimateInLaboratory(const LaboratoryRobot& robot,
                                         const info::CartMotion& motion, int recordings,
                                         const CommandContext& context);

}  // namespace app
