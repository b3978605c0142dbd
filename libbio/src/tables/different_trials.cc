#include "bio/tables/different_trials.h"

#include <fmt/format.h>

#include <stdexcept>

namespace bio {

void requireDifferentTrials(const std::vector<TrialIdentity>& trials, std::size_t training) {
  for (std::size_t i = 0; i < trials.size(); ++i) {
    for (std::size_t j = i + 1; j < trials.size(); ++j) {
      if (trials[i].sha256.empty() || trials[i].sha256 != trials[j].sha256) continue;
      const bool between = i < training && j >= training;
      throw std::invalid_argument(
          between ? fmt::format("{}: is held out and also used for estimation, as {}",
                                trials[j].file, trials[i].file)
                  : fmt::format("{}: is the same trial as {}", trials[j].file, trials[i].file));
    }
  }
}

void requireDifferentTrials(const std::vector<Trial>& training, const std::vector<Trial>& heldOut) {
  std::vector<TrialIdentity> all;
  for (const auto* trials : {&training, &heldOut})
    for (const Trial& trial : *trials) all.push_back({trial.file, trial.sha256});
  requireDifferentTrials(all, training.size());
}

}  // namespace bio
