#include "discover/discover_search.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "output/interruption.h"

namespace app {

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

WatchedSearch::WatchedSearch(bool quiet) {
  if (!quiet) bar_.emplace("discover");
}

std::function<bool(const info::discover::Progress&)> WatchedSearch::progress() {
  return [this](const info::discover::Progress& progress) {
    interrupted_ = interruptionRequested();
    if (!interrupted_ && bar_) bar_->update(progress.fraction);
    return !interrupted_;
  };
}

void warnOfOneTrial(Summary& summary, std::size_t training, std::size_t heldOut) {
  if (training != 1 || heldOut != 0) return;
  summary.warn(
      "one trial and none held out: whether the result holds for other motions is untested; add "
      "trials, or hold one out with --hold-out");
}

}  // namespace app
