#pragma once

#include "discover/discover_verdict.h"
#include "report/report.h"

namespace app {

/// Measured motion, calibrated base model, and the model with the effects. The band holds 95 % of
/// the measurements, given the noise and the uncertainty of the amplitudes. Without series if the
/// trial does not measure the output.
Figure motionFigure(const DiscoverFindings& findings, int trial, std::size_t output);

/// RMS errors of the simulations before and after, and the noise.
Table excessErrorTable(const DiscoverFindings& findings);

/// Errors of the fitted model output by output, in their units.
Table outputErrorTable(const DiscoverFindings& findings);

/// The tests of the residuals, each with its rule.
Table adequacyTable(const DiscoverFindings& findings);

}  // namespace app
