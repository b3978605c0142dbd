#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bio/calibration/calibrated_model.h"
#include "info/discovery/likelihood/fitted_numbers.h"
#include "report/report.h"

namespace app {

/// A calibration with its inputs.
struct CalibrateFindings {
  const std::string& modelFile;
  const bio::Model& model;  ///< as it was given
  const bio::TrialSet& training;
  const bio::TrialSet* heldOut;  ///< null: none
  const bio::CalibrationOptions& options;
  const bio::Calibration& calibration;
  const bio::CalibratedModel* calibrated;  ///< null: no estimate
  std::optional<Playback> playback = {};
};

/// RMS error of a prediction [deg].
double rmse(const bio::TrialSet& set, const Eigen::MatrixXd& predicted);

/// RMS error of replays of the calibrated model [deg].
double rmseAfter(const CalibrateFindings& findings, bool heldOut);

/// Sets the values of summary.json: estimates, rmse_train_deg, rmse_held_out_deg, …
void tellCalibrate(const CalibrateFindings& findings, Summary& summary);

/// Motions before and after, estimates with intervals and priors, correlations, residuals and their
/// autocorrelation.
Report calibrateReport(const CalibrateFindings& findings);

/// Rows of parameters.csv: all estimates but the knots of latent excitations.
std::vector<info::discover::FittedNumber> fittedNumbers(const bio::Calibration& calibration);

/// "TRI.radius = 0.0158 ± 0.0002 m (was 0.016)", or why there is no interval: one parameter in
/// words.
std::string estimateWords(const bio::CalibratedParameter& parameter);

/// Whether results are told in degrees alone.
inline bool measuresOnlyAngles(const bio::TrialSet& set) {
  return set.channels().size() == 1 && set.channels().front().areAngles;
}

}  // namespace app
