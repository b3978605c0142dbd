#include "bio/calibration/trial_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "bio/analysis/replay.h"
#include "bio/calibration/nudge.h"
#include "info/estimation/monte_carlo.h"

namespace bio {
namespace {

using Eigen::Index;

bool isStart(const ModelParameter& parameter) {
  return std::holds_alternative<InitialTarget>(parameter.targets.front());
}

}  // namespace

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

TrialSet::TrialSet(const Model& model, const SystemOptions& arm, std::vector<Trial> trials,
                   const TrialSetOptions& options)
    : trials_(std::move(trials)),
      threads_(options.threads),
      arm_(std::make_unique<const MusculoskeletalSystem>(model, arm)) {
  if (trials_.empty()) throw std::invalid_argument("no trial is given");
  if (arm_->numMuscles() == 0) throw std::invalid_argument("no muscle moves a free coordinate");
  for (const Trial& trial : trials_) {
    beginnings_.push_back(beginningOf(trial, model, *arm_, options.initial));
    catalogues_.push_back(
        std::make_unique<const ParameterCatalogue>(model, *arm_, beginnings_.back().point));
  }
  collectParameters(options);
  collectSeries(model);
  std::vector<std::size_t> all = selection_;
  all.insert(all.end(), own_.begin(), own_.end());
  for (std::size_t i = 0; i < trials_.size(); ++i) {
    const Trial& trial = trials_[i];
    SimulationOptions simulation = options.simulation;
    simulation.startTime = trial.times[0];
    simulation.duration = trial.duration();
    simulation.externalForce = externalForceOf(trial, *arm_);
    simulation.prescribed = prescribedMotionOf(trial, *arm_);
    simulation.progress = {};
    std::vector<ObservedSeries> observed;
    for (const MeasuredSeries& one : series_) {
      if (one.trial != i) continue;
      observed.push_back({one.what, Eigen::Map<const Eigen::VectorXd>(
                                        one.times.data(), static_cast<Index>(one.times.size()))});
    }
    try {
      (void)ObservedMotion(*arm_, observed);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("{}: {}", trial.file, error.what()));
    }
    experiments_.emplace_back(*catalogues_[i], arm, excitationOf(trial, *arm_), std::move(observed),
                              all, simulation);
    begin_.push_back(begin_.back() + experiments_.back().size());
  }
}

std::size_t TrialSet::channelOf(const Observable& what, const Model& model) {
  const bool isAngle =
      what.kind == Observable::Kind::coordinate && findCoordinate(model, what.of).isRotation;
  MeasuredGroup group{isAngle ? "angles" : nameOf(what), unitOf(what, model), isAngle};
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    if (channels_[i].name == group.name) return i;
  }
  channels_.push_back(std::move(group));
  return channels_.size() - 1;
}

void TrialSet::collectSeries(const Model& model) {
  const auto add = [&](std::size_t trial, const Observable& what, const Eigen::VectorXd& times,
                       const Eigen::VectorXd& values) {
    series_.push_back({trial, what, channelOf(what, model), {times.begin(), times.end()}, values});
  };
  for (std::size_t i = 0; i < trials_.size(); ++i) {
    const std::size_t before = series_.size();
    for (const MeasuredMotion& measured : trials_[i].measured) {
      const int index = arm_->skeleton().indexOf(measured.coordinate);
      if (index < 0 || arm_->isPrescribed(index) || measured.times.size() == 0) continue;
      add(i, {Observable::Kind::coordinate, measured.coordinate, 0}, measured.times,
          measured.values);
    }
    for (const MeasuredChannel& channel : trials_[i].channels) {
      add(i, channel.what, channel.times, channel.values);
    }
    if (series_.size() == before) {
      std::vector<std::string> names;
      for (const Coordinate& c : arm_->skeleton().coordinates()) names.push_back(c.name);
      throw std::invalid_argument(
          fmt::format("{}: no measured column of a free coordinate ({}), nor of anything else",
                      trials_[i].file, fmt::join(names, ", ")));
    }
  }
}

