#include <cmath>

#include "discovery/search_once.h"
#include "info/discovery/search/needed_memory.h"
#include "info/discovery/search/shorter_steps.h"

namespace info::discover {
namespace {

constexpr int kMostRepeated = 2;

double meanSquare(const Verdict& verdict) {
  return (verdict.effects.empty() ? verdict.before : verdict.after).meanSquare;
}

// Whether the residual is much smaller than the noise that was estimated, as where errors of the
// model passed for correlated noise.
bool isOverestimated(const DiscoveryProblem& data, const Verdict& verdict, const Options& options) {
  if (options.sds || verdict.reached != Stage::finished) return false;
  if (!data.outputOfSample(0).empty()) return false;  // which output's?
  const double square = meanSquare(verdict);
  return square > 0 && square < options.overestimated &&
         std::sqrt(square) * verdict.sds.sd(0) > verdict.noise.quantum / std::sqrt(12.0);
}

}  // namespace

Verdict run(const DiscoveryProblem& data, const Options& options, WarmStart* draft) {
  const std::vector<int> trials = fittedTrials(data, options);
  requireMemory(data, trials, availableMemory());
  RecordedNoise noise;
  if (options.judgeSamples)
    noise = recordedNoise(data, trials, options.sds);
  else if (!options.sds)
    noise.sd = estimateOutputSd(data, trials);
  Verdict verdict = searchOnce(data, options, noise, draft);
  for (int i = 0; i < kMostRepeated && isOverestimated(data, verdict, options); ++i) {
    const double reduced = std::sqrt(meanSquare(verdict));
    noise.sd.value = noise.sd.value.scaled(reduced);
    noise.reduced *= reduced;
    Options other = options;
    other.progress = progressOfAnother(options.progress);
    if (draft != nullptr) draft->reset();  // its evidence is that of the other noise
    const int fits = verdict.fits;
    verdict = searchOnce(data, other, noise, draft);
    verdict.fits += fits;
  }
  return verdict;
}

}  // namespace info::discover
