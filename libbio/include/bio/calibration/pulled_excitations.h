#pragma once

#include <string>
#include <vector>

#include "bio/calibration/calibrate.h"

namespace bio {

/// How far the data pulled the excitation of a muscle without an electrode from what was expected.
struct PulledExcitation {
  std::string file;
  LatentDeclaration declared;
  std::vector<double> knots;         ///< [s]
  Eigen::VectorXd expected, fitted;  ///< excitation at the knots
  Eigen::VectorXd z;                 ///< c_k/sd, of the log-odds
  Eigen::VectorXd sd;                ///< of c_k given the data; NaN where these do not determine it
  double largest() const { return z.cwiseAbs().maxCoeff(); }
  double rms() const;
};

/// Every latent excitation of the calibration trials; none without an estimate.
std::vector<PulledExcitation> pulledExcitations(const TrialSet& training,
                                                const Calibration& calibration);

}  // namespace bio
