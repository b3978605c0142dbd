#pragma once

#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "bio/compare.h"
#include "bio/coordinate_curve.h"
#include "bio/trial.h"
#include "report.h"

namespace app {

/// A result of another program that is laid beside ours.
struct AlsoCurve {
  std::string name;
  bio::CoordinateCurve curve;
  double rms = 0;  ///< from the reference [rad]
};

/// Compared integrators and all that goes with them.
struct CompareFindings {
  const std::string& modelFile;
  const std::string& trialFile;
  const bio::Trial& trial;
  const bio::Arm& arm;
  const bio::Coordinate& coordinate;  ///< the free rotation that the figures show
  const bio::CompareOptions& options;
  const bio::Comparison& comparison;
  const std::vector<AlsoCurve>& also;
  const bio::CompareCell* chosen;  ///< the run of --integrator and --step; null without a reference
};

/// compare.csv: one row per integrator and step; an empty cell is not known.
void writeCells(const bio::Comparison& comparison, std::ostream& out);

/// The figures that summary.json is to hold: largest_stable_step_s, observed_order, …
void tellCompare(const CompareFindings& findings, Summary& summary);

/// Work against precision, error against step, motions, where runs ended.
Report compareReport(const CompareFindings& findings);

}  // namespace app
