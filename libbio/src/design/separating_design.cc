#include "bio/design/separating_design.h"
#include "bio/discovery/effect_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <stdexcept>

#include "bio/simulation/musculoskeletal_system.h"
#include "info/design/cma_es.h"
#include "info/discovery/likelihood/hypothesis.h"
#include "info/parallel_for.h"
#include "model/require.h"

namespace bio::discover {

using Eigen::Index;
using Eigen::VectorXd;
using info::discover::Candidate;
using info::discover::PresentEffect;

namespace {

constexpr double worthless = std::numeric_limits<double>::infinity();

std::vector<double> measuredTimes(const Trial& trial, double period) {
  const double first = trial.times[0], duration = trial.times[trial.times.size() - 1] - first;
  require(period >= 1e-6 * duration && period <= duration,
          fmt::format(
              "period of the measurements = {} s, must be a millionth of the duration to all of it",
              period));
  std::vector<double> times;
  for (int k = 0; k <= static_cast<int>(std::floor(duration / period + 1e-6)); ++k) {
    times.push_back(first + k * period);
  }
  return times;
}

PresentEffect presentIn(const MusculoskeletalProblem& data, const std::string& id, double size) {
  const auto& candidates = data.candidates();
  const auto at = std::find_if(candidates.begin(), candidates.end(),
                               [&](const Candidate& c) { return c.id == id; });
  const auto present = data.encompassing().present().find(id);
  require(present == data.encompassing().present().end(),
          fmt::format("the model already has '{}'", id));
  require(at != candidates.end(), fmt::format("no effect is called '{}'", id));
  PresentEffect effect{static_cast<std::size_t>(at - candidates.begin()), at->starts.front()};
  const auto& amplitude = data.quantities()[at->quantities.front()];
  if (size == 0) {
    const double sd = at->sds.front();
    size = amplitude.logarithmic ? amplitude.nominal * std::exp(sd) : amplitude.nominal + sd;
    if (size > amplitude.upper) size = 2 * amplitude.nominal - size;
    size = std::clamp(size, amplitude.lower, amplitude.upper);
  }
  require(size >= amplitude.lower && size <= amplitude.upper && size != amplitude.nominal,
          fmt::format("size of {} = {} {}, must be within {} to {} and not {}", id, size,
                      amplitude.unit, amplitude.lower, amplitude.upper, amplitude.nominal));
  effect.values[0] = size;
  return effect;
}

VectorXd valuesWith(const MusculoskeletalProblem& data, const PresentEffect& effect) {
  VectorXd values = info::discover::nominalValues(data);
  const auto& quantities = data.candidates()[effect.candidate].quantities;
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    values[static_cast<Index>(quantities[i])] = effect.values[static_cast<Index>(i)];
  }
  return values;
}

/// Nothing has been measured yet.
MusculoskeletalProblemOptions withoutMeasurements(MusculoskeletalProblemOptions options) {
  options.usableSeries = false;
  return options;
}

}  // namespace

SeparatingDesign::SeparatingDesign(const Model& model, const SystemOptions& arm,
                                   const std::string& coordinate, const Trial& trial,
                                   const MusculoskeletalProblemOptions& options,
                                   SeparationQuestion question, const DesignLimits& limits,
                                   std::vector<bio::MuscleGroup> groups, double knotInterval)
    : model_(model),
      arm_(arm),
      coordinate_(coordinate),
      options_(withoutMeasurements(options)),
      question_(std::move(question)),
      inputs_(MusculoskeletalSystem(model, arm), trial, coordinate, trial.times[0],
              trial.duration(), limits, std::move(groups), knotInterval,
              measuredTimes(trial, question_.period)) {
  require(question_.noise > 0 && std::isfinite(question_.noise),
          fmt::format("noise = {}, must be > 0", question_.noise));
  question_.first = effectId(question_.first);
  question_.second = effectId(question_.second);
  require(question_.first != question_.second,
          fmt::format("'{}' is given twice, the two effects must differ", question_.first));
  const MusculoskeletalProblem data = planned(inputs_.at({}));
  effects_[0] = presentIn(data, question_.first, question_.firstSize);
  effects_[1] = presentIn(data, question_.second, question_.secondSize);
  for (int i = 0; i < 2; ++i) {
    candidates_[i] = data.candidates()[effects_[i].candidate];
    units_[i] = data.quantities()[candidates_[i].quantities.front()].unit;
  }
  question_.firstSize = effects_[0].values[0];
  question_.secondSize = effects_[1].values[0];
}

