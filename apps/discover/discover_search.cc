#include "discover/discover_search.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <ctime>
#include <stdexcept>

#include "output/interruption.h"
#include "output/progress_bar.h"

namespace app {

using info::discover::Finding;

namespace {

/// Processor time of this thread.
double threadSeconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

void addInputScatter(CLI::App& options, std::optional<double>& inputScatter,
                     const std::string& when, const std::string& group) {
  options
      .add_option(
          "--input-scatter", inputScatter,
          when + fmt::format(
                     "input noise tolerated, as a fraction of each input's effect (EMG: of each "
                     "muscle's moment); a larger residual counts as a missing effect; default: {}",
                     info::discover::Options().latentTolerance))
      ->type_name("S")
      ->group(group);
}

info::discover::Options engineOptions(int maxEffects, const std::optional<double>& inputScatter,
                                      std::size_t training, std::size_t heldOut) {
  info::discover::Options options;
  options.maxEffects = maxEffects;
  if (inputScatter) {
    if (!(*inputScatter >= 0) || !std::isfinite(*inputScatter))
      throw std::invalid_argument(
          fmt::format("--input-scatter: {} must be a number ≥ 0", *inputScatter));
    options.latentTolerance = *inputScatter;
  }
  for (std::size_t i = 0; i < heldOut; ++i)
    options.heldOut.push_back(static_cast<int>(training + i));
  return options;
}

DiscoverSearch searchForEffects(const std::function<info::discover::Attempt(double step)>& attempt,
                                double step, double shortest, bool quiet) {
  const auto begin = std::chrono::steady_clock::now();
  const double used = threadSeconds();
  std::optional<ProgressBar> bar;
  bool interrupted = false;
  const auto shown = [&](double at) {
    info::discover::Attempt one = attempt(at);
    if (!quiet && !bar) bar.emplace("discover");
    one.options.progress = [&](const info::discover::Progress& progress) {
      interrupted = interruptionRequested();
      if (!interrupted && bar) bar->update(progress.fraction);
      return !interrupted;
    };
    return one;
  };
  DiscoverSearch search{info::discover::runAtShorterSteps(shown, step, shortest)};
  search.options.progress = {};
  search.interrupted = interrupted;
  search.wallSeconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  search.processorSeconds = threadSeconds() - used;
  return search;
}

void warnOfOneTrial(Summary& summary, std::size_t training, std::size_t heldOut) {
  if (training != 1 || heldOut != 0) return;
  summary.warn(
      "one trial and none held out: whether the result holds for other motions is untested; add "
      "trials, or hold one out with --hold-out");
}

bool mayBeAdded(const info::discover::Verdict& verdict) {
  return verdict.reached == info::discover::Stage::finished && !verdict.proxy &&
         !verdict.effects.empty() && verdict.finding != Finding::numerical;
}

}  // namespace app
