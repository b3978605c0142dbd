#include "bio/discovery/repaired.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bio/analysis/replay.h"
#include "bio/discovery/with_experimental_conditions.h"
#include "info/dynamics/linear_table.h"

namespace bio::discover {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using info::discover::FittedNumber;
using info::discover::Verdict;

/// Replays are of the paths themselves.
SystemOptions withoutTables(const MusculoskeletalProblem& data) {
  SystemOptions system = data.encompassing().systemOptions();
  system.tabulatePaths = false;
  return system;
}

VectorXd ownValues(const MusculoskeletalProblem& data, const VectorXd& values) {
  return values.head(static_cast<Index>(data.encompassing().quantities().size()));
}

/// EMG, drive, sensor or a muscle that was switched on: what a model file cannot hold.
bool concernsTrials(const Augmented& added) {
  const EmgMapping& m = added.mapping;
  return !added.muscles.empty() || !added.drives.empty() || !m.gain.empty() || m.delay != 0 ||
         m.nonlinearity != 0 || !m.offset.empty() || !m.crosstalk.empty() ||
         !m.saturation.empty() || m.fatigue != 0 ||
         std::any_of(added.sensors.begin(), added.sensors.end(),
                     [](const SensorLaw& sensor) { return !sensor.isTrue(); });
}

/// The trial with forces on one coordinate that begin or end, as if they were known from outside.
Trial withTimedForce(Trial trial, const std::string& coordinate, const std::vector<double>& nodes,
                     const VectorXd& force) {
  if (force.isZero(0)) return trial;
  const auto known = std::find_if(trial.applied.begin(), trial.applied.end(),
                                  [&](const auto& one) { return one.coordinate == coordinate; });
  AppliedForce& applied = known != trial.applied.end()
                              ? *known
                              : trial.applied.emplace_back(
                                    AppliedForce{coordinate, VectorXd::Zero(trial.times.size())});
  for (Index i = 0; i < trial.times.size(); ++i) {
    applied.values[i] += info::linearAt(nodes, trial.times[i]).value(force);
  }
  trial.sha256.clear();  // it is not what is in the file
  return trial;
}

struct Compared {
  double rms = RepairedTrial::none;
  Index samples = 0;
};

/// The error of one output in its unit; of several, in σ times the σ of the first.
Compared pooled(const std::vector<Observable>& outputs, const TrialReplay& replay,
                const info::discover::Whitening& noise) {
  double squares = 0;
  Compared all{0, 0};
  const auto add = [&](const Observable& what, const MeasuredError& error) {
    const auto at = std::find(outputs.begin(), outputs.end(), what);
    if (at == outputs.end()) return;
    if (outputs.size() == 1) {
      all = {error.rms, error.count};
      return;
    }
    const double scale = noise.sd(0) / noise.sd(static_cast<std::size_t>(at - outputs.begin()));
    squares += static_cast<double>(error.count) * std::pow(scale * error.rms, 2);
    all.samples += error.count;
    all.rms = std::sqrt(squares / static_cast<double>(all.samples));
  };
  for (const auto& [name, error] : replay.errors) add(ofCoordinate(name), error);
  for (const ChannelError& error : replay.channelErrors) add(error.what, error.error);
  return all.samples > 0 ? all : Compared{};
}

/// Nothing where the replay does not reach the end.
Compared replayed(const MusculoskeletalProblem& data, const Model& model, const Trial& trial,
                  double step, const std::vector<TrialStart>& starts,
                  const info::discover::Whitening& noise) {
  const SystemOptions options = withoutTables(data);
  try {
    const MusculoskeletalSystem system(
        withExperimentalConditions(model, options, data.encompassing().coordinateNames(), trial),
        options);
    SimulationOptions simulation = data.options().simulation;
    simulation.step = step;
    simulation.progress = {};
    StartPoint point = beginningOf(trial, model, system, data.options().initial).point;
    for (const TrialStart& start : starts) {
      point.q[system.skeleton().indexOf(start.coordinate)] = start.value;
      point.qDot[system.skeleton().indexOf(start.coordinate)] = start.speed;
    }
    if (const auto replay = completeReplay(system, trial, simulation, point))
      return pooled(data.encompassing().sensors(), *replay, noise);
  } catch (const std::exception&) {
    // no system can be made of it
  }
  return {};
}

std::string creditsOf(const MusculoskeletalProblem& data, const Verdict& verdict,
                      const EffectProvenance& provenance, const std::string& effects) {
  std::string credits = effects;
  if (credits.empty()) {
    credits = "Fitted by " + provenance.tool;
    for (std::size_t i = 0; i < provenance.data.size(); ++i)
      credits += (i ? ", " : " to ") + provenance.data[i];
  }
  const auto numbers = fittedNumbers(data, verdict);
  if (!mayBeAdded(verdict) || verdict.vetoed)
    credits += "; with the reservation: " + verdict.sentence;
  return credits + "; together with them " + std::to_string(numbers.size()) +
         " values in total were fitted, listed in parameters.csv";
}

}  // namespace

std::vector<EffectToAdd> effectsToAdd(const MusculoskeletalProblem& data, const Verdict& verdict) {
  std::vector<EffectToAdd> effects;
  for (const auto& found : verdict.effects) {
    EffectToAdd effect;
    effect.id = data.candidates()[found.candidate].id;
    const auto n = static_cast<Index>(found.estimates.size());
    effect.values.resize(n);
    effect.sds.resize(n);
    for (Index i = 0; i < n; ++i) {
      effect.values[i] = found.estimates[static_cast<std::size_t>(i)].value;
      effect.sds[i] = found.estimates[static_cast<std::size_t>(i)].sd;
    }
    effect.logBayesFactor = found.logBayesFactor;
    effect.probability = verdict.vetoed || verdict.surrogate ? 0 : found.probability;
    effects.push_back(std::move(effect));
  }
  return effects;
}