MusculoskeletalProblem SeparatingDesign::planned(const Trial& trial) const {
  Trial measured = trial;
  const auto& times = inputs_.measuredTimes();
  const auto n = static_cast<Index>(times.size());
  measured.measured = {{ofCoordinate(coordinate_), Eigen::Map<const VectorXd>(times.data(), n),
                        VectorXd::Constant(n, question_.start)}};
  return {model_, arm_, coordinate_, {measured}, options_};
}

SeparatingExperiment SeparatingDesign::at(const VectorXd& x) const {
  SeparatingExperiment e;
  e.inputs = x;
  e.trial = inputs_.at(x);
  const MusculoskeletalProblem data = planned(e.trial);
  e.tells = info::discover::distinction(data, effects_[0], effects_[1], question_.noise);
  e.base = data.outputs(0, info::discover::nominalValues(data), {});
  e.first = data.outputs(0, valuesWith(data, effects_[0]), {});
  e.second = data.outputs(0, valuesWith(data, effects_[1]), {});
  e.lowest = worthless;
  e.highest = -worthless;
  for (const VectorXd* motion : {&e.base, &e.first, &e.second}) {
    if (!motion->allFinite()) throw std::domain_error("a simulation does not reach the end");
    e.lowest = std::min(e.lowest, motion->minCoeff());
    e.highest = std::max(e.highest, motion->maxCoeff());
    const Index n = motion->size();
    e.fastest =
        std::max(e.fastest, (motion->tail(n - 1) - motion->head(n - 1)).cwiseAbs().maxCoeff() /
                                question_.period);
  }
  const DesignLimits& limits = inputs_.limits();
  e.keepsLimits = e.lowest >= limits.lower && e.highest <= limits.upper &&
                  e.fastest <= limits.speed &&
                  (x.size() == 0 || inputs_.profiles().excess(x) < 1e-9);
  const auto& times = inputs_.measuredTimes();
  e.trial.measured = {{ofCoordinate(coordinate_),
                       Eigen::Map<const VectorXd>(times.data(), static_cast<Index>(times.size())),
                       e.base}};
  return e;
}

// From a margin inside the limits on, by the square, as a mean over the motions.
double SeparatingDesign::price(const SeparatingExperiment& e) const {
  const DesignLimits& limits = inputs_.limits();
  const double margin = 0.02 * (limits.upper - limits.lower);
  double sum = 0;
  for (const VectorXd* motion : {&e.base, &e.first, &e.second}) {
    const auto below = (limits.lower + margin - motion->array()).max(0) / margin;
    const auto above = (motion->array() - limits.upper + margin).max(0) / margin;
    sum += (below.square() + above.square()).mean() / 3;
  }
  const double fast = std::max(0.0, e.fastest / limits.speed - 0.97) / 0.03;
  return sum + fast * fast;
}

