#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "info/discovery/judgement/residual_causes.h"
#include "info/discovery/likelihood/joint_fit.h"

namespace info::discover {

/// Tests whether the innovations of a fit are white noise of the expected size.
struct Adequacy {
  double meanSquare = 0;           ///< mean normalised innovation squared, about 1
  double lowest = 0, highest = 0;  ///< its acceptance region
  double ljungBox = 0;             ///< Q over the lags
  double ljungBoxProbability = 1;  ///< probability of so large a Q by chance
  double inputScore = 0;           ///< largest |z| of innovations against past inputs
  double inputProbability =
      1;              ///< probability of so large a score by chance, over all inputs and lags
  std::string input;  ///< input with the largest score
  ResidualEvidence remainder;  ///< log Bayes factor [nats] of a further disturbance, for each Cause
  bool sized = true, white = true, independent = true, causeless = true;
  bool adequate() const { return sized && white && independent && causeless; }
};

/// Tests whether held-out trials agree with the model, given its uncertain parameters and the
/// scatter of its inputs. With J the minimal cost of a fit (joint_fit.h) to n further samples,
///     mean square = 2(J of all trials − J of those that were fitted)/n
/// which is the mean normalised innovation squared of these samples: for a linear model exactly
/// distributed as χ²(n)/n, about 1.
struct HeldOutAdequacy {
  double meanSquare = 0;
  double highest = 0;  ///< upper end of its acceptance region
  bool expected() const { return meanSquare < highest; }
};

struct AdequacyOptions {
  double level = 0.001;
  int lags = 20;
  double evidence = 2;  ///< largest log Bayes factor [nats] that a further disturbance may have
  double sdError = 0;   ///< relative standard error of an estimated σ_y: widens
};

/// With the region in which the mean square of so many samples lies at AdequacyOptions::level.
HeldOutAdequacy heldOutAdequacy(double meanSquare, Eigen::Index samples,
                                const AdequacyOptions& options);

/// Tests the whitened innovations of a fit: their size (χ²), their autocorrelation (Ljung and Box,
/// lags pooled over trials, corrected for the effect of fitted parameters on white noise), their
/// correlation with each input 0 to 0.2 s earlier, and whether the residual disturbance follows a
/// Cause other than the sensor.
Adequacy adequacy(const Likelihood& likelihood, const Fit& fit, const AdequacyOptions& options);

/// Upper tail of χ² with n degrees of freedom, n > 0.
double chiSquareTail(double x, double n);
/// x with chiSquareTail(x, n) = probability.
double chiSquareQuantile(double probability, double n);

}  // namespace info::discover
