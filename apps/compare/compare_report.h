#pragma once

#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "bio/analysis/compare.h"
#include "bio/analysis/coordinate_curve.h"
#include "bio/tables/trial.h"
#include "report/report.h"

namespace app {

/// A result of another program, to compare with.
struct AlsoCurve {
  std::string name;
  bio::CoordinateCurve curve;
  double rms = 0;  ///< RMS difference from the reference [rad]
};

/// A comparison of integrators with its inputs.
struct CompareFindings {
  const std::string& modelFile;
  const std::string& trialFile;
  const bio::Trial& trial;
  const bio::MusculoskeletalSystem& system;
  const bio::Coordinate& coordinate;  ///< the free rotation that the figures show
  const bio::CompareOptions& options;
  const bio::Comparison& comparison;
  const std::vector<AlsoCurve>& also;
  const bio::CompareCell* chosen;  ///< the run of --integrator and --step; null without a reference
};

/// compare.csv: one row per integrator and step; an empty cell means unknown.
void writeCells(const bio::Comparison& comparison, std::ostream& out);

/// Sets the values of summary.json: largest_stable_step_s, observed_order, …
void tellCompare(const CompareFindings& findings, Summary& summary);

/// Work against precision, error against step, motions, where runs ended.
Report compareReport(const CompareFindings& findings);

}  // namespace app
