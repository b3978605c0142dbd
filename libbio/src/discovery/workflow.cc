#include "bio/discovery/workflow.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "bio/model/units.h"
#include "discovery/first_part.h"

namespace bio::discover {
namespace {

using info::discover::Finding;
using info::discover::Stage;
using info::discover::SteppedVerdict;
using info::discover::Verdict;

SteppedVerdict search(const DiscoveryRequest& request, const std::vector<Trial>& trials,
                      DiscoveryResult& result) {
  MusculoskeletalProblemOptions problem = request.problem;
  problem.trialsAreCut = result.trialsAreCut;
  info::discover::Options options = request.search;
  if (result.trialsAreCut)
    options.progress = info::discover::progressOfAnother(std::move(options.progress));
  const info::discover::TrialSearch asked{
      request.trials.size(),          request.numHeldOut, request.step,
      problem.simulation.step,        shortestSearchStep, options,
      !result.inputs.remedies.empty()};
  return info::discover::searchTrials(
      asked, [&](double step) -> const info::discover::DiscoveryProblem& {
        problem.simulation.step = step;
        result.data = std::make_unique<MusculoskeletalProblem>(
            request.model, request.system, request.coordinates, trials, problem);
        return *result.data;
      });
}

std::string sentenceOf(const info::discover::PositionBreak& found, const Coordinate& coordinate,
                       bool trialsAreCut) {
  const ShownUnit unit = positionUnit(coordinate.isRotation);
  const std::string where =
      fmt::format("{} = {:.0f} {}", coordinate.name, unit.factor * found.position, unit.name);
  return fmt::format(
      " {} {} the model lacks a {} of {:.2g} {} at once, as where a muscle's path jumps{}",
      found.above ? "Above" : "Below", where, coordinate.isRotation ? "torque" : "force",
      found.beyond - found.before, coordinate.isRotation ? "N m" : "N",
      trialsAreCut ? "; the trials were used up to where they first pass it." : ".");
}

/// An error of all outputs together, as people read it.
std::string errorText(const MusculoskeletalProblem& data, const Verdict& verdict, double error) {
  const auto& sensors = data.encompassing().sensors();
  if (sensors.size() > 1) return fmt::format("{:.2g} times the noise", error / verdict.sds.sd(0));
  const std::string unit = unitOf(sensors.front(), data.encompassing().base());
  if (unit == "rad" || unit == "m") {
    const ShownUnit shown = positionUnit(unit == "rad");
    return fmt::format("{:.2g} {}", shown.factor * error, shown.name);
  }
  return fmt::format("{:.2g} {}", error, unit);
}

/// What refitting the model's own parameters did where nothing is missing; empty unless it more
/// than halved the error.
std::string refitSentence(const MusculoskeletalProblem& data, const Verdict& verdict,
                          const std::vector<info::discover::FittedNumber>& fitted) {
  const info::discover::ExcessError& excess = verdict.excess;
  if (verdict.finding != Finding::none || verdict.reached != Stage::finished) return {};
  if (!(excess.nominal > 2 * excess.after)) return {};
  const auto& quantities = data.quantities();
  const info::discover::Estimate* most = nullptr;
  for (const info::discover::Estimate& e : verdict.nuisancesAfter)
    if (quantities[e.quantity].trial < 0 && (!most || e.moves > most->moves)) most = &e;
  if (!most) return {};
  const auto number = std::find_if(fitted.begin(), fitted.end(), [&](const auto& each) {
    return each.quantity == most->quantity;
  });
  const std::string before =
      std::isfinite(excess.nominal)
          ? fmt::format("With its nominal parameters the model is {} off",
                        errorText(data, verdict, excess.nominal))
          : std::string("With its nominal parameters the model does not follow the trials");
  return fmt::format(" {}, with refitted ones {}, mostly by {} {:+.0f} %.", before,
                     errorText(data, verdict, excess.after), number->name,
                     100 * (number->estimate / number->nominal - 1));
}

/// What is left where effects are named although the residual is not noise.
std::string remainderSentence(const MusculoskeletalProblem& data, const Verdict& verdict) {
  if (!verdict.remainder || !std::isfinite(verdict.heldOut->after)) return {};
  const info::discover::ExcessError& error = *verdict.heldOut;
  const auto& axis = data.encompassing().coordinates().at(verdict.remainder->axis).coordinate;
  return fmt::format(
      " The held-out error falls from {} to {}, with {} of noise; left is a {} of {:.2g} {} "
      "(root mean square) on {}.",
      errorText(data, verdict, error.calibrated), errorText(data, verdict, error.after),
      errorText(data, verdict, error.floor), axis.isRotation ? "moment" : "force",
      verdict.remainder->size, axis.isRotation ? "N m" : "N", axis.name);
}

/// The trials up to a break; empty if one of them is too short then.
std::vector<Trial> partsBefore(const DiscoveryRequest& request,
                               const info::discover::PositionBreak& found) {
  const double end = found.position + (found.above ? -1 : 1) * found.margin;
  std::vector<Trial> parts;
  for (const Trial& trial : request.trials) {
    auto part = firstPart(trial, request.coordinates.all.at(found.axis), end, found.above);
    if (!part) return {};
    parts.push_back(std::move(*part));
  }
  return parts;
}

/// An unknown effect may be a model that fails in a part of the range only.
void searchBeforeBreak(const DiscoveryRequest& request, DiscoveryResult& result) {
  Verdict& verdict = result.found.verdict;
  if (verdict.finding != Finding::unknown || verdict.reached != Stage::finished) return;
  result.positionBreak = info::discover::positionBreak(*result.data, result.found.options, verdict);
  if (!result.positionBreak) return;
  if (const std::vector<Trial> parts = partsBefore(request, *result.positionBreak);
      !parts.empty()) {
    DiscoveryResult second;
    second.trialsAreCut = true;
    second.inputs = result.inputs;
    second.found = search(request, parts, second);
    Verdict& other = second.found.verdict;
    const int fits = verdict.fits + other.fits;
    if (mayBeAdded(other)) {
      other.vetoed = true;
      other.probability = 0;
      second.positionBreak = result.positionBreak;
      result = std::move(second);
    }
    result.found.verdict.fits = fits;
  }
  result.found.verdict.sentence += sentenceOf(
      *result.positionBreak,
      result.data->encompassing().coordinates().at(result.positionBreak->axis).coordinate,
      result.trialsAreCut);
}

/// The model that the verdict means, and the replays of the trials with it.
void repair(const DiscoveryRequest& request, DiscoveryResult& result) {
  const Verdict& verdict = result.found.verdict;
  const std::vector<int>& heldOut = result.found.options.heldOut;
  if (verdict.base.size() == 0) return;  // stopped before there was a model
  const auto repaired = [&](const MusculoskeletalProblem& data, const Verdict& found) {
    result.repaired = repairedModel(data, found, heldOut, request.step, request.provenance);
    result.trials = result.repaired->trials;
  };
  const auto effectOnly = [&](const MusculoskeletalProblem& data, const Verdict& found) {
    result.addsEffect = true;
    if (found.effects.empty()) return;
    result.effectOnly =
        addEffects(data.encompassing(), effectsToAdd(data, found), request.provenance);
  };
  if (verdict.finding == Finding::unknown && verdict.formula && verdict.formula->wins) {
    const info::discover::RacedFormula& formula = *verdict.formula;
    const auto& data = dynamic_cast<const MusculoskeletalProblem&>(*formula.data);
    repaired(data, *formula.verdict);
    effectOnly(data, *formula.verdict);
  } else if (mayBeAdded(verdict)) {
    repaired(*result.data, verdict);
    effectOnly(*result.data, verdict);
  } else if (verdict.reached == Stage::finished &&
             (verdict.finding == Finding::none || !verdict.effects.empty())) {
    result.addsEffect = !verdict.effects.empty();
    repaired(*result.data, verdict);
  } else {
    result.trials = recordedTrials(*result.data, verdict, heldOut, request.step);
  }
}

/// No search where the recording contradicts itself: every effect would be one that imitates that.
void searchUnlessContradicted(const DiscoveryRequest& request, DiscoveryResult& result) {
  const info::discover::Options& options = request.search;
  const auto goOn = [&] {
    return (!options.goOn || options.goOn()) &&
           (!options.progress || options.progress({Stage::calibrate, 0, "excitations and motion"}));
  };
  result.inputs =
      inputAgreement(request.model, request.system, request.coordinates, request.trials, goOn);
  const InputAgreement& inputs = result.inputs;
  result.found = search(request, request.trials, result);
  Verdict& verdict = result.found.verdict;
  if (!inputs.remedies.empty()) {
    verdict.sentence = fmt::format(
        "The recording contradicts itself: the moments of the muscles do not follow those that the "
        "motion requires (correlation {:.2f}), but they do ({:.2f}) if {}. No effect was looked "
        "for.",
        inputs.correlation, inputs.remedied, fmt::join(inputs.remedies, ", or "));
    return;
  }
  searchBeforeBreak(request, result);
}

/// The agreement of the excitations as the muscles of the repaired model receive them, e.g. with
/// channels exchanged back; NaN if they are those that were recorded.
double correlationAfter(const DiscoveryRequest& request, const DiscoveryResult& result) {
  if (!result.repaired) return NAN;
  const Model& model = result.repaired->added.model;
  std::vector<Trial> driven;
  for (const RepairedTrial& one : result.repaired->trials)
    if (one.driven)
      driven.push_back(
          drivenTrial(*one.driven, result.data->trial(static_cast<int>(one.index)), model));
  if (driven.empty()) return NAN;
  return inputAgreement(model, request.system, request.coordinates, driven, [] { return false; })
      .correlation;
}

/// No name is believed whose excitations have nothing to do with the motion, unless it is what
/// explains that.
void doubtUnrelated(const DiscoveryRequest& request, DiscoveryResult& result) {
  const InputAgreement& inputs = result.inputs;
  Verdict& verdict = result.found.verdict;
  if (!(inputs.correlation < InputAgreement::unrelated) || !mayBeAdded(verdict)) return;
  if (correlationAfter(request, result) >= InputAgreement::largeEnough) return;
  verdict.vetoed = true;
  verdict.probability = 0;
  verdict.sentence += fmt::format(
      " But the muscles' moments are unrelated to those that the motion requires (correlation "
      "{:.2f}): are the excitations of this trial, this side and these muscles?",
      inputs.correlation);
  repair(request, result);  // its credits give no probability then
}

}  // namespace

DiscoveryResult discover(const DiscoveryRequest& request) {
  DiscoveryResult result;
  const info::discover::SearchClock clock;
  searchUnlessContradicted(request, result);
  clock.writeTo(result.found);
  Verdict& verdict = result.found.verdict;
  const MusculoskeletalProblem& data = *result.data;
  repair(request, result);
  doubtUnrelated(request, result);
  const std::vector<int>& heldOut = result.found.options.heldOut;
  if (!heldOut.empty()) result.shown = heldOut.front();
  for (const auto& effect : verdict.effects)
    result.sizes.push_back(effectSize(data, effect.candidate, verdict.values, result.shown));
  if (result.repaired) takeReplays(verdict, *result.repaired);
  result.fitted = fittedNumbers(data, verdict);
  verdict.sentence += refitSentence(data, verdict, result.fitted);
  verdict.sentence += remainderSentence(data, verdict);
  if (verdict.reached == Stage::finished)
    result.experiments = predictExperiments(data.trial(0), data, verdict);
  return result;
}

}  // namespace bio::discover
