#include "info/discovery/search/shorter_steps.h"

#include <fmt/format.h>

#include <chrono>
#include <ctime>
#include <limits>
#include <stdexcept>
#include <utility>

namespace info::discover {

namespace {

using MakeAttempt = std::function<Attempt(double step)>;

SteppedVerdict runOnce(const MakeAttempt& attempt, double step, double shortest) {
  WarmStart draft;
  for (bool first = true;; first = false) {
    Attempt one = attempt(step);
    if (!first) one.options.numericalTolerance *= 2;
    one.options.concludesNumerical = step < shortest;
    try {
      Verdict verdict = run(one.data, one.options, &draft);
      if (verdict.finding != Finding::numerical || step < shortest)
        return {std::move(verdict), std::move(one.options), step, 0, 0};
    } catch (const std::domain_error&) {
      if (step < shortest) throw;
    }
    step /= 2;
  }
}

// The fitted trials by themselves show nothing.
bool hasNothing(const Verdict& verdict, const Options& options) {
  return verdict.finding == Finding::none ||
         (verdict.finding == Finding::unknown && verdict.effects.empty() &&
          verdict.before.adequate() && verdict.latentSizeBefore <= options.latentTolerance);
}

bool isWorthASecondLook(const Verdict& verdict, const Options& options) {
  return verdict.reached == Stage::finished && hasNothing(verdict, options) && verdict.heldOut &&
         verdict.heldOut->probability && *verdict.heldOut->probability < options.secondLook;
}

bool hasAName(const Verdict& verdict) {
  return verdict.reached == Stage::finished &&
         (verdict.finding == Finding::named || verdict.finding == Finding::ambiguous ||
          verdict.finding == Finding::parameter);
}

/// Processor time of this thread [s].
double threadSeconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

SteppedVerdict runTwiceIfNeeded(const MakeAttempt& attempt, double step, double shortest) {
  SteppedVerdict first = runOnce(attempt, step, shortest);
  if (!isWorthASecondLook(first.verdict, first.options)) return first;
  double last = first.step;
  const auto withAll = [&](double at) {
    last = at;
    Attempt one = attempt(at);
    one.options.heldOut.clear();
    one.options.progress = progressOfAnother(std::move(one.options.progress));
    return one;
  };
  SteppedVerdict second = runOnce(withAll, first.step, shortest);
  const int fits = first.verdict.fits + second.verdict.fits;
  if (hasAName(second.verdict)) {
    second.verdict.heldOutFitted = true;
    if (first.verdict.finding == Finding::unknown) {  // nor does anything else support it
      second.verdict.vetoed = true;
      second.verdict.probability = 0;
    }
    second.verdict.sentence += " It was found only when the held-out trials were fitted as well.";
    second.verdict.fits = fits;
    return second;
  }
  first.verdict.fits = fits;
  if (last != first.step) attempt(first.step);  // leaves the caller with the model of the verdict
  return first;
}

}  // namespace

SearchClock::SearchClock()
    : begin_(std::chrono::steady_clock::now()), processor_(threadSeconds()) {}

void SearchClock::writeTo(SteppedVerdict& found) const {
  found.wallSeconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  found.processorSeconds = threadSeconds() - processor_;
}

std::function<bool(const Progress&)> progressOfAnother(
    std::function<bool(const Progress&)> progress) {
  if (!progress) return {};
  return [tell = std::move(progress)](const Progress& now) {
    return tell({now.stage, 0.99 + 0.01 * now.fraction, now.doing});
  };
}

SteppedVerdict runAtShorterSteps(const MakeAttempt& attempt, double step, double shortest) {
  const SearchClock clock;
  SteppedVerdict found = runTwiceIfNeeded(attempt, step, shortest);
  clock.writeTo(found);
  return found;
}

SteppedVerdict searchTrials(const TrialSearch& search,
                            const std::function<const DiscoveryProblem&(double step)>& problemAt) {
  Options options = search.options;
  options.heldOut.clear();
  for (std::size_t i = search.numTrials - search.numHeldOut; i < search.numTrials; ++i)
    options.heldOut.push_back(static_cast<int>(i));
  const double first = search.step.value_or(search.firstStep);
  if (search.onlyNominal) {
    const SearchClock clock;
    SteppedVerdict found{withoutSearch(problemAt(first), options), options, first};
    clock.writeTo(found);
    return found;
  }
  return runAtShorterSteps(
      [&](double step) {
        return Attempt{problemAt(step), options};
      },
      first, search.step ? std::numeric_limits<double>::infinity() : search.shortest);
}

}  // namespace info::discover
