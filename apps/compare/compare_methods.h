#pragma once

#include "compare/compare_muscles_report.h"
#include "compare/compare_report.h"
#include "output/methods.h"

namespace app {

/// What is to be said of integrators that were compared: which at which steps, the reference and
/// how it was confirmed, and how errors, orders, stable steps and times are defined.
void sayComparison(const CompareFindings& findings, Methods& methods);

/// What is to be said of classes of muscles that were compared.
void sayMuscleClasses(const MuscleFindings& findings, Methods& methods);

}  // namespace app
