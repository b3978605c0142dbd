#pragma once

#include <optional>
#include <vector>

#include "info/discovery/likelihood/fitted_numbers.h"
#include "info/discovery/search/shorter_steps.h"
#include "namespace.h"

/// Shared parts of discover and discover_robot.
namespace python {

/// @throws std::invalid_argument for a scatter that is negative or no number
info::discover::Options searchOptions(int maxEffects, std::optional<double> inputScatter);

/// The members that an effect has in every kind of system.
py::dict effectMembers(const info::discover::DiscoveryProblem& data,
                       const info::discover::NamedEffect& effect);

/// The members that a result has in every kind of system, beside its effects.
py::dict verdictMembers(const info::discover::DiscoveryProblem& data,
                        const info::discover::SteppedVerdict& found,
                        const std::vector<info::discover::FittedNumber>& fitted);

}  // namespace python
