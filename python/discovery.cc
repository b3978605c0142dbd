#include <cmath>
#include <optional>

#include "arms.h"
#include "bio/discover/elbow_disagreement.h"
#include "info/discover/shorter_steps.h"
#include "interruptible.h"

namespace python {
namespace {

using bio::discover::ElbowDisagreement;
using info::discover::Estimate;
using info::discover::Gap;
using info::discover::Verdict;

py::dict estimatesOf(const ElbowDisagreement& data, const std::vector<Estimate>& estimates) {
  py::dict all;
  for (const Estimate& one : estimates) {
    const auto& quantity = data.quantities()[one.quantity];
    all[quantity.name.c_str()] =
        results("value"_a = one.value, "sd"_a = one.deviation, "unit"_a = quantity.unit);
  }
  return all;
}

py::object effectOf(const ElbowDisagreement& data, const info::discover::NamedEffect& effect) {
  const auto& candidate = data.candidates()[effect.candidate];
  std::vector<std::string> rivals;
  for (const std::size_t c : effect.equals) rivals.push_back(data.candidates()[c].id);
  return results("id"_a = candidate.id, "name"_a = candidate.name,
                 "kind"_a = info::discover::name(candidate.kind),
                 "parameters"_a = estimatesOf(data, effect.estimates),
                 "log_bayes_factor"_a = effect.logBayesFactor, "probability"_a = effect.probability,
                 "cannot_be_told_from"_a = rivals);
}

py::object gapOf(const Gap& gap) {
  return results("nominal"_a = gap.nominal, "calibrated"_a = gap.calibrated, "after"_a = gap.after,
                 "noise_floor"_a = gap.floor, "closed"_a = gap.closedFromCalibrated);
}

py::object discover(const bio::Model& model, std::vector<bio::Trial> trials,
                    const std::vector<bio::Trial>& holdOut, std::optional<double> noise,
                    const std::vector<std::string>& without, int maxEffects,
                    const py::kwargs& keywords) {
  const ArmChoice choice = armChoice(keywords);
  if (choice.coordinates.size() != 1) {
    throw std::invalid_argument("coordinate: several are free; discover observes one");
  }
  info::discover::Options options;
  options.maxEffects = maxEffects;
  options.outputDeviation = noise;
  for (std::size_t i = 0; i < holdOut.size(); ++i) {
    options.heldOut.push_back(static_cast<int>(trials.size() + i));
  }
  trials.insert(trials.end(), holdOut.begin(), holdOut.end());
  bio::discover::ElbowOptions elbow;
  elbow.simulation = choice.simulation();
  elbow.simulation.duration = 1;
  elbow.without = without;
  std::unique_ptr<ElbowDisagreement> data;
  info::discover::SteppedVerdict found;
  interruptible([&](const std::atomic<bool>& goOn) {
    options.progress = [&](const info::discover::Progress&) { return goOn.load(); };
    const auto attempt = [&](double step) {
      elbow.simulation.step = step;
      data = std::make_unique<ElbowDisagreement>(model, choice.armOptions(),
                                                 choice.coordinates.front(), trials, elbow);
      return info::discover::Attempt{*data, options};
    };
    found = info::discover::runAtShorterSteps(
        attempt, elbow.simulation.step, choice.step ? HUGE_VAL : bio::discover::shortestSearchStep);
  });
  const Verdict& verdict = found.verdict;
  py::list effects;
  for (const auto& effect : verdict.effects) effects.append(effectOf(*data, effect));
  py::dict undetectable;
  for (const auto& one : verdict.detectability) {
    undetectable[data->candidates()[one.candidate].id.c_str()] = one.amplitude;
  }
  return results("verdict"_a = info::discover::name(verdict.finding),
                 "sentence"_a = verdict.sentence, "effects"_a = effects,
                 "surrogate"_a = verdict.surrogate, "probability_vetoed"_a = verdict.vetoed,
                 "noise"_a = verdict.outputDeviation, "gap"_a = gapOf(verdict.gap),
                 "gap_held_out"_a = verdict.heldOut ? gapOf(*verdict.heldOut) : py::none(),
                 "undetectable_below"_a = undetectable, "step"_a = found.step,
                 "fits"_a = verdict.fits);
}

}  // namespace

void defineDiscovery(py::module_& module) {
  module.def(
      "discover", &discover, "model"_a, "trials"_a, py::kw_only(),
      "hold_out"_a = std::vector<bio::Trial>(), "noise"_a = py::none(),
      "without"_a = std::vector<std::string>(), "max_effects"_a = 3,
      "What the model lacks: verdict ('named', 'ambiguous', 'parameter', 'none', 'unknown', "
      "'numerical'), sentence, effects (id, name, parameters, log_bayes_factor, probability, "
      "cannot_be_told_from), gap and gap_held_out [rad], undetectable_below {id: amplitude}. noise "
      "[rad]: from the data unless given. Further keywords as replay has them.");
}

}  // namespace python
