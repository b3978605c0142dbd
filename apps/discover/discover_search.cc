#include "discover/discover_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "options/number_rules.h"
#include "output/interruption.h"

namespace app {
namespace {

constexpr double longestLimit = 1e8;  // [s], three years: a clock's own range is not much longer

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

info::discover::Options engineOptions(int maxEffects, const std::optional<double>& inputScatter) {
  info::discover::Options options;
  options.maxEffects = maxEffects;
  if (inputScatter) {
    if (!(*inputScatter >= 0) || !std::isfinite(*inputScatter))
      throw std::invalid_argument(
          fmt::format("--input-scatter: {} must be a number ≥ 0", *inputScatter));
    options.latentTolerance = *inputScatter;
  }
  return options;
}

void addTimeLimit(CLI::App& options, std::optional<double>& limit) {
  options
      .add_option(
          "--time-limit", limit,
          "elapsed time after which the search ends with what it has (verdict 'stopped', exit "
          "status 1); default: none")
      ->check(positive())
      ->type_name("SECONDS");
}

WatchedSearch::WatchedSearch(bool quiet, const std::optional<double>& limit) {
  if (!quiet) bar_.emplace("discover");
  if (limit)
    end_ = std::chrono::steady_clock::now() +
           std::chrono::duration_cast<std::chrono::steady_clock::duration>(
               std::chrono::duration<double>(std::min(*limit, longestLimit)));
}

bool WatchedSearch::goesOn() {
  interrupted_ = interruptionRequested();
  outOfTime_ = end_ && std::chrono::steady_clock::now() > *end_;
  return !interrupted_ && !outOfTime_;
}

void WatchedSearch::watch(info::discover::Options& options) {
  options.goOn = [this] { return goesOn(); };
  options.progress = [this](const info::discover::Progress& progress) {
    const bool goesOn = this->goesOn();
    if (goesOn && bar_) bar_->update(progress.fraction);
    return goesOn;
  };
}

void warnOfOneTrial(Summary& summary, std::size_t training, std::size_t heldOut) {
  if (training != 1 || heldOut != 0) return;
  summary.warn(
      "one trial and none held out: whether the result holds for other motions is untested; add "
      "trials, or hold one out with --hold-out");
}

}  // namespace app
