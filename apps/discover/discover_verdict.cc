#include "discover/discover_verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibrate/fitted_table.h"
#include "discover/excess_error_text.h"
#include "discover/output_errors.h"
#include "discover/written_discovery.h"
#include "info/discovery/judgement/separation.h"
#include "info/discovery/likelihood/hypothesis.h"
#include "output/json_text.h"

namespace app {
namespace {

using info::discover::Estimate;
using info::discover::Score;
using nlohmann::ordered_json;

ordered_json parametersJson(const DiscoverFindings& f, const std::vector<Estimate>& estimates) {
  ordered_json parameters = ordered_json::object();
  for (const Estimate& estimate : estimates) {
    const auto& quantity = f.data.quantities()[estimate.quantity];
    parameters[quantity.name] = {
        {"value", orNull(estimate.value)}, {"sd", orNull(estimate.sd)}, {"unit", quantity.unit}};
  }
  return parameters;
}

ordered_json errorsJson(const DiscoverFindings& f, const info::discover::ExcessError& excess) {
  return excessErrorJson(excess, f.wording.unit, f.wording.errorEnd);
}

/// Names the axis that something belongs to, where there are several.
void addAxis(const DiscoverFindings& f, std::size_t axis, ordered_json& json) {
  if (f.wording.axes.size() > 1) json["axis"] = f.wording.axes.at(axis).name;
}

ordered_json localisationJson(const DiscoverFindings& f) {
  ordered_json json{{"time_spans", ordered_json::array()},
                    {"state_regions", ordered_json::array()},
                    {f.wording.inputs, ordered_json::array()}};
  const auto& map = f.verdict.localisation;
  for (const Score& score : map.times) {
    if (!score.significant) continue;
    json["time_spans"].push_back({{"trial", f.data.trialName(score.trial)},
                                  {"from_s", score.from},
                                  {"to_s", score.to},
                                  {"score", orNull(score.z)}});
    addAxis(f, score.axis, json["time_spans"].back());
  }
  for (const Score& score : map.cells) {
    if (!score.significant || !f.wording.hasMap) continue;
    const double unit = f.wording.axes.at(score.axis).scale;
    json["state_regions"].push_back({{"from", {unit * score.lowerQ, unit * score.lowerQDot}},
                                     {"to", {unit * score.upperQ, unit * score.upperQDot}},
                                     {"score", orNull(score.z)}});
    addAxis(f, score.axis, json["state_regions"].back());
  }
  for (const Score& score : map.inputs) {
    json[f.wording.inputs].push_back(
        {{"name", score.input}, {"score", orNull(score.z)}, {"significant", score.significant}});
    addAxis(f, score.axis, json[f.wording.inputs].back());
  }
  return json;
}

ordered_json adequacyJson(const info::discover::Adequacy& a, double latentSize) {
  ordered_json json = {{"mean_square", orNull(a.meanSquare)},
                       {"ljung_box_probability", orNull(a.ljungBoxProbability)},
                       {"input_probability", orNull(a.inputProbability)}};
  for (const info::discover::Cause cause : info::discover::kCauses)
    json[fmt::format("follows_{}_nats", name(cause))] = orNull(a.remainder.of(cause));
  json["latent_size"] = orNull(latentSize);
  json["adequate"] = a.adequate();
  return json;
}

/// Sizes of the effects in the motion shown, into their objects.
void addSizes(const DiscoverFindings& f, ordered_json& effects) {
  if (!f.written) return;
  const ShownAxis& axis = f.wording.axes.front();
  for (std::size_t i = 0; i < f.written->sizes.size(); ++i) {
    const bio::discover::EffectSize& size = f.written->sizes[i];
    effects[i]["along"] = f.data.trialName(f.written->shown);
    effects[i]["moment_rms_Nm"] = orNull(size.moment.rms);
    effects[i]["moment_peak_Nm"] = orNull(size.moment.peak);
    effects[i]["share_of_muscle_moment"] = orNull(size.moment.share);
    effects[i]["motion_rms" + axis.end()] = orNull(axis.scale * size.motionRms);
    if (f.wording.axes.size() == 1 || size.moments.empty()) continue;
    for (const ShownAxis& each : f.wording.axes) {
      const bio::discover::EffectMoment& moment = size.moments.at(each.place);
      effects[i]["moments"].push_back(
          {{"coordinate", each.name},
           {"rms", orNull(moment.rms)},
           {"peak", orNull(moment.peak)},
           {"share_of_muscle_moment", orNull(moment.share)},
           {"unit", each.forceUnit},
           {"motion_rms" + each.end(), orNull(each.scale * moment.motionRms)}});
    }
  }
}

/// The initial state of a trial's coordinate.
ordered_json startJson(const DiscoverFindings& f, const bio::TrialStart& start) {
  const auto& axes = f.wording.axes;
  const auto at = std::find_if(axes.begin(), axes.end(), [&](const ShownAxis& axis) {
    return axis.name == start.coordinate;
  });
  return {{"coordinate", start.coordinate},
          {"value", orNull(start.value)},
          {"speed", orNull(start.speed)},
          {"unit", at == axes.end() || at->isTorque ? "rad" : "m"}};
}

ordered_json trialsJson(const DiscoverFindings& f) {
  const double unit = f.wording.unit;
  const std::string& end = f.wording.errorEnd;
  ordered_json list = ordered_json::array();
  for (const bio::discover::RepairedTrial& trial : f.written->trials) {
    const std::size_t i = trial.index;
    ordered_json json{{"file", f.trialFiles[i]}, {"role", trial.isHeldOut ? "held_out" : "train"}};
    json["replay_file"] =
        f.written->model.empty() ? ordered_json(nullptr) : ordered_json(f.written->replayFiles[i]);
    json["rmse_nominal" + end] = orNull(unit * trial.nominal);
    json["rmse_after" + end] = orNull(unit * trial.after);
    json["noise_floor" + end] = orNull(unit * trial.floor);
    if (trial.starts.size() == 1) {
      json["start"] = startJson(f, trial.starts.front());
    } else {
      json["starts"] = ordered_json::array();
      for (const auto& start : trial.starts) json["starts"].push_back(startJson(f, start));
    }
    list.push_back(std::move(json));
  }
  return list;
}

/// The effects, and the ids of those that cannot be distinguished from them.
void addEffects(const DiscoverFindings& f, ordered_json& json) {
  const auto& candidates = f.data.candidates();
  const auto& verdict = f.verdict;
  json["effects"] = ordered_json::array();
  json["class"] = ordered_json::array();
  for (const auto& effect : verdict.effects) {
    const auto& candidate = candidates[effect.candidate];
    json["effects"].push_back({{"id", candidate.id},
                               {"name", candidate.name},
                               {"kind", info::discover::name(candidate.kind)},
                               {"surrogate", verdict.surrogate},
                               {"parameters", parametersJson(f, effect.estimates)},
                               {"log_bayes_factor", orNull(effect.logBayesFactor)},
                               {"probability", orNull(effect.probability)}});
    for (const Estimate& estimate : effect.estimates) {
      if (const auto at = f.wording.times.find(estimate.quantity); at != f.wording.times.end())
        json["effects"].back()[at->second] = orNull(estimate.value);
    }
    for (const std::size_t c : effect.equals) json["class"].push_back(candidates[c].id);
  }
}

void addInnovations(const info::discover::Verdict& verdict, ordered_json& json) {
  json["innovations"] = {{"before", nullptr}, {"after", nullptr}};
  if (verdict.base.size() > 0) {  // else stopped before there was a base model
    json["innovations"] = {{"before", adequacyJson(verdict.before, verdict.latentSizeBefore)},
                           {"after", adequacyJson(verdict.after, verdict.latentSizeAfter)}};
  }
  if (verdict.heldOutBefore && verdict.heldOutAfter) {
    json["innovations"]["held_out_mean_square"] = {
        {"before", orNull(verdict.heldOutBefore->meanSquare)},
        {"after", orNull(verdict.heldOutAfter->meanSquare)},
        {"highest", orNull(verdict.heldOutAfter->highest)}};
  }
}

/// The effects looked for in the held-out trials alone.
ordered_json replicationJson(const DiscoverFindings& f) {
  const info::discover::Replication& found = *f.verdict.replication;
  return {{"replicated", found.replicated},
          {"log_bayes_factor", orNull(found.logBayesFactor)},
          {"parameters", parametersJson(f, found.estimates)}};
}

ordered_json positionBreakJson(const DiscoverFindings& f) {
  const info::discover::PositionBreak& found = *f.written->positionBreak;
  const ShownAxis& axis = f.wording.axes.at(found.axis);
  ordered_json json{{"position" + axis.end(), orNull(axis.scale * found.position)},
                    {"side", found.above ? "above" : "below"},
                    {"force_before", orNull(found.before)},
                    {"force_beyond", orNull(found.beyond)},
                    {"z", orNull(found.z)},
                    {"trials_are_cut", f.written->trialsAreCut}};
  addAxis(f, found.axis, json);
  return json;
}

void addPlannedExperiments(const DiscoverFindings& f, ordered_json& json) {
  for (const bio::discover::PredictedExperiment& experiment : f.predictedExperiments) {
    ordered_json nats = ordered_json::object();
    for (std::size_t i = 0; i < experiment.nats.size(); ++i)
      nats[rivalName(f.data, f.verdict, i + 1)] = orNull(experiment.nats[i]);
    json["planned_experiments"].push_back({{"what", experiment.sentence},
                                           {"of", rivalName(f.data, f.verdict, 0)},
                                           {"expected_nats", nats}});
  }
}

ordered_json evidenceJson(const DiscoverFindings& f) {
  const auto& candidates = f.data.candidates();
  ordered_json list = ordered_json::array();
  for (const auto& finalist : f.verdict.finalists) {
    ordered_json ids = ordered_json::array();
    for (const std::size_t e : finalist.effects) ids.push_back(candidates[e].id);
    list.push_back({{"effects", ids},
                    {"log_bayes_factor", orNull(finalist.logEvidence)},
                    {"probability", orNull(finalist.probability)},
                    {"amplitude_over_sd", orNull(finalist.significance)}});
  }
  return list;
}

/// Ids of the effects that are in no hypothesis that was fitted.
ordered_json notRacedJson(const DiscoverFindings& f) {
  ordered_json ids = ordered_json::array();
  for (std::size_t c = 0; c < f.data.candidates().size(); ++c)
    if (std::none_of(f.verdict.finalists.begin(), f.verdict.finalists.end(),
                     [&](const auto& raced) {
                       return std::find(raced.effects.begin(), raced.effects.end(), c) !=
                              raced.effects.end();
                     }))
      ids.push_back(f.data.candidates()[c].id);
  return ids;
}

ordered_json nonparametricForceJson(const DiscoverFindings& f) {
  const info::discover::NonparametricForce& force = *f.verdict.nonparametric;
  ordered_json besides = ordered_json::array();
  for (const std::size_t c : force.besides) besides.push_back(f.data.candidates()[c].id);
  ordered_json json{{"follows", followedBy(f, force)},
                    {"beside", besides},
                    {"log_bayes_factor", orNull(force.logBayesFactor)},
                    {"nats_ahead_of_names", orNull(force.ahead)},
                    {"wins", force.wins}};
  addAxis(f, force.axis, json);
  return json;
}

/// The unknown effect, and the formula that was compared for it.
void addUnknown(const DiscoverFindings& f, ordered_json& json) {
  const auto& verdict = f.verdict;
  if (verdict.unknown) {
    json["unknown"] = {{"formula", verdict.unknown->formula},
                       {"stable", verdict.unknown->stable},
                       {"evidence_nats", orNull(verdict.unknown->evidence)},
                       {"explained", orNull(verdict.unknown->explained)},
                       {"peak_Hz", orNull(verdict.unknown->peakFrequency)},
                       {"same_in_every_trial", orNull(verdict.unknown->tie.share)},
                       {"step_at_s", orNull(verdict.unknown->tie.stepAt)},
                       {"step_explains", orNull(verdict.unknown->tie.stepShare)}};
    const ShownAxis& axis = f.wording.axes.at(verdict.unknown->axis);
    if (axis.isTorque) {
      json["unknown"]["rms_Nm"] = orNull(verdict.unknown->forceSize);
    } else {
      json["unknown"]["rms"] = orNull(verdict.unknown->forceSize);
      json["unknown"]["rms_unit"] = axis.forceUnit;
    }
    addAxis(f, verdict.unknown->axis, json["unknown"]);
  }
  if (verdict.formula) {
    const info::discover::RacedFormula& raced = *verdict.formula;
    ordered_json& race = json["unknown"]["raced"];
    race = {{"formula", raced.text},
            {"wins", raced.wins},
            {"log_bayes_factor", orNull(raced.logBayesFactor)},
            {"amplitude_over_sd", orNull(raced.significance)},
            {"adequate", raced.after.adequate()},
            {"terms", ordered_json::array()},
            {"gap",
             {{"train", errorsJson(f, raced.excess)},
              {"held_out", raced.heldOut ? errorsJson(f, *raced.heldOut) : nullptr}}}};
    for (std::size_t k = 0; k < raced.values.size(); ++k)
      race["terms"].push_back({{"expression", raced.terms[k].expression},
                               {"value", orNull(raced.values[k])},
                               {"sd", orNull(raced.sds[k])}});
    addAxis(f, raced.axis, race);
  }
}

/// Noise of the whole recording in one number, where there is one.
void tellNoise(const DiscoverFindings& f, Summary& summary) {
  const std::string& end = f.wording.errorEnd;
  if (end != "_deg" && end != "_m" && end != "_N") {
    summary.set("outputs", outputsJson(f));
  } else {
    const double noise = f.wording.unit * f.verdict.sds.sd(0);
    summary.set("noise", noise);
    summary.set("noise" + end, noise);
  }
  summary.set("noise_is", f.verdict.sdEstimated ? "from the data" : "given");
}

}  // namespace

std::string followedBy(const DiscoverFindings& f, const info::discover::NonparametricForce& force) {
  const bool isPosition = force.follows == info::discover::NonparametricForce::Follows::position;
  return isPosition ? f.wording.axes.at(force.axis).position : info::discover::name(force.follows);
}

void tellFindings(const DiscoverFindings& f, Summary& summary) {
  const auto& verdict = f.verdict;
  summary.set("verdict", verdictWord(verdict));
  tellNoise(f, summary);
  for (const auto& effect : verdict.effects) {
    const std::string id = f.data.candidates()[effect.candidate].id;
    summary.set("effect." + id, parametersJson(f, effect.estimates));
  }
  if (verdict.excess.closedFromCalibrated) {
    summary.set("gap_closed_train", *verdict.excess.closedFromCalibrated);
  }
  if (verdict.heldOut && verdict.heldOut->closedFromCalibrated) {
    summary.set("gap_closed_held_out", *verdict.heldOut->closedFromCalibrated);
  }
  summary.set("fits", verdict.fits);
  summary.set("search_wall_s", f.wallSeconds);
  summary.set("next_experiment", f.nextExperiment);
}

std::string verdictWord(const info::discover::Verdict& verdict) {
  return verdict.reached == info::discover::Stage::finished ||
                 verdict.finding == info::discover::Finding::numerical
             ? info::discover::name(verdict.finding)
             : "stopped";
}

ordered_json verdictJson(const DiscoverFindings& f) {
  const auto& verdict = f.verdict;
  ordered_json json;
  json["verdict"] = verdictWord(verdict);
  json["sentence"] = verdict.sentence;
  json["stage_reached"] = info::discover::name(verdict.reached);
  addEffects(f, json);
  addSizes(f, json["effects"]);
  json["localisation"] = localisationJson(f);
  json["gap"] = {{"train", errorsJson(f, verdict.excess)},
                 {"held_out", verdict.heldOut ? errorsJson(f, *verdict.heldOut) : nullptr}};
  json["held_out_fitted"] = verdict.heldOutFitted;
  if (verdict.replication) json["replication"] = replicationJson(f);
  if (f.written) {
    const bool isCorrected = !f.written->trials.empty() && f.written->trials.front().driven;
    json["rmse_after_is_of"] =
        isCorrected ? "the driven trials: inputs as they acted, sensor errors removed"
                    : "the recorded trials";
    json["model"] =
        f.written->model.empty() ? ordered_json(nullptr) : ordered_json(f.written->model);
    json["trials"] = trialsJson(f);
    const bio::discover::InputAgreement& inputs = f.written->inputs;
    json["input_agreement"] = {{"correlation", orNull(inputs.correlation)},
                               {"remedies", inputs.remedies},
                               {"remedied", orNull(inputs.remedied)}};
    if (f.written->positionBreak) json["position_break"] = positionBreakJson(f);
  }
  json["step_s"] = orNull(f.step);
  json["fitted_parameters"] = fittedJson(f.fitted);
  addInnovations(verdict, json);
  json["undetectable_below"] = ordered_json::object();
  for (const auto& one : verdict.detectability)
    json["undetectable_below"][f.data.candidates()[one.candidate].id] = orNull(one.amplitude);
  json["next_experiment"] = f.nextExperiment;
  addPlannedExperiments(f, json);
  json["noise_sd"] = orNull(verdict.sds.sd(0));
  if (f.written) json["outputs"] = outputsJson(f);
  json["samples"] = {{"recorded", verdict.noise.samples},
                     {"outliers", verdict.noise.outliers},
                     {"every", verdict.noise.spacing},
                     {"rounded_to", orNull(f.wording.unit * verdict.noise.quantum)},
                     {"noise_reduced_to", orNull(verdict.noise.reduced)}};
  json["noise_estimated"] = verdict.sdEstimated;
  json["wall_s"] = orNull(f.wallSeconds);
  json["processor_s"] = orNull(f.processorSeconds);
  json["probability_vetoed"] = verdict.vetoed;
  if (const auto& left = verdict.remainder) {
    json["remainder"] = {{"force_rms", orNull(left->size)},
                         {"unit", f.wording.axes.at(left->axis).forceUnit}};
    addAxis(f, left->axis, json["remainder"]);
  }
  json["numerical_error_in_noise_sd"] = orNull(verdict.numericalError);
  json["already_in_the_model"] = ordered_json::object();
  for (const auto& [id, where] : f.wording.present) json["already_in_the_model"][id] = where;
  json["evidence"] = evidenceJson(f);
  json["not_raced"] = notRacedJson(f);
  if (verdict.nonparametric) json["force_without_a_name"] = nonparametricForceJson(f);
  addUnknown(f, json);
  return json;
}

}  // namespace app
