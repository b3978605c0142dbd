#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "info/discovery/likelihood/discovery_problem.h"

namespace info::discover {

/// How far simulation (no latent force) and data are apart, root mean square over all samples, in
/// the unit of the output.
struct ExcessError {
  double nominal = NAN;     ///< base model as it came, starts fitted; NaN: not looked at yet
  double calibrated = NAN;  ///< base model after calibration
  double after = NAN;       ///< with the effects
  double floor = NAN;       ///< σ_y
  double range = NAN;       ///< of the data, for normalised errors
  /// What `after` may be expected to be of held-out trials, were the model found true
  /// (expectedError); empty for those that were fitted
  std::optional<double> expected;
  std::optional<double> probability;  ///< that `after` is as large as it is, were that model true
  /// 1 − (after² − floor²)/(before² − floor²); empty if before² < 1.2·floor², three
  /// deviations of a mean square over 450 samples: no gap to close
  std::optional<double> closedFromCalibrated, closedFromNominal;
};

/// Fills in `closedFrom…`.
void explainExcess(ExcessError& gap);

}  // namespace info::discover
