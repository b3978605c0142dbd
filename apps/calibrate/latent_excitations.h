#pragma once

#include "bio/calibration/pulled_excitations.h"
#include "calibrate/calibrate_report.h"

namespace app {

/// "TRIlat in a.sto: …", one line each.
std::string inWords(const bio::PulledExcitation& excitation);

/// Sets `latent_excitations`, and warns of those pulled by more than 3 standard deviations.
void tellLatent(const CalibrateFindings& findings, Summary& summary);
void addLatent(const CalibrateFindings& findings, Report& report);

}  // namespace app
