#include "bio/discovery/workflow.h"

namespace bio::discover {
namespace {

using info::discover::Finding;
using info::discover::Stage;
using info::discover::SteppedVerdict;
using info::discover::Verdict;

SteppedVerdict search(const DiscoveryRequest& request, DiscoveryResult& result) {
  MusculoskeletalProblemOptions problem = request.problem;
  info::discover::Options options = request.search;
  options.heldOut.clear();
  for (std::size_t i = request.trials.size() - request.numHeldOut; i < request.trials.size(); ++i)
    options.heldOut.push_back(static_cast<int>(i));
  const auto attempt = [&](double step) {
    problem.simulation.step = step;
    result.data = std::make_unique<MusculoskeletalProblem>(
        request.model, request.arm, request.coordinate, request.trials, problem);
    return info::discover::Attempt{*result.data, options};
  };
  return info::discover::runAtShorterSteps(
      attempt, request.step.value_or(problem.simulation.step),
      request.step ? std::numeric_limits<double>::infinity() : shortestSearchStep);
}

/// The model that the verdict means, and the replays of the trials with it.
void repair(const DiscoveryRequest& request, DiscoveryResult& result) {
  const Verdict& verdict = result.found.verdict;
  const std::vector<int>& heldOut = result.found.options.heldOut;
  if (verdict.base.size() == 0) return;  // stopped before there was a model
  const auto repaired = [&](const MusculoskeletalProblem& data, const Verdict& of) {
    result.repaired = repairedModel(data, of, heldOut, request.step, request.provenance);
    result.trials = result.repaired->trials;
  };
  const auto effectOnly = [&](const MusculoskeletalProblem& data, const Verdict& of,
                              const std::vector<info::discover::FormulaTerm>& formula) {
    result.addsEffect = true;
    if (of.effects.empty()) return;
    result.effectOnly = addEffects(request.model, request.arm, request.coordinate,
                                   effectsToAdd(data, of), request.provenance, formula);
  };
  if (verdict.finding == Finding::unknown && verdict.formula && verdict.formula->wins) {
    const info::discover::RacedFormula& formula = *verdict.formula;
    const auto& data = dynamic_cast<const MusculoskeletalProblem&>(*formula.data);
    repaired(data, *formula.verdict);
    effectOnly(data, *formula.verdict, formula.terms);
  } else if (mayBeAdded(verdict)) {
    repaired(*result.data, verdict);
    effectOnly(*result.data, verdict, {});
  } else if (verdict.reached == Stage::finished && verdict.finding == Finding::none) {
    repaired(*result.data, verdict);
  } else {
    result.trials = recordedTrials(*result.data, verdict, heldOut, request.step);
  }
}

}  // namespace

DiscoveryResult discover(const DiscoveryRequest& request) {
  DiscoveryResult result;
  result.found = search(request, result);
  Verdict& verdict = result.found.verdict;
  const MusculoskeletalProblem& data = *result.data;
  repair(request, result);
  const std::vector<int>& heldOut = result.found.options.heldOut;
  if (!heldOut.empty()) result.shown = heldOut.front();
  for (const auto& effect : verdict.effects)
    result.sizes.push_back(effectSize(data, effect.candidate, verdict.values, result.shown));
  if (result.repaired) takeReplays(verdict, *result.repaired);
  result.fitted = fittedNumbers(data, verdict);
  if (verdict.reached == Stage::finished) {
    MusculoskeletalProblemOptions options = request.problem;
    options.simulation.step = data.options().simulation.step;
    result.experiments = predictExperiments(request.model, request.arm, request.trials.front(),
                                            options, data, verdict);
  }
  return result;
}

}  // namespace bio::discover
