#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "bio/analysis/compare_muscles.h"
#include "report/report.h"

namespace app {

/// A comparison of muscle classes with its inputs.
struct MuscleFindings {
  const std::string& modelFile;
  const std::string& trialFile;
  const bio::Coordinate& coordinate;  ///< measured
  const std::vector<bio::MuscleClassMotion>& classes;
  double noise = 0;  ///< of a sample [rad] or [m]
};

/// muscles.csv: one row per class.
void writeMuscleClasses(const MuscleFindings& findings, std::ostream& out);
/// muscle_bounds.csv: one row per parameter, one column per class: standard deviation that the data
/// and the priors leave, over the value.
void writeMuscleBounds(const MuscleFindings& findings, std::ostream& out);
/// Sets muscle_classes of summary.json.
void tellMuscles(const MuscleFindings& findings, Summary& summary);
/// The motions in one figure, the table, the bounds.
Report musclesReport(const MuscleFindings& findings);

}  // namespace app
