#include "bio/calibration/trial_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string_view>

#include "bio/analysis/replay.h"
#include "bio/observation/nudge.h"
#include "info/parallel_for.h"

namespace bio {
namespace {

using Eigen::Index;

bool isStart(const ModelParameter& parameter) {
  return std::holds_alternative<InitialTarget>(parameter.targets.front());
}

bool isLatent(const ModelParameter& parameter) {
  return isKnot(parameter.targets.front());
}

EmgMapping latentMapping(const Trial& trial, const MusculoskeletalSystem& system) {
  EmgMapping mapping;
  const std::vector<std::string> muscles = muscleNames(system);
  for (const LatentDeclaration& declaration : trial.latent) {
    if (std::find(muscles.begin(), muscles.end(), declaration.muscle) == muscles.end()) {
      throw std::invalid_argument(fmt::format(
          "{}: latent excitation of '{}': no free or prescribed coordinate moves this muscle",
          trial.file, declaration.muscle));
    }
    try {
      const bool isNew =
          mapping.latent
              .emplace(declaration.muscle, latentExcitation(declaration, trial.times[0],
                                                            trial.times[trial.times.size() - 1]))
              .second;
      if (!isNew)
        throw std::invalid_argument("latent excitation of '" + declaration.muscle + "': twice");
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("{}: {}", trial.file, error.what()));
    }
  }
  return mapping;
}

}  // namespace

bool namesKnot(const std::string& parameter) {
  constexpr std::string_view part = ".latent";
  const std::size_t at = parameter.rfind(part);
  return at != parameter.npos && parameter.find("emg.") != parameter.npos &&
         parameter.find_first_not_of("0123456789*", at + part.size()) == parameter.npos;
}

std::vector<std::size_t> selectDistinct(const ParameterCatalogue& catalogue,
                                        const std::vector<std::string>& names) {
  if (names.empty()) throw std::invalid_argument("no parameter is given");
  std::set<std::size_t> named;
  for (const std::string& name : names) {
    if (name == "all" || name.find('*') != std::string::npos) continue;
    if (!named.insert(catalogue.find(name)).second) {
      throw std::invalid_argument(fmt::format("parameter '{}' is given twice", name));
    }
  }
  return catalogue.select(names);
}

TrialSet::TrialSet(const Model& model, const SystemOptions& system, std::vector<Trial> trials,
                   const TrialSetOptions& options)
    : trials_(std::move(trials)),
      threads_(options.threads),
      options_(system),
      system_(std::make_unique<const MusculoskeletalSystem>(model, system)) {
  if (trials_.empty()) throw std::invalid_argument("no trial is given");
  if (system_->numMuscles() == 0 && !model.muscles.empty())
    throw std::invalid_argument("no muscle moves a free coordinate");
  for (const Trial& trial : trials_) {
    catalogues_.push_back(std::make_unique<const ParameterCatalogue>(
        model, *system_, beginningOf(trial, model, *system_, options.initial).point,
        options.latent ? latentMapping(trial, *system_) : EmgMapping{}));
  }
  collectParameters(options);
  collectSeries(model);
  for (std::size_t i = 0; i < trials_.size(); ++i) {
    const Trial& trial = trials_[i];
    RecordedTrial recorded = recordedTrial(trial, *system_, options.simulation);
    recorded.simulation.progress = {};
    std::vector<ObservedSeries> observed;
    for (const MeasuredSeries& series : series_) {
      if (series.trial != i) continue;
      observed.push_back(
          {series.what, Eigen::Map<const Eigen::VectorXd>(
                            series.times.data(), static_cast<Index>(series.times.size()))});
    }
    try {
      (void)ObservedMotion(*system_, observed);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("{}: {}", trial.file, error.what()));
    }
    experiments_.emplace_back(*catalogues_[i], system, std::move(recorded.excitation),
                              std::move(observed), selectionOf(i), recorded.simulation);
    begin_.push_back(begin_.back() + experiments_.back().size());
  }
}

std::size_t TrialSet::channelOf(const Observable& what, const Model& model) {
  const bool isAngle =
      what.kind == Observable::Kind::coordinate && findCoordinate(model, what.object).isRotation;
  MeasuredGroup group{isAngle ? "angles" : nameOf(what), unitOf(what, model), isAngle};
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    if (channels_[i].name == group.name) return i;
  }
  channels_.push_back(std::move(group));
  return channels_.size() - 1;
}

