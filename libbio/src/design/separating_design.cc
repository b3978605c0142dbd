#include "bio/design/separating_design.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bio/discovery/effect_names.h"
#include "info/discovery/likelihood/hypothesis.h"
#include "model/require.h"

namespace bio::discover {

using Eigen::Index;
using Eigen::VectorXd;
using info::discover::Candidate;
using info::discover::PresentEffect;

namespace {

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
MusculoskeletalProblemOptions planning(MusculoskeletalProblemOptions options,
                                       const std::vector<ChannelCandidate>& observed) {
  options.usableSeries = false;
  options.sensors.clear();
  options.drives.emplace();  // inputs that are searched for are as they are made
  for (const ChannelCandidate& candidate : observed) options.sensors.push_back(candidate.what);
  return options;
}

/// All that is free to move; where nothing is, what is prescribed and has its moment observed.
std::vector<std::string> inQuestion(const MusculoskeletalSystem& system,
                                    const std::vector<ChannelCandidate>& observed) {
  std::vector<std::string> free, held;
  for (std::size_t i = 0; i < system.skeleton().coordinates().size(); ++i) {
    if (!system.isPrescribed(static_cast<int>(i))) {
      free.push_back(system.skeleton().coordinates()[i].name);
    }
  }
  for (const ChannelCandidate& candidate : observed) {
    if (candidate.what.kind == Observable::Kind::moment) held.push_back(candidate.what.object);
  }
  std::vector<std::string> names = coordinatesInQuestion(free, held, {});
  require(!names.empty(), "no coordinate is free, and no moment is observed: must have either");
  return names;
}

info::discover::Whitening noiseOf(const std::vector<ChannelCandidate>& observed) {
  VectorXd sds(static_cast<Index>(observed.size()));
  for (Index o = 0; o < sds.size(); ++o) sds[o] = observed[static_cast<std::size_t>(o)].sd;
  return info::discover::Whitening(std::move(sds));
}

}  // namespace

SeparatingDesign::SeparatingDesign(const Model& model, const SystemOptions& built,
                                   const Trial& trial, const MusculoskeletalProblemOptions& options,
                                   SeparationQuestion question, DesignLimits limits,
                                   std::vector<bio::MuscleGroup> groups, double knotInterval)
    : model_(model),
      built_(built),
      system_(model, built),
      coordinates_(inQuestion(system_, question.observed)),
      options_(planning(options, question.observed)),
      question_(std::move(question)),
      observed_(options_.sensors),
      noise_(noiseOf(question_.observed)),
      inputs_(system_, trial, trial.times[0], trial.duration(), std::move(limits),
              std::move(groups), knotInterval,
              samplingTimes(trial.times[0], trial.duration(), question_.period)) {
  require(!observed_.empty(), "nothing is observed, at least one channel must be");
  for (const ChannelCandidate& candidate : question_.observed) {
    require(candidate.sd > 0 && std::isfinite(candidate.sd),
            fmt::format("noise of '{}' = {}, must be > 0", nameOf(candidate.what), candidate.sd));
    require(std::count(observed_.begin(), observed_.end(), candidate.what) == 1,
            fmt::format("'{}' is observed twice, must be once", nameOf(candidate.what)));
  }
  for (std::size_t i = 0; i < system_.skeleton().coordinates().size(); ++i) {
    const std::string& name = system_.skeleton().coordinates()[i].name;
    require(system_.isPrescribed(static_cast<int>(i)) ||
                placeOf(name) < static_cast<Index>(observed_.size()),
            fmt::format("'{}' is free to move and must be observed, too", name));
  }
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

Index SeparatingDesign::placeOf(const std::string& coordinate) const {
  return std::find(observed_.begin(), observed_.end(), ofCoordinate(coordinate)) -
         observed_.begin();
}

MusculoskeletalProblem SeparatingDesign::planned(const Trial& trial) const {
  Trial measured = trial;
  VectorXd starts = VectorXd::Zero(static_cast<Index>(observed_.size()));
  for (const auto& [name, value] : question_.start) {
    if (placeOf(name) < starts.size()) starts[placeOf(name)] = value;
  }
  measured.measured = inputs_.measured(
      observed_, starts.transpose().replicate(std::ssize(inputs_.measuredTimes()), 1));
  return {model_, built_, coordinates_, {measured}, options_};
}

SeparatingExperiment SeparatingDesign::at(const VectorXd& x) const {
  SeparatingExperiment e;
  e.inputs = x;
  e.trial = inputs_.at(x);
  const MusculoskeletalProblem data = planned(e.trial);
  e.tells = info::discover::distinction(data, effects_[0], effects_[1], noise_);
  const auto n = static_cast<Index>(observed_.size());
  const auto seen = [&](const VectorXd& values) -> Eigen::MatrixXd {
    const VectorXd samples = data.outputs(0, values, {});
    if (!samples.allFinite()) throw std::domain_error("a simulation does not reach the end");
    return Eigen::Map<const Eigen::MatrixXd>(samples.data(), n, samples.size() / n).transpose();
  };
  e.base = seen(info::discover::nominalValues(data));
  e.first = seen(valuesWith(data, effects_[0]));
  e.second = seen(valuesWith(data, effects_[1]));
  e.keepsLimits = x.size() == 0 || inputs_.profiles().excess(x) < 1e-9;
  for (const CoordinateLimits& limits : inputs_.limits().coordinates) {
    Eigen::MatrixX3d q(e.base.rows(), 3);
    q << e.base.col(placeOf(limits.coordinate)), e.first.col(placeOf(limits.coordinate)),
        e.second.col(placeOf(limits.coordinate));
    const Index steps = q.rows() - 1;
    const MotionExtremes range{
        q.minCoeff(), q.maxCoeff(),
        (q.bottomRows(steps) - q.topRows(steps)).cwiseAbs().maxCoeff() / question_.period};
    e.keepsLimits = e.keepsLimits && range.lowest >= limits.lower &&
                    range.highest <= limits.upper && range.fastest <= limits.speed;
    e.ranges.push_back(range);
  }
  e.trial.measured = inputs_.measured(observed_, e.base);
  return e;
}

// From a margin inside the limits on, by the square, as a mean over the motions.
double SeparatingDesign::price(const SeparatingExperiment& e) const {
  double sum = 0;
  for (std::size_t i = 0; i < e.ranges.size(); ++i) {
    const CoordinateLimits& limits = inputs_.limits().coordinates[i];
    const double margin = 0.02 * (limits.upper - limits.lower);
    for (const Eigen::MatrixXd* motion : {&e.base, &e.first, &e.second}) {
      const auto q = motion->col(placeOf(limits.coordinate)).array();
      const auto below = (limits.lower + margin - q).max(0) / margin;
      const auto above = (q - limits.upper + margin).max(0) / margin;
      sum += (below.square() + above.square()).mean() / 3;
    }
    const double fast = std::max(0.0, e.ranges[i].fastest / limits.speed - 0.97) / 0.03;
    sum += fast * fast;
  }
  return sum;
}

SeparatingResult SeparatingDesign::search(const DesignSearchSettings& settings) const {
  SeparatingResult result;
  result.before = before();
  result.after = result.before;
  InputSearch search(inputs_, settings,
                     result.before.keepsLimits ? -result.before.tells.least() : 0, 0, result);
  search.evolve([&](const VectorXd& x) {
    if (search.isStopped()) return InputSearch::worthless;
    bool isPossible = false;
    double cost = InputSearch::worthless, guided = InputSearch::worthless;
    try {
      const SeparatingExperiment e = at(x);
      isPossible = true;
      if (e.keepsLimits) cost = -e.tells.least();
      // finite also for indistinguishable effects, so that the price still guides the search
      guided = -std::log(std::max(1e-12, e.tells.least())) + price(e);
    } catch (const std::domain_error&) {
      // impossible
    }
    search.note(x, isPossible, cost);
    return guided;
  });
  if (search.bestInputs().size() > 0) {
    result.after = at(search.bestInputs());
    result.improved = true;
  }
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

}  // namespace bio::discover
