#pragma once

#include <Eigen/Dense>
#include <nlohmann/json.hpp>
#include <vector>

#include "discover/discover_verdict.h"

namespace app {

/// Samples of one output among those of a trial.
std::vector<Eigen::Index> samplesOf(const info::discover::DiscoveryProblem& data, int trial,
                                    std::size_t output);

/// Root mean square error of each output at all fitted values, without a latent force, over the
/// held-out or the other trials, in its shown unit; NaN: no sample.
Eigen::VectorXd errorsOf(const DiscoverFindings& findings, bool ofHeldOut);

/// The outputs: name, unit, and noise in that unit; of several outputs also the error of the
/// fitted trials.
nlohmann::ordered_json outputsJson(const DiscoverFindings& findings);

}  // namespace app
