#pragma once

#include "info/discover/unknown.h"

// Not public.

namespace info::discover {

/// Looks for the formula of Unknown: fills in terms, evidence, explained, stable and formula.
void findFormula(const Likelihood& likelihood, const Fit& fit, Unknown& unknown);

}  // namespace info::discover
