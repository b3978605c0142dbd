#pragma once

#include "calibrate/calibrate_report.h"

namespace app {

/// A knot of a latent excitation, which is not told one by one.
bool isKnot(const bio::CalibratedParameter& parameter);

/// How far the data pulled the excitations of muscles without an electrode from what was expected.
struct PulledExcitation {
  std::string file;
  bio::LatentDeclaration declared;
  std::vector<double> knots;         ///< [s]
  Eigen::VectorXd expected, fitted;  ///< excitation at the knots
  Eigen::VectorXd z;                 ///< c_k/sd, of the log-odds
  double largest() const { return z.cwiseAbs().maxCoeff(); }
  double rms() const;
};
std::vector<PulledExcitation> pulledExcitations(const CalibrateFindings& findings);

/// "TRIlat in a.sto: …", one line each.
std::string inWords(const PulledExcitation& one);

/// Sets `latent_excitations`, and warns of those pulled by more than 3 standard deviations.
void tellLatent(const CalibrateFindings& findings, Summary& summary);
void addLatent(const CalibrateFindings& findings, Report& report);

}  // namespace app
