#pragma once

#include <optional>
#include <string>

#include "bio/coupled.h"

namespace bio {

/// Integrators as people write them: "vi", "vi-left", "rk4", "cvode".
const char* name(Integrator integrator);
/// Nothing if there is none of this name.
std::optional<Integrator> integratorNamed(const std::string& name);

/// Δt [s] where none is asked for: 0.01 for the variational integrators and for CVODE's output,
/// 2e-4 for Runge–Kutta, which is unstable at long steps.
double defaultStep(Integrator integrator);

/// How a simulation ended, as reports say it: "ok", "unstable", "no solution", "stopped".
const char* name(Outcome outcome);

}  // namespace bio
