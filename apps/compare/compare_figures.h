#pragma once

#include <string>
#include <vector>

#include "compare/compare_report.h"

// The figures of a comparison.
namespace app {

bool isOk(const bio::CompareCell& cell);

/// The cells of one integrator, in rising order of step.
std::vector<const bio::CompareCell*> cellsOf(const CompareFindings& findings,
                                             bio::Integrator integrator);

/// RMS error over time to simulate, one curve per integrator.
Figure workPrecisionFigure(const CompareFindings& findings);

/// RMS error over step: its slope is the order.
Figure errorFigure(const CompareFindings& findings);

/// Time that the runs reached, for integrators that failed at some step; a sentence if none did.
ReportPart failureTimeline(const CompareFindings& findings);

/// Runge–Kutta at three steps: the two longest steps that succeed and the first that fails.
Figure rungeKuttaFigure(const CompareFindings& findings);

/// The variational integrator at two steps: the one nearest to 10 ms and the longest that succeeds.
Figure variationalFigure(const CompareFindings& findings);

/// The reference, and each fixed-step integrator at its longest step with a useful error.
Figure besideFigure(const CompareFindings& findings, const std::string& title);

}  // namespace app