void TrialSet::collectSeries(const Model& model) {
  for (std::size_t i = 0; i < trials_.size(); ++i) {
    const std::size_t before = series_.size();
    for (const MeasuredChannel& measured : trials_[i].measured) {
      if (measured.times.size() == 0) continue;
      if (measured.what.isCoordinate()) {
        const int index = system_->skeleton().indexOf(measured.what.object);
        if (index < 0 || system_->isPrescribed(index)) continue;
      }
      series_.push_back({i,
                         measured.what,
                         channelOf(measured.what, model),
                         {measured.times.begin(), measured.times.end()},
                         measured.values});
    }
    if (series_.size() == before) {
      std::vector<std::string> names;
      for (const Coordinate& c : system_->skeleton().coordinates()) names.push_back(c.name);
      throw std::invalid_argument(
          fmt::format("{}: no measured column of a free coordinate ({}), nor of anything else",
                      trials_[i].file, fmt::join(names, ", ")));
    }
  }
}

void TrialSet::collectParameters(const TrialSetOptions& options) {
  const ParameterCatalogue& catalogue = *catalogues_.front();
  for (const std::string& name : options.parameters) {
    if (!namesKnot(name)) continue;
    throw std::invalid_argument(fmt::format(
        "parameter '{}': knots of latent excitations are estimated without being named, for the "
        "muscles that the trial's header (latent_excitation) or --latent MUSCLE=SD:SECONDS gives",
        name));
  }
  const bool anyLatent =
      options.latent &&
      std::any_of(trials_.begin(), trials_.end(), [](const Trial& t) { return !t.latent.empty(); });
  if (!options.parameters.empty() || !(options.ownStart || anyLatent)) {
    selection_ = selectDistinct(catalogue, options.parameters);
  }
  // "all" takes them in, which belong to single trials and are estimated anyway
  std::erase_if(selection_, [&](std::size_t i) { return isLatent(catalogue.parameters()[i]); });
  for (const std::size_t index : selection_) {
    const ModelParameter& parameter = catalogue.parameters()[index];
    if (isStart(parameter) && (trials_.size() > 1 || options.ownStart)) {
      throw std::invalid_argument(fmt::format(
          "parameter '{}' differs between trials and cannot be common to all", parameter.name));
    }
  }
  parameters_ = catalogue.asEstimated(selection_, false);
  for (const std::size_t i : selection_)
    targets_.push_back(catalogue.parameters()[i].targets.front());
  collectOwn(options);
  priorSds_.resize(static_cast<Index>(parameters_.size()));
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    priorSds_[static_cast<Index>(i)] =
        i < selection_.size() ? catalogue.parameters()[selection_[i]].sd : parameters_[i].prior->sd;
  }
}

void TrialSet::collectOwn(const TrialSetOptions& options) {
  own_.resize(trials_.size());
  for (std::size_t i = 0; i < trials_.size(); ++i) {
    const auto& all = catalogues_[i]->parameters();
    ownBegin_.push_back(static_cast<Index>(parameters_.size()));
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (all[k].isGroup) continue;
      if ((options.ownStart && isStart(all[k])) || isLatent(all[k])) own_[i].push_back(k);
    }
    addLatent(i, parameters_.size());
    for (const std::size_t k : own_[i]) targets_.push_back(all[k].targets.front());
    for (info::Parameter parameter : catalogues_[i]->asEstimated(own_[i], true)) {
      if (trials_.size() > 1) parameter.name = fmt::format("trial{}.{}", i + 1, parameter.name);
      parameters_.push_back(std::move(parameter));
    }
  }
}

