#pragma once

#include <string>
#include <vector>

#include "bio/calibrate.h"
#include "report.h"

namespace app {

/// A calibration and all that it was made of.
struct CalibrateFindings {
  const std::string& modelFile;
  const bio::TrialSet& training;
  const bio::TrialSet* heldOut;  ///< null: none
  const bio::CalibrationOptions& options;
  const bio::Calibration& calibration;
};

/// The figures that summary.json is to hold: estimates, rmse_train_deg, rmse_held_out_deg, …
void tellCalibrate(const CalibrateFindings& findings, Summary& summary);

/// Motions before and after, estimates with intervals and priors, correlations, residuals and their
/// autocorrelation.
Report calibrateReport(const CalibrateFindings& findings);

/// "TRI.radius = 0.0158 ± 0.0002 m (was 0.016)", or why there is no interval: one parameter in
/// words.
std::string estimateWords(const bio::CalibratedParameter& parameter);

}  // namespace app
