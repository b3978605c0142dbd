#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "info/discovery/judgement/residual_causes.h"
#include "info/discovery/likelihood/joint_fit.h"

namespace info::discover {

/// Is what is left white noise of the size that it should have?
struct Adequacy {
  double meanSquare = 0;           ///< mean normalised innovation squared, about 1
  double lowest = 0, highest = 0;  ///< its band
  double ljungBox = 0;             ///< Q over the lags
  double ljungBoxProbability = 1;  ///< of a Q as large by chance
  double inputScore = 0;           ///< largest |z| of innovations against past inputs
  double inputProbability = 1;     ///< of one as large by chance, over all inputs and lags
  std::string input;               ///< which input that was
  ResidualEvidence remainder;      ///< nats that a further disturbance with a cause would gain
  bool sized = true, white = true, independent = true, causeless = true;
  bool adequate() const { return sized && white && independent && causeless; }
};

/// Are trials that were not fitted what the model, with its uncertain parameters and the scatter of
/// its inputs, leads to expect? With J the least cost of a fit (joint_fit.h) to n more samples,
///     mean square = 2(J of all trials − J of those that were fitted)/n
/// which is that of their innovations: exactly so for a linear model, χ²(n)/n about 1.
struct HeldOutAdequacy {
  double meanSquare = 0;
  double highest = 0;  ///< upper end of its band
  bool expected() const { return meanSquare < highest; }
};

struct AdequacyOptions {
  double level = 0.001;
  int lags = 20;
  double evidence = 2;  ///< nats that a further disturbance with a cause may gain
  double sdError = 0;   ///< relative standard error of σ_y where it was estimated: widens
};

/// Tests the whitened innovations of a fit: their size (χ²), their autocorrelation (Ljung and Box,
/// lags pooled over trials, less what fitted parameters make of white noise), their correlation
/// with each input 0 to 0.2 s earlier, and whether what the fit leaves to chance has a Cause
/// other than the sensor.
Adequacy adequacy(const Likelihood& likelihood, const Fit& fit, const AdequacyOptions& options);

/// Upper tail of χ² with n degrees of freedom, n > 0.
double chiSquareTail(double x, double n);
/// x with chiSquareTail(x, n) = probability.
double chiSquareQuantile(double probability, double n);

}  // namespace info::discover
