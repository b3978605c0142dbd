#pragma once

#include <cstddef>
#include <functional>

#include "info/discover/discover.h"
#include "summary.h"

/// What discovery in the elbow and in the robots have in common.
namespace app {

/// Options of the engine; trials that are held out come last.
info::discover::Options engineOptions(int maxEffects, std::size_t training, std::size_t heldOut);

/// A model at one time step, and what the engine is told.
struct SearchAttempt {
  const info::discover::Disagreement& data;
  info::discover::Options options;
};

struct DiscoverSearch {
  info::discover::Options options;
  info::discover::Verdict verdict;
  double step = 0;         ///< [s]
  double wallSeconds = 0;  ///< of all attempts
  bool interrupted = false;
};

/// Steps that are too long look like an effect: searches again at half the step while the verdict
/// is "numerical" and the step is not below `shortest`. Shows a bar; Ctrl-C ends it with what is
/// there.
/// @param attempt   makes the model at a step; the model lives until the next call
/// @param shortest  [s]; infinite: the step was asked for
DiscoverSearch searchForEffects(const std::function<SearchAttempt(double step)>& attempt,
                                double step, double shortest);

/// Says what is lost where nothing judges the one trial.
void warnOfOneTrial(Summary& summary, std::size_t training, std::size_t heldOut);

/// Surrogates are not added: they would hide what is unknown.
bool mayBeAdded(const info::discover::Verdict& verdict);

}  // namespace app