void TrialSet::addLatent(std::size_t trial, std::size_t first) {
  const auto& all = catalogues_[trial]->parameters();
  const EmgMapping mapping = catalogues_[trial]->nominal().mapping;
  const Trial& recorded = trials_[trial];
  for (std::size_t k = 0; k < own_[trial].size(); ++k) {
    const ModelParameter& parameter = all[own_[trial][k]];
    if (!isLatent(parameter)) continue;
    const EmgTarget& target = std::get<EmgTarget>(parameter.targets.front());
    if (target.knot != 0) continue;
    const auto declared =
        std::find_if(recorded.latent.begin(), recorded.latent.end(),
                     [&](const LatentDeclaration& d) { return d.muscle == target.muscle; });
    const auto column = std::find(recorded.muscles.begin(), recorded.muscles.end(), target.muscle);
    const std::vector<double>& knots = mapping.latent.at(target.muscle).knots;
    Eigen::VectorXd atKnots(static_cast<Index>(knots.size()));
    for (Index j = 0; j < atKnots.size(); ++j) {
      atKnots[j] = excitationAt(recorded, column - recorded.muscles.begin(),
                                knots[static_cast<std::size_t>(j)]);
    }
    latent_.push_back({trial, *declared, knots, std::move(atKnots), first + k});
  }
}

std::vector<std::size_t> TrialSet::selectionOf(std::size_t trial) const {
  std::vector<std::size_t> all = selection_;
  all.insert(all.end(), own_.at(trial).begin(), own_.at(trial).end());
  return all;
}

Eigen::VectorXd TrialSet::thetaOf(std::size_t trial, const Eigen::VectorXd& theta) const {
  const auto common = static_cast<Index>(selection_.size());
  const auto own = static_cast<Index>(own_[trial].size());
  Eigen::VectorXd part(common + own);
  part << theta.head(common), theta.segment(ownBegin_[trial], own);
  return part;
}

StartPoint TrialSet::startAt(std::size_t trial, const Eigen::VectorXd& theta) const {
  return catalogues_.at(trial)->at(selectionOf(trial), thetaOf(trial, theta)).start;
}

EmgMapping TrialSet::mappingAt(std::size_t trial, const Eigen::VectorXd& theta) const {
  return catalogues_.at(trial)->at(selectionOf(trial), thetaOf(trial, theta)).mapping;
}

Eigen::MatrixXd TrialSet::measured() const {
  Index samples = 0;
  for (const MeasuredSeries& series : series_) samples += series.values.size();
  Eigen::MatrixXd values(1, samples);
  Index at = 0;
  for (const MeasuredSeries& series : series_) {
    values.middleCols(at, series.values.size()) = series.values.transpose();
    at += series.values.size();
  }
  return values;
}

TrialSet::Cost TrialSet::leastSquares(const Eigen::VectorXd& theta,
                                      const std::vector<double>& sd) const {
  if (sd.size() != channels_.size()) {
    throw std::invalid_argument(fmt::format("{} standard deviations for {} measured channels",
                                            sd.size(), channels_.size()));
  }
  if (theta.size() != static_cast<Index>(parameters_.size())) {
    throw std::invalid_argument(fmt::format("{} values for {} parameters, must be as many",
                                            theta.size(), parameters_.size()));
  }
  const Eigen::VectorXd values = measured().transpose();
  Eigen::VectorXd sds(values.size());
  Index at = 0;
  for (const MeasuredSeries& series : series_) {
    sds.segment(at, series.values.size()).setConstant(sd[series.channel]);
    at += series.values.size();
  }
  Cost cost;
  cost.trials.resize(trials_.size());
  info::parallelFor(static_cast<int>(trials_.size()), threads_, [&](int i) {
    const auto t = static_cast<std::size_t>(i);
    const Index first = begin_[t], count = begin_[t + 1] - begin_[t];
    cost.trials[t] = experiments_[t].leastSquares(thetaOf(t, theta), values.segment(first, count),
                                                  sds.segment(first, count));
  });
  cost.gradient.setZero(theta.size());
  const auto common = static_cast<Index>(selection_.size());
  for (std::size_t i = 0; i < cost.trials.size(); ++i) {
    const CostGradient& trial = cost.trials[i];
    const auto own = static_cast<Index>(own_[i].size());
    cost.value += trial.cost;
    cost.gradient.head(common) += trial.gradient.head(common);
    cost.gradient.segment(ownBegin_[i], own) += trial.gradient.tail(own);
  }
  return cost;
}

std::vector<TrialPredictor> TrialSet::nudged(double frequency) const {
  std::vector<TrialPredictor> held = experiments_;
  for (const MeasuredSeries& series : series_) {
    if (series.what.kind != Observable::Kind::coordinate || series.times.size() < 4) continue;
    held[series.trial].hold(nudgeTo(*system_, system_->skeleton().indexOf(series.what.object),
                                    series.times, series.values, frequency));
  }
  return held;
}