std::vector<RepairedTrial> recordedTrials(const MusculoskeletalProblem& data,
                                          const Verdict& verdict, const std::vector<int>& heldOut,
                                          const std::optional<double>& step) {
  const Model& base = data.encompassing().base();
  const double nominalStep = stepOf(base, data.options().simulation.integrator, step);
  std::vector<RepairedTrial> trials;
  for (int i = 0; i < data.numTrials(); ++i) {
    RepairedTrial trial;
    trial.index = static_cast<std::size_t>(i);
    trial.isHeldOut = std::find(heldOut.begin(), heldOut.end(), i) != heldOut.end();
    trial.starts = data.startsAt(i, verdict.values);
    const Compared nominal = replayed(data, base, data.trial(i), nominalStep, {}, verdict.sds);
    trial.nominal = nominal.rms;
    trial.samples = nominal.samples > 0 ? nominal.samples : data.measured(i).size();
    trial.floor = verdict.sds.sd(0);
    VectorXd difference = data.outputs(i, verdict.values, {}) - data.measured(i);
    if (data.encompassing().sensors().size() > 1) {
      verdict.sds.whiten(data.outputOfSample(i), difference);
      difference *= verdict.sds.sd(0);
    }
    trial.fitted = std::sqrt(difference.squaredNorm() / static_cast<double>(difference.size()));
    trials.push_back(std::move(trial));
  }
  return trials;
}

Repaired repairedModel(const MusculoskeletalProblem& data, const Verdict& verdict,
                       const std::vector<int>& heldOut, const std::optional<double>& step,
                       const EffectProvenance& provenance) {
  Repaired result{augmentedModel(data.encompassing(), ownValues(data, verdict.values)),
                  recordedTrials(data, verdict, heldOut, step)};
  Model& model = result.added.model;
  const std::vector<Observable>& outputs = data.encompassing().sensors();
  std::string effects;
  if (!verdict.effects.empty())
    effects = effectCredits(data.encompassing(), effectsToAdd(data, verdict), provenance);
  const std::string credits = creditsOf(data, verdict, provenance, effects);
  model.credits += model.credits.empty() ? credits : ". " + credits;
  model.fitted = {data.options().simulation.step, {}};
  const bool isDriven = data.options().trialsAreCut || concernsTrials(result.added) ||
                        data.timedForce(0, verdict.values).size() > 0;
  const MusculoskeletalSystem system(model, withoutTables(data));
  for (RepairedTrial& one : result.trials) {
    const auto index = static_cast<int>(one.index);
    Trial trial = data.trial(index);
    addStarts(model, one, trial.file, trial.sha256);
    if (isDriven) {
      trial = withDrives(std::move(trial), result.added.drives);
      if (const VectorXd force = data.timedForce(index, verdict.values); force.size() > 0) {
        const std::vector<double> nodes = info::discover::nodeTimes(data, index);
        const auto n = static_cast<Index>(nodes.size());
        const std::vector<std::string> names = data.encompassing().coordinateNames();
        for (std::size_t axis = 0; axis < names.size(); ++axis)
          trial = withTimedForce(std::move(trial), names[axis], nodes,
                                 force.segment(static_cast<Index>(axis) * n, n));
      }
      for (std::size_t i = 0; i < outputs.size(); ++i)
        trial = asTrueSensor(std::move(trial), outputs[i], result.added.sensors[i]);
      one.driven = drivenTable(trial, system, result.added.mapping);
      trial = drivenTrial(*one.driven, trial, model);
      if (outputs.size() == 1) one.floor /= 1 + result.added.sensors.front().gain;
    }
    const Compared after =
        replayed(data, model, trial, data.options().simulation.step, one.starts, verdict.sds);
    one.after = after.rms;
    if (after.samples > 0) one.samples = after.samples;
  }
  return result;
}

void takeReplays(Verdict& verdict, const Repaired& repaired) {
  // what a gap compares is what the sensor shows
  const std::vector<SensorLaw>& sensors = repaired.added.sensors;
  const double shown = sensors.size() == 1 ? 1 + sensors.front().gain : 1;
  const auto take = [&](info::discover::ExcessError& excess, bool heldOut) {
    excess.nominal = pooledRms(repaired.trials, &RepairedTrial::nominal, heldOut);
    excess.after = shown * pooledRms(repaired.trials, &RepairedTrial::after, heldOut);
    explainExcess(excess);
    excess.after /= shown;
  };
  take(verdict.excess, false);
  if (verdict.heldOut) take(*verdict.heldOut, true);
}

std::vector<FittedNumber> fittedNumbers(const MusculoskeletalProblem& data,
                                        const Verdict& verdict) {
  std::vector<FittedNumber> numbers = info::discover::fittedNumbers(data, verdict);
  const EncompassingModel& encompassing = data.encompassing();
  for (FittedNumber& number : numbers) {
    if (number.quantity >= encompassing.quantities().size()) continue;
    const std::optional<std::size_t> scaled = encompassing.parameterOf(number.quantity);
    if (!scaled) continue;
    const ModelParameter& parameter = encompassing.parameters().parameters()[*scaled];
    const ParameterDirection direction =
        encompassing.direction(ownValues(data, verdict.values), number.quantity);
    if (direction.empty()) continue;
    number.name = parameter.name;
    number.unit = parameter.unit;
    number.nominal = parameter.value;
    number.estimate = direction.front().value;
    number.sd *= std::abs(direction.front().weight);
    number.prior *= std::abs(parameter.value);
  }
  return numbers;
}

}  // namespace bio::discover
