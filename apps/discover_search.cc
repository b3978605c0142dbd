#include "discover_search.h"

#include <chrono>

#include "interruption.h"
#include "progress_bar.h"

namespace app {

using info::discover::Finding;

info::discover::Options engineOptions(int maxEffects, std::size_t training, std::size_t heldOut) {
  info::discover::Options options;
  options.maxEffects = maxEffects;
  for (std::size_t i = 0; i < heldOut; ++i)
    options.heldOut.push_back(static_cast<int>(training + i));
  return options;
}

DiscoverSearch searchForEffects(const std::function<SearchAttempt(double step)>& attempt,
                                double step, double shortest) {
  DiscoverSearch search;
  const auto begin = std::chrono::steady_clock::now();
  for (search.step = step;; search.step /= 2) {
    SearchAttempt one = attempt(search.step);
    ProgressBar bar("discover");
    one.options.progress = [&](const info::discover::Progress& at) {
      search.interrupted = interruptionRequested();
      if (!search.interrupted) bar.update(at.fraction);
      return !search.interrupted;
    };
    search.verdict = info::discover::run(one.data, one.options);
    one.options.progress = {};
    search.options = std::move(one.options);
    if (search.verdict.finding != Finding::numerical || search.step < shortest) break;
  }
  search.wallSeconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return search;
}

void warnOfOneTrial(Summary& summary, std::size_t training, std::size_t heldOut) {
  if (training != 1 || heldOut != 0) return;
  summary.warn(
      "one trial and none held out: whether a name holds for other motions remains untested; "
      "add trials, or one with --hold-out");
}

bool mayBeAdded(const info::discover::Verdict& verdict) {
  return verdict.reached == info::discover::Stage::finished && !verdict.surrogate &&
         !verdict.effects.empty() && verdict.finding != Finding::numerical;
}

}  // namespace app