void TrialSet::collectParameters(const TrialSetOptions& options) {
  const ParameterCatalogue& catalogue = *catalogues_.front();
  if (!options.parameters.empty() || !options.ownStart) {
    selection_ = selectDistinct(catalogue, options.parameters);
  }
  for (const std::size_t index : selection_) {
    const ModelParameter& parameter = catalogue.parameters()[index];
    if (isStart(parameter) && (trials_.size() > 1 || options.ownStart)) {
      throw std::invalid_argument(fmt::format(
          "parameter '{}' differs between trials and cannot be common to all", parameter.name));
    }
  }
  if (options.ownStart) {
    for (std::size_t i = 0; i < catalogue.parameters().size(); ++i) {
      const ModelParameter& parameter = catalogue.parameters()[i];
      if (isStart(parameter) && !parameter.isGroup) own_.push_back(i);
    }
  }
  parameters_ = catalogue.asEstimated(selection_, false);
  std::vector<double> known;
  for (const std::size_t index : selection_) {
    known.push_back(catalogue.parameters()[index].sd);
  }
  for (std::size_t i = 0; i < trials_.size() && !own_.empty(); ++i) {
    for (info::Parameter parameter : catalogues_[i]->asEstimated(own_, true)) {
      if (trials_.size() > 1) parameter.name = fmt::format("trial{}.{}", i + 1, parameter.name);
      known.push_back(parameter.prior->sd);
      parameters_.push_back(std::move(parameter));
    }
  }
  known_ = Eigen::VectorXd::Map(known.data(), static_cast<Index>(known.size()));
}

Eigen::VectorXd TrialSet::thetaOf(std::size_t trial, const Eigen::VectorXd& theta) const {
  const auto common = static_cast<Index>(selection_.size());
  const auto own = static_cast<Index>(own_.size());
  Eigen::VectorXd part(common + own);
  part << theta.head(common), theta.segment(common + static_cast<Index>(trial) * own, own);
  return part;
}

StartPoint TrialSet::startAt(std::size_t trial, const Eigen::VectorXd& theta) const {
  std::vector<std::size_t> all = selection_;
  all.insert(all.end(), own_.begin(), own_.end());
  return catalogues_.at(trial)->at(all, thetaOf(trial, theta)).start;
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
  const auto own = static_cast<Index>(own_.size());
  for (Index i = 0; i < std::ssize(cost.trials); ++i) {
    const CostGradient& trial = cost.trials[static_cast<std::size_t>(i)];
    cost.value += trial.cost;
    cost.gradient.head(common) += trial.gradient.head(common);
    cost.gradient.segment(common + i * own, own) += trial.gradient.tail(own);
  }
  return cost;
}

std::vector<TrialPredictor> TrialSet::nudged(double frequency) const {
  std::vector<TrialPredictor> held = experiments_;
  for (const MeasuredSeries& one : series_) {
    if (one.what.kind != Observable::Kind::coordinate || one.times.size() < 4) continue;
    held[one.trial].hold(
        nudgeTo(*arm_, arm_->skeleton().indexOf(one.what.of), one.times, one.values, frequency));
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
    const auto own = static_cast<Index>(own_.size());
    info::parallelFor(static_cast<int>(trials_.size()), threads_, [&](int i) {
      const auto t = static_cast<std::size_t>(i);
      const Index first = begin_[t], count = begin_[t + 1] - begin_[t];
      const TrialPredictor::Linearised part = experiments[t].withSensitivities(thetaOf(t, theta));
      all.outputs.middleCols(first, count) = part.outputs.transpose();
      all.gamma.block(first, 0, count, common) = part.gamma.leftCols(common);
      all.gamma.block(first, common + i * own, count, own) = part.gamma.rightCols(own);
    });
    return all;
  };
  return predictor;
}

std::string TrialSet::failure(std::size_t trial, const Eigen::VectorXd& theta) const {
  try {
    return experiments_[trial].simulate(thetaOf(trial, theta)).why;
  } catch (const std::exception& error) {
    return error.what();
  }
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

std::vector<double> TrialSet::largestDifferences(const Eigen::MatrixXd& a,
                                                 const Eigen::MatrixXd& b) const {
  std::vector<double> largest(trials_.size(), 0.0);
  Index at = 0;
  for (const MeasuredSeries& series : series_) {
    const Index n = series.values.size();
    const double difference = (a.middleCols(at, n) - b.middleCols(at, n)).cwiseAbs().maxCoeff();
    if (channels_[series.channel].areAngles) {
      largest[series.trial] = std::max(largest[series.trial], difference);
    }
    at += n;
  }
  return largest;
}

}  // namespace bio
