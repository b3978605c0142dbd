#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <variant>

#include "arguments/file_name.h"
#include "bio/discovery/effect_names.h"
#include "bio/discovery/effects.h"
#include "bio/discovery/workflow.h"
#include "bio/tables/different_trials.h"
#include "bio/tables/trial_table.h"
#include "discovery/verdict.h"
#include "docstrings.h"
#include "info/discovery/judgement/separation.h"
#include "info/version.h"
#include "interruptible.h"
#include "systems.h"
#include "trials/trials.h"

namespace python {
namespace {

using bio::discover::MusculoskeletalProblem;
using info::discover::Verdict;
using OwnEffects = std::vector<FileName>;

std::vector<bio::discover::UserEffect> effectsIn(const OwnEffects& files) {
  std::vector<std::string> names;
  for (const FileName& file : files) names.push_back(file.text);
  return bio::discover::readUserEffects(names);
}

py::object effectOf(const MusculoskeletalProblem& data, const info::discover::NamedEffect& effect,
                    const bio::discover::EffectSize& size) {
  return results(**effectMembers(data, effect), "moment_rms"_a = size.moment.rms,
                 "moment_peak"_a = size.moment.peak, "share_of_muscle_moment"_a = size.moment.share,
                 "motion_rms"_a = size.motionRms);
}

/// Experiments that could tell apart what these data cannot, the best first.
py::list plannedOf(const MusculoskeletalProblem& data, const Verdict& verdict,
                   const std::vector<bio::discover::PredictedExperiment>& predictedExperiments) {
  py::list planned;
  for (const auto& experiment : predictedExperiments) {
    py::dict nats;
    for (std::size_t i = 0; i < experiment.nats.size(); ++i)
      nats[rivalName(data, verdict, i + 1).c_str()] = experiment.nats[i];
    planned.append(results("what"_a = experiment.sentence, "of"_a = rivalName(data, verdict, 0),
                           "expected_nats"_a = nats));
  }
  return planned;
}

/// The model with all that was fitted, or None, and what replays of it give.
struct Written {
  py::object model = py::none();
  py::list trials;
};

Written writtenOf(bio::discover::DiscoveryResult& result) {
  Written written;
  for (const auto& one : result.trials) {
    const auto index = static_cast<int>(one.index);
    bio::Trial trial = result.data->trial(index);
    if (one.driven) {
      bio::Model& model = result.repaired->added.model;
      const std::string recorded = trial.sha256;
      trial.file += " (driven)";
      trial = bio::drivenTrial(*one.driven, trial, model);
      trial.sha256 = digestOf(py::bytes(recorded + " driven"));
      bio::addStarts(model, one, trial.file, trial.sha256);
    }
    const bool isOne = one.starts.size() == 1;
    py::list starts;
    for (const bio::TrialStart& start : one.starts)
      starts.append(results("coordinate"_a = start.coordinate, "value"_a = start.value,
                            "speed"_a = start.speed));
    written.trials.append(results(
        "name"_a = result.data->trialName(index), "role"_a = one.isHeldOut ? "held_out" : "train",
        "nominal"_a = one.nominal, "after"_a = one.after, "noise_floor"_a = one.floor,
        "start"_a = isOne ? py::cast(one.starts.front().value) : py::none(),
        "start_speed"_a = isOne ? py::cast(one.starts.front().speed) : py::none(),
        "starts"_a = starts, "trial"_a = trial));
  }
  if (result.repaired) written.model = py::cast(result.repaired->added.model);
  return written;
}

/// The coordinates in question: all free ones; where none is free, those that are prescribed and
/// whose moment the trials measure, or without trials all of them.
std::vector<std::string> inQuestion(const SystemChoice& choice,
                                    const std::vector<bio::Trial>& trials) {
  std::vector<std::string> names =
      bio::discover::coordinatesInQuestion(choice.coordinates, choice.prescribed, trials);
  if (names.empty())
    throw std::invalid_argument(
        "no coordinate is free, and no trial measures the moment of one that is prescribed: "
        "discover needs either");
  return names;
}

/// A number for all angles, or for the only output; or numbers by name.
using GivenNoise = std::variant<double, std::map<std::string, double>>;

info::discover::Whitening noiseOf(const GivenNoise& given, const bio::Model& model,
                                  const std::vector<bio::Observable>& outputs) {
  const double* ofAll = std::get_if<double>(&given);
  if (ofAll && outputs.size() == 1) return *ofAll;
  std::map<std::string, double> byName;
  if (!ofAll) byName = std::get<std::map<std::string, double>>(given);
  Eigen::VectorXd sds(static_cast<Eigen::Index>(outputs.size()));
  for (std::size_t o = 0; o < outputs.size(); ++o) {
    const std::string name = bio::nameOf(outputs[o]);
    const auto own = byName.find(name);
    if (own == byName.end() && !(ofAll && bio::unitOf(outputs[o], model) == "rad"))
      throw std::invalid_argument(
          fmt::format("noise: that of '{}' is not given, must be given for all that is measured, "
                      "or for nothing",
                      name));
    const double sd = own == byName.end() ? *ofAll : own->second;
    if (!(sd > 0))
      throw std::invalid_argument(fmt::format("noise: {} = {}, must be > 0", name, sd));
    sds[static_cast<Eigen::Index>(o)] = sd;
    if (own != byName.end()) byName.erase(own);
  }
  if (!byName.empty())
    throw std::invalid_argument(
        fmt::format("noise: '{}' is not measured and in question", byName.begin()->first));
  return info::discover::Whitening(std::move(sds));
}

py::list outputsOf(const MusculoskeletalProblem& data, const Verdict& verdict) {
  py::list outputs;
  const bio::discover::EncompassingModel& model = data.encompassing();
  for (std::size_t o = 0; o < model.sensors().size(); ++o)
    outputs.append(results("name"_a = bio::nameOf(model.sensors()[o]),
                           "unit"_a = bio::unitOf(model.sensors()[o], model.base()),
                           "noise"_a = verdict.sds.sd(o)));
  return outputs;
}

py::object listEffects(const bio::Model& model, const Names& coordinate,
                       const std::map<std::string, double>& lock, const OwnEffects& own) {
  const SystemChoice choice = systemChoice(model, {}, coordinate, lock, "vi", {});
  std::optional<bio::discover::EncompassingModel> encompassing;
  const bio::discover::CoordinateNames coordinates = inQuestion(choice, {});
  const bio::discover::CatalogueChoice catalogue{
      .own = effectsIn(own), .drives = bio::discover::possibleCommands(coordinates.all)};
  interruptible([&](const std::atomic<bool>&) {
    encompassing.emplace(
        bio::discover::encompassingModel(model, choice.systemOptions(), coordinates, catalogue));
  });
  py::list effects;
  for (const info::discover::Candidate& candidate : encompassing->candidates()) {
    py::dict parameters;
    for (const std::size_t k : candidate.quantities) {
      const info::discover::Quantity& quantity = encompassing->quantities()[k];
      parameters[quantity.name.c_str()] = quantity.unit;
    }
    effects.append(
        results("id"_a = candidate.id, "long_id"_a = bio::discover::effectLongName(candidate.id),
                "name"_a = candidate.name, "kind"_a = info::discover::name(candidate.kind),
                "meaning"_a = candidate.sentence, "parameters"_a = parameters,
                "equivalents"_a = candidate.equivalents));
  }
  return tableResult("EffectList", "effects"_a = effects, "present"_a = encompassing->present());
}

py::object discover(const bio::Model& model, std::vector<bio::Trial> trials,
                    const std::vector<bio::Trial>& holdOut, const std::optional<GivenNoise>& noise,
                    const std::vector<std::string>& without, const OwnEffects& own, int maxEffects,
                    std::optional<double> inputScatter,
                    const std::map<std::string, double>& initial, const py::object& progress,
                    const Names& coordinate, const std::map<std::string, double>& lock,
                    const std::string& integrator, std::optional<double> firstStep) {
  const SystemChoice choice = systemChoice(model, trials, coordinate, lock, integrator, firstStep);
  bio::requireDifferentTrials(trials, holdOut);
  trials.insert(trials.end(), holdOut.begin(), holdOut.end());
  const std::vector<std::string> coordinates = inQuestion(choice, trials);
  const std::vector<bio::Observable> outputs =
      bio::discover::measuredOutputs(trials, choice.systemOptions(), coordinates);
  bio::discover::DiscoveryRequest asked{model,
                                        choice.systemOptions(),
                                        coordinates,
                                        std::move(trials),
                                        holdOut.size(),
                                        choice.step,
                                        {},
                                        {},
                                        {}};
  asked.problem.simulation = choice.simulation();
  asked.problem.simulation.duration = 1;
  asked.problem.initial = initial;
  asked.problem.without = without;
  asked.problem.own = effectsIn(own);
  asked.search = searchOptions(maxEffects, inputScatter);
  asked.problem.sensors = outputs;
  if (noise) asked.search.sds = noiseOf(*noise, model, outputs);
  asked.provenance.tool = "fisherhill " + std::string(info::version());
  for (const bio::Trial& trial : asked.trials)
    asked.provenance.data.push_back(fmt::format("{} SHA-256 {}", trial.file, trial.sha256));
  bio::discover::DiscoveryResult result;
  interruptible({progress, "discover"}, [&](const auto& goOn, auto& done) {
    asked.search.goOn = [&] { return goOn.load(); };
    asked.search.progress = [&](const info::discover::Progress& at) {
      return noting(goOn, done)(at.fraction);
    };
    result = bio::discover::discover(asked);
  });
  const MusculoskeletalProblem& data = *result.data;
  const info::discover::SteppedVerdict& found = result.found;
  const Verdict& verdict = found.verdict;
  const Written written = writtenOf(result);
  py::list effects;
  for (std::size_t i = 0; i < verdict.effects.size(); ++i)
    effects.append(effectOf(data, verdict.effects[i], result.sizes[i]));
  return tableResult(
      "DiscoveryResult", **verdictMembers(data, found, result.fitted), "effects"_a = effects,
      "noise"_a = verdict.sds.sd(0), "outputs"_a = outputsOf(data, verdict),
      "input_correlation"_a = result.inputs.correlation, "remedies"_a = result.inputs.remedies,
      "position_break"_a =
          result.positionBreak ? py::cast(result.positionBreak->position) : py::none(),
      "trials_are_cut"_a = result.trialsAreCut,
      "planned_experiments"_a = plannedOf(data, verdict, result.experiments),
      "model"_a = written.model, "trials"_a = written.trials);
}

}  // namespace

void defineDiscovery(py::module_& module) {
  module.def("list_effects", &listEffects, "model"_a, py::kw_only(),
             "coordinate"_a = std::vector<std::string>(),
             "lock"_a = std::map<std::string, double>(), "effects"_a = std::vector<FileName>(),
             docstrings::list_effects);
  defineWithChoice(module, "discover", &discover, docstrings::discover, "model"_a, "trials"_a,
                   py::kw_only(), "hold_out"_a = std::vector<bio::Trial>(), "noise"_a = py::none(),
                   "without"_a = std::vector<std::string>(), "effects"_a = std::vector<FileName>(),
                   "max_effects"_a = 3, "input_scatter"_a = py::none(),
                   "initial"_a = std::map<std::string, double>(), "progress"_a = false);
}

}  // namespace python