info::Predictor TrialSet::predictor(const std::vector<TrialPredictor>& experiments) const {
  info::Predictor predictor;
  predictor.outputs = [this, &experiments](const Eigen::VectorXd& theta) {
    Eigen::MatrixXd y(1, begin_.back());
    info::parallelFor(static_cast<int>(trials_.size()), threads_, [&](int i) {
      const auto t = static_cast<std::size_t>(i);
      y.middleCols(begin_[t], begin_[t + 1] - begin_[t]) =
          experiments[t].outputs(thetaOf(t, theta)).transpose();
    });
    return y;
  };
  predictor.withSensitivities = [this, &experiments](const Eigen::VectorXd& theta) {
    info::Prediction all{Eigen::MatrixXd(1, begin_.back()),
                         Eigen::MatrixXd::Zero(begin_.back(), theta.size())};
    const auto common = static_cast<Index>(selection_.size());
    info::parallelFor(static_cast<int>(trials_.size()), threads_, [&](int i) {
      const auto t = static_cast<std::size_t>(i);
      const Index first = begin_[t], count = begin_[t + 1] - begin_[t];
      const auto own = static_cast<Index>(own_[t].size());
      const TrialPredictor::Linearised part = experiments[t].withSensitivities(thetaOf(t, theta));
      all.outputs.middleCols(first, count) = part.outputs.transpose();
      all.gamma.block(first, 0, count, common) = part.gamma.leftCols(common);
      all.gamma.block(first, ownBegin_[t], count, own) = part.gamma.rightCols(own);
    });
    return all;
  };
  predictor.whyUndefined = [this, &experiments](const Eigen::VectorXd& theta) {
    std::string why;
    for (std::size_t i = 0; i < trials_.size() && why.empty(); ++i) {
      const std::string one = experiments[i].whyUndefined(thetaOf(i, theta));
      if (!one.empty()) why = fmt::format("{}: {}", trials_[i].file, one);
    }
    return why;
  };
  return predictor;
}

std::string TrialSet::failure(std::size_t trial, const Eigen::VectorXd& theta) const {
  return experiments_[trial].whyUndefined(thetaOf(trial, theta));
}

namespace {

/// Mean square difference over the series for which `counts` holds; NaN without one.
template <class Counts>
double meanSquareWhere(const std::vector<MeasuredSeries>& all, const Eigen::MatrixXd& predicted,
                       const Counts& counts) {
  double sum = 0;
  Index at = 0, count = 0;
  for (const MeasuredSeries& series : all) {
    const Index n = series.values.size();
    if (counts(series)) {
      sum += (predicted.middleCols(at, n).transpose() - series.values).squaredNorm();
      count += n;
    }
    at += n;
  }
  return sum / static_cast<double>(count);
}

}  // namespace

double TrialSet::meanSquare(const Eigen::MatrixXd& predicted) const {
  return meanSquareWhere(series_, predicted, [&](const MeasuredSeries& series) {
    return channels_[series.channel].areAngles;
  });
}

double TrialSet::meanSquareOf(const Eigen::MatrixXd& predicted, std::size_t channel) const {
  return meanSquareWhere(series_, predicted,
                         [&](const MeasuredSeries& series) { return series.channel == channel; });
}

double TrialSet::meanSquare(const Eigen::MatrixXd& predicted, std::size_t trial) const {
  return meanSquareWhere(series_, predicted, [&](const MeasuredSeries& series) {
    return series.trial == trial && channels_[series.channel].areAngles;
  });
}

std::vector<LargestDifference> TrialSet::largestDifferences(const Eigen::MatrixXd& a,
                                                            const Eigen::MatrixXd& b,
                                                            const std::vector<double>& sds) const {
  std::vector<LargestDifference> largest(trials_.size());
  Index at = 0;
  for (const MeasuredSeries& series : series_) {
    const Index n = series.values.size();
    const double difference = (a - b).middleCols(at, n).cwiseAbs().maxCoeff();
    const LargestDifference one{series.channel, difference, sds[series.channel]};
    LargestDifference& so = largest[series.trial];
    if (so.sd == 0 || one.difference / one.sd > so.difference / so.sd) so = one;
    at += n;
  }
  return largest;
}

}  // namespace bio
