#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "info/discovery/likelihood/discovery_problem.h"
#include "info/discovery/likelihood/whitening.h"

namespace info::discover {

/// Root mean square difference of simulation (without latent force) and data over all samples, in
/// the unit of the output; of several outputs in σ, times the σ of the first.
struct ExcessError {
  double nominal = NAN;     ///< original base model, initial states fitted; NaN: not computed yet
  double calibrated = NAN;  ///< base model after calibration
  double after = NAN;       ///< with the effects
  double floor = NAN;       ///< σ_y
  double range = NAN;       ///< range of the data, for normalised errors
  /// Expected `after` of held-out trials if the model found were true (expectedError); empty for
  /// fitted trials
  std::optional<double> expected;
  std::optional<double> probability;  ///< of at least the observed `after` if that model were true
  /// 1 − (after² − floor²)/(before² − floor²); empty if there is no gap to close: before² <
  /// 1.2·floor², three standard deviations of a mean square over 450 samples
  std::optional<double> closedFromCalibrated, closedFromNominal;

  /// Whether an error of so many σ_y or more is expected.
  bool isVague(double most) const { return expected && *expected > most * floor; }
};

/// Root mean square difference of simulation (without latent force) and data of each output, over
/// all samples of some trials, in its unit; NaN without a sample.
Eigen::VectorXd errorsByOutput(const DiscoveryProblem& data, const std::vector<int>& trials,
                               const Eigen::VectorXd& values, std::size_t numOutputs);

/// Range of the measured values of an output, the widest in σ, times the σ of the first output.
double rangeOf(const DiscoveryProblem& data, const std::vector<int>& trials,
               const Whitening& noise);

/// Sets `closedFrom…`.
void explainExcess(ExcessError& excess);

}  // namespace info::discover
