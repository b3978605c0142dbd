#pragma once

#include <string>
#include <vector>

#include "bio/discover/foresee.h"

namespace app {

/// The first of the predicted experiments in a sentence, if its expected log Bayes factor is at
/// least `enough` nats against every rival; else empty.
std::string foreseenSentence(const std::vector<bio::discover::ForeseenExperiment>& foreseen,
                             const info::discover::Disagreement& data,
                             const info::discover::Verdict& verdict, double enough);

}  // namespace app
