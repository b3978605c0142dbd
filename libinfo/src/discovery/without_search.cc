#include "discovery/judgement/held_out_trials.h"
#include "discovery/likelihood/selected_samples.h"
#include "discovery/verdict_estimates.h"
#include "info/discovery/discover.h"

namespace info::discover {

Verdict withoutSearch(const DiscoveryProblem& data, const Options& options) {
  const std::vector<int> trials = fittedTrials(data, options);
  Verdict verdict;
  if (options.judgeSamples)
    verdict.noise = recordedNoise(data, trials, options.sds);
  else if (!options.sds)
    verdict.noise.sd = estimateOutputSd(data, trials);
  verdict.sds = options.sds ? *options.sds : verdict.noise.sd.value;
  verdict.sdEstimated = !options.sds;
  verdict.base = verdict.values = nominalValues(data);
  const Noise still{verdict.sds, 0, options.latentTime};
  const auto errorsOf = [&](const std::vector<int>& of) {
    ExcessError excess;
    excess.floor = verdict.sds.sd(0);
    excess.range = rangeOf(data, of, verdict.sds);
    excess.nominal = excess.calibrated = excess.after =
        nominalError(Likelihood(data, of, verdict.values, options.latentTime), still);
    explainExcess(excess);
    return excess;
  };
  verdict.excess = errorsOf(trials);
  if (!options.heldOut.empty()) verdict.heldOut = errorsOf(options.heldOut);
  verdict.finding = Finding::unknown;
  verdict.reached = Stage::finished;
  return verdict;
}

}  // namespace info::discover
