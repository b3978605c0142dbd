#pragma once

#include "discover_verdict.h"
#include "report.h"

namespace app {

/// Measured, base after calibration, and with the effects; the band is the measurement's noise
/// together with what the amplitudes leave open, 95 %.
Figure motionFigure(const DiscoverFindings& findings, int trial, std::size_t output);

/// How far simulations are from what was measured: before, after, and noise alone.
Table gapTable(const DiscoverFindings& findings);

/// The tests of what is left, each with its rule.
Table adequacyTable(const DiscoverFindings& findings);

}  // namespace app
