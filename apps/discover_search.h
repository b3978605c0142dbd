#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "info/discover/shorter_steps.h"
#include "summary.h"

/// What discovery in the elbow and in the robots have in common.
namespace app {

/// Options of the engine; trials that are held out come last.
/// @param inputScatter  of --input-scatter; empty: the engine's own
/// @throws std::invalid_argument if that is negative or no number
info::discover::Options engineOptions(int maxEffects, const std::optional<double>& inputScatter,
                                      std::size_t training, std::size_t heldOut);
void addInputScatter(CLI::App& options, std::optional<double>& inputScatter,
                     const std::string& when = {}, const std::string& group = "Options");

struct DiscoverSearch : info::discover::SteppedVerdict {
  double wallSeconds = 0;       ///< of all attempts
  double processorSeconds = 0;  ///< the same, of the processor
  bool interrupted = false;
};

/// info::discover::runAtShorterSteps with a bar (not if quiet); Ctrl-C ends it with what is there.
DiscoverSearch searchForEffects(const std::function<info::discover::Attempt(double step)>& attempt,
                                double step, double shortest, bool quiet = false);

/// Says what is lost where nothing judges the one trial.
void warnOfOneTrial(Summary& summary, std::size_t training, std::size_t heldOut);

/// Surrogates are not added: they would hide what is unknown.
bool mayBeAdded(const info::discover::Verdict& verdict);

}  // namespace app
