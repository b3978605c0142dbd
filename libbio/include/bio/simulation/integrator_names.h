#pragma once

#include <optional>
#include <string>

#include "bio/simulation/simulate.h"

namespace bio {

/// Names of integrators: "vi", "vi-left", "vi-adaptive", "rk4", "cvode".
const char* name(Integrator integrator);
/// Empty for an unknown name.
std::optional<Integrator> integratorNamed(const std::string& name);

/// Default Δt [s]: 0.01 for the variational integrators and for CVODE's output, 2e-4 for
/// Runge–Kutta, which is unstable at long steps.
double defaultStep(Integrator integrator);

/// Names of outcomes in reports: "ok", "unstable", "no solution", "stopped".
const char* name(Outcome outcome);

}  // namespace bio
