#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "info/discovery/search/shorter_steps.h"
#include "output/summary.h"

/// Search options and search, shared by discovery in musculoskeletal models and in robots.
namespace app {

/// Options of the search; held-out trials come last.
/// @param inputScatter of --input-scatter; empty: the default
/// @throws std::invalid_argument if that is negative or no number
info::discover::Options engineOptions(int maxEffects, const std::optional<double>& inputScatter,
                                      std::size_t training, std::size_t heldOut);
void addInputScatter(CLI::App& options, std::optional<double>& inputScatter,
                     const std::string& when = {}, const std::string& group = "Options");

struct DiscoverSearch : info::discover::SteppedVerdict {
  double wallSeconds = 0;       ///< of all attempts
  double processorSeconds = 0;  ///< processor time of all attempts
  bool interrupted = false;
};

/// info::discover::runAtShorterSteps with a progress bar (unless quiet); Ctrl-C ends it with the
/// result so far.
DiscoverSearch searchForEffects(const std::function<info::discover::Attempt(double step)>& attempt,
                                double step, double shortest, bool quiet = false);

/// Warns if there is one trial only and none is held out.
void warnOfOneTrial(Summary& summary, std::size_t training, std::size_t heldOut);

/// Whether the effects may be built into the model. Proxies may not: they would hide the unknown
/// effect.
bool mayBeAdded(const info::discover::Verdict& verdict);

}  // namespace app
