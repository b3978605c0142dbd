#include "discovery/verdict.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace python {
namespace {

using info::discover::DiscoveryProblem;
using info::discover::Estimate;
using info::discover::ExcessError;
using info::discover::Verdict;

py::dict estimatesOf(const DiscoveryProblem& data, const std::vector<Estimate>& estimates) {
  py::dict all;
  for (const Estimate& estimate : estimates) {
    const auto& quantity = data.quantities()[estimate.quantity];
    all[quantity.name.c_str()] =
        results("value"_a = estimate.value, "sd"_a = estimate.sd, "unit"_a = quantity.unit);
  }
  return all;
}

py::object excessErrorOf(const ExcessError& excess) {
  return results("nominal"_a = excess.nominal, "calibrated"_a = excess.calibrated,
                 "after"_a = excess.after, "expected"_a = excess.expected,
                 "probability"_a = excess.probability, "noise_floor"_a = excess.floor,
                 "closed"_a = excess.closedFromCalibrated);
}

/// The unknown effect, and the formula that was compared for it.
py::object unknownOf(const DiscoveryProblem& data, const Verdict& verdict) {
  if (!verdict.unknown) return py::none();
  py::object raced = py::none();
  if (verdict.formula) {
    const info::discover::RacedFormula& race = *verdict.formula;
    py::list terms;
    for (std::size_t k = 0; k < race.values.size(); ++k)
      terms.append(results("expression"_a = race.terms[k].expression, "value"_a = race.values[k],
                           "sd"_a = race.sds[k]));
    raced = results("formula"_a = race.text, "wins"_a = race.wins, "terms"_a = terms,
                    "log_bayes_factor"_a = race.logBayesFactor,
                    "amplitude_over_sd"_a = race.significance, "adequate"_a = race.after.adequate(),
                    "gap"_a = excessErrorOf(race.excess),
                    "gap_held_out"_a = race.heldOut ? excessErrorOf(*race.heldOut) : py::none());
  }
  const info::discover::Unknown& unknown = *verdict.unknown;
  return results("axis"_a = data.axes()[unknown.axis].name, "formula"_a = unknown.formula,
                 "stable"_a = unknown.stable, "evidence"_a = unknown.evidence,
                 "explained"_a = unknown.explained, "peak_frequency"_a = unknown.peakFrequency,
                 "rms"_a = unknown.forceSize, "raced"_a = raced);
}

/// The best smooth force of the angle or the speed alone, beside the names.
py::object nonparametricForceOf(const DiscoveryProblem& data, const Verdict& verdict) {
  if (!verdict.nonparametric) return py::none();
  const info::discover::NonparametricForce& force = *verdict.nonparametric;
  std::vector<std::string> besides;
  for (const std::size_t c : force.besides) besides.push_back(data.candidates()[c].id);
  const info::discover::Axis& axis = data.axes()[force.axis];
  const bool isAngle =
      force.follows == info::discover::NonparametricForce::Follows::position && axis.unit == "rad";
  return results("axis"_a = axis.name,
                 "follows"_a = isAngle ? "angle" : info::discover::name(force.follows),
                 "beside"_a = besides, "log_bayes_factor"_a = force.logBayesFactor,
                 "nats_ahead_of_names"_a = force.ahead, "wins"_a = force.wins,
                 "at"_a = Eigen::VectorXd(Eigen::VectorXd::Map(
                     force.at.data(), static_cast<Eigen::Index>(force.at.size()))),
                 "force"_a = force.force, "sd"_a = force.sd);
}

py::object fittedOf(const std::vector<info::discover::FittedNumber>& fitted) {
  py::list list;
  for (const auto& one : fitted) {
    list.append(results("name"_a = one.name, "unit"_a = one.unit, "nominal"_a = one.nominal,
                        "estimate"_a = one.estimate, "sd"_a = one.sd, "prior_sd"_a = one.prior,
                        "prior_z"_a = one.priorZ));
  }
  return tableOfRows(list);
}

}  // namespace

info::discover::Options searchOptions(int maxEffects, std::optional<double> inputScatter) {
  info::discover::Options options;
  options.maxEffects = maxEffects;
  if (inputScatter) {
    if (!(*inputScatter >= 0) || !std::isfinite(*inputScatter))
      throw std::invalid_argument(
          fmt::format("input_scatter: {} must be a number ≥ 0", *inputScatter));
    options.latentTolerance = *inputScatter;
  }
  return options;
}

py::dict effectMembers(const DiscoveryProblem& data, const info::discover::NamedEffect& effect) {
  const auto& candidate = data.candidates()[effect.candidate];
  std::vector<std::string> rivals;
  for (const std::size_t c : effect.equals) rivals.push_back(data.candidates()[c].id);
  return py::dict("id"_a = candidate.id, "name"_a = candidate.name,
                  "kind"_a = info::discover::name(candidate.kind),
                  "parameters"_a = estimatesOf(data, effect.estimates),
                  "log_bayes_factor"_a = effect.logBayesFactor,
                  "probability"_a = effect.probability, "cannot_be_told_from"_a = rivals);
}

py::dict verdictMembers(const DiscoveryProblem& data, const info::discover::SteppedVerdict& found,
                        const std::vector<info::discover::FittedNumber>& fitted) {
  const Verdict& verdict = found.verdict;
  py::dict undetectable;
  for (const auto& one : verdict.detectability) {
    undetectable[data.candidates()[one.candidate].id.c_str()] = one.amplitude;
  }
  return py::dict(
      "verdict"_a = info::discover::name(verdict.finding), "sentence"_a = verdict.sentence,
      "surrogate"_a = verdict.surrogate, "probability_vetoed"_a = verdict.vetoed,
      "gap"_a = excessErrorOf(verdict.excess),
      "gap_held_out"_a = verdict.heldOut ? excessErrorOf(*verdict.heldOut) : py::none(),
      "held_out_fitted"_a = verdict.heldOutFitted,
      "replicated"_a = verdict.replication ? py::cast(verdict.replication->replicated) : py::none(),
      "undetectable_below"_a = undetectable, "unknown"_a = unknownOf(data, verdict),
      "force_without_a_name"_a = nonparametricForceOf(data, verdict),
      "fitted_parameters"_a = fittedOf(fitted), "step"_a = found.step, "fits"_a = verdict.fits);
}

}  // namespace python
