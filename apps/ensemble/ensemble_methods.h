#pragma once

#include <cstdint>

#include "discover/model_discovery.h"
#include "ensemble/ensemble_report.h"
#include "ensemble/parameter_laws.h"
#include "output/methods.h"

namespace app {

/// What is to be said of an ensemble: what was drawn from which distribution, how often, and how
/// the percentiles and Sobol's indices were made.
void sayEnsemble(const EnsembleFindings& findings, const TypedLaws& typed, std::uint64_t seed,
                 Methods& methods);

/// What is to be said of discovery in many data sets.
void sayDiscoveryInSets(const ModelDiscoveryRequest& each, std::size_t sets, Methods& methods);

}  // namespace app
