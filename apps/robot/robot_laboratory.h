#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "robot/robot_figures.h"
#include "robots/laboratory_estimates.h"

namespace app {

/// A table of Wilson's thesis about a robot in the laboratory.
struct ThesisLaboratory {
  std::string table;
  /// As printed: initial guess, true value, estimate from the initial motion and its errors,
  /// estimate from the optimised motion and its errors.
  std::array<std::array<std::string, 2>, 6> printed;
  std::vector<std::pair<double, double>> range;  ///< of the maps of β
};

/// Adds `laboratory` to the summary, and table and maps to the report, beside the thesis.
void tellLaboratory(const info::robot::LaboratoryComparison& found, const ThesisLaboratory& thesis,
                    const CommandContext& context, Summary& summary, Report& report);

}  // namespace app
