#pragma once

#include <string>
#include <vector>

#include "bio/discovery/predicted_experiments.h"

namespace app {

/// The first of the predicted experiments in a sentence, if its expected log Bayes factor is at
/// least `enough` nats against every rival; else empty.
std::string predictedExperimentSentence(
    const std::vector<bio::discover::PredictedExperiment>& predictedExperiments,
    const info::discover::DiscoveryProblem& data, const info::discover::Verdict& verdict,
    double enough);

}  // namespace app