SeparatingResult SeparatingDesign::search(const DesignSearchSettings& settings) const {
  require(settings.candidates >= 0 && settings.generations >= 0,
          "candidates and generations must be ≥ 0");
  SeparatingResult result;
  result.before = before();
  result.after = result.before;
  constexpr int population = 16;
  const double planned = settings.candidates + 1 + population * settings.generations;
  std::mutex mutex;
  std::atomic<bool> stop{false};
  double best = result.before.keepsLimits ? result.before.tells.least() : 0;
  const auto costOf = [&](const VectorXd& x) {
    if (stop) return worthless;
    double cost = worthless;
    std::optional<SeparatingExperiment> e;
    try {
      e = at(x);
      // finite also for indistinguishable effects, so that the price still guides the search
      cost = -std::log(std::max(1e-12, e->tells.least())) + price(*e);
    } catch (const std::domain_error&) {
      // impossible
    }
    const std::lock_guard lock(mutex);
    ++result.runs;
    if (!e) ++result.impossible;
    if (e && e->keepsLimits && e->tells.least() > best) {
      best = e->tells.least();
      result.nats.push_back(best);
      result.foundAt.push_back(result.runs);
      result.after = std::move(*e);
      result.improved = true;
    }
    if (settings.progress && !settings.progress(std::min(1.0, result.runs / planned))) stop = true;
    return cost;
  };
  const auto project = [&](const VectorXd& x) { return inputs_.profiles().project(x); };

  // the trial's own inputs, and random ones about them
  std::vector<VectorXd> candidates(static_cast<std::size_t>(settings.candidates) + 1,
                                   inputs_.own());
  std::vector<double> costs(candidates.size());
  info::parallelFor(static_cast<int>(candidates.size()), settings.threads, [&](int i) {
    const auto si = static_cast<std::size_t>(i);
    if (i > 0) candidates[si] = inputs_.random(settings.seed, static_cast<std::uint64_t>(i));
    costs[si] = costOf(candidates[si]);
  });
  if (settings.generations > 0 && !stop) {
    info::EvolutionOptions options;
    options.generations = settings.generations;
    options.population = population;
    options.spread = 0.2;
    options.seed = settings.seed;
    options.threads = settings.threads;
    options.progress = [&](int, double) { return !stop; };
    const auto first = std::min_element(costs.begin(), costs.end());
    info::evolve(costOf, project, candidates[static_cast<std::size_t>(first - costs.begin())],
                 options);
  }
  result.stopped = stop;
  return result;
}

SeparationQuestion withSizes(SeparationQuestion question,
                             const std::map<std::string, double>& sizes) {
  for (const auto& [name, size] : sizes) {
    const bool isFirst = effectId(name) == effectId(question.first);
    require(isFirst || effectId(name) == effectId(question.second),
            fmt::format("size: '{}' is not one of the two effects", name));
    require(size != 0, fmt::format("size: {} = 0, must not be 0", name));
    (isFirst ? question.firstSize : question.secondSize) = size;
  }
  return question;
}

Table separatingTable(const SeparatingDesign& design, const SeparatingExperiment& experiment) {
  const Trial& trial = experiment.trial;
  const auto muscles = static_cast<Index>(trial.muscles.size());
  const auto forces = static_cast<Index>(trial.applied.size());
  Table table;
  table.name = "designed experiment";
  table.metadata["predicted"] = design.coordinate() + " is predicted, not measured";
  table.metadata.merge(headerOf(trial.known));
  table.columns = {"time"};
  table.columns.insert(table.columns.end(), trial.muscles.begin(), trial.muscles.end());
  for (const AppliedForce& force : trial.applied) {
    table.columns.push_back(force.coordinate + ".torque");
  }
  table.columns.push_back(design.coordinate());
  table.values = Eigen::MatrixXd::Constant(trial.times.size(), muscles + forces + 2,
                                           std::numeric_limits<double>::quiet_NaN());
  table.values.col(0) = trial.times;
  table.values.middleCols(1, muscles) = trial.excitations;
  for (Index i = 0; i < forces; ++i) {
    table.values.col(1 + muscles + i) = trial.applied[static_cast<std::size_t>(i)].values;
  }
  Index row = 0;
  const MeasuredChannel& motion = trial.measured.front();
  for (Index i = 0; i < motion.times.size(); ++i) {
    while (row + 1 < trial.times.size() && trial.times[row] < motion.times[i] - 1e-9) ++row;
    table.values(row, table.values.cols() - 1) = motion.values[i];
  }
  return table;
}

}  // namespace bio::discover
