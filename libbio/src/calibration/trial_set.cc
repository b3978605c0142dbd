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
    if (!trial.applied.empty()) {
      throw std::invalid_argument(
          trial.file + ": has an external torque, which calibration does not take into account");
    }
    beginnings_.push_back(beginningOf(trial, model, *arm_, options.initial));
    catalogues_.push_back(
        std::make_unique<const ParameterCatalogue>(model, *arm_, beginnings_.back().point));
  }
  collectParameters(options);
  collectSeries(options);
  std::vector<std::size_t> all = selection_;
  all.insert(all.end(), own_.begin(), own_.end());
  for (const MeasuredSeries& series : series_) {
    const Trial& trial = trials_[series.trial];
    SimulationOptions simulation = options.simulation;
    simulation.startTime = trial.times[0];
    simulation.duration = trial.duration();
    simulation.progress = {};
    experiments_.emplace_back(*catalogues_[series.trial], arm, excitationOf(trial, *arm_),
                              series.coordinate, series.times, all, simulation);
  }
}

void TrialSet::collectSeries(const TrialSetOptions&) {
  for (std::size_t i = 0; i < trials_.size(); ++i) {
    const std::size_t before = series_.size();
    for (const MeasuredMotion& measured : trials_[i].measured) {
      const int index = arm_->skeleton().indexOf(measured.coordinate);
      if (index < 0 || measured.times.size() == 0) continue;
      if (!arm_->skeleton().coordinates()[static_cast<std::size_t>(index)].isRotation) continue;
      series_.push_back({i,
                         measured.coordinate,
                         {measured.times.begin(), measured.times.end()},
                         measured.values});
    }
    if (series_.size() == before) {
      std::vector<std::string> names;
      for (const Coordinate& c : arm_->skeleton().coordinates()) names.push_back(c.name);
      throw std::invalid_argument(fmt::format("{}: no measured column of a free angle ({})",
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

std::vector<TrialPredictor> TrialSet::nudged(double frequency) const {
  std::vector<TrialPredictor> held = experiments_;
  for (std::size_t s = 0; s < series_.size(); ++s) {
    for (const MeasuredSeries& other : series_) {
      if (other.trial != series_[s].trial || other.times.size() < 4) continue;
      held[s].hold(nudgeTo(*arm_, arm_->skeleton().indexOf(other.coordinate), other.times,
                           other.values, frequency));
    }
  }
  return held;
}

info::Predictor TrialSet::predictor(const std::vector<TrialPredictor>& experiments) const {
  // where the samples of each series begin
  std::vector<Index> begin = {0};
  for (const MeasuredSeries& series : series_) begin.push_back(begin.back() + series.values.size());
  info::Predictor predictor;
  predictor.outputs = [this, begin, &experiments](const Eigen::VectorXd& theta) {
    Eigen::MatrixXd y(1, begin.back());
    info::parallelFor(static_cast<int>(series_.size()), threads_, [&](int i) {
      const auto s = static_cast<std::size_t>(i);
      y.middleCols(begin[s], begin[s + 1] - begin[s]) =
          experiments[s].outputs(thetaOf(series_[s].trial, theta)).transpose();
    });
    return y;
  };
  predictor.withSensitivities = [this, begin, &experiments](const Eigen::VectorXd& theta) {
    info::Prediction all{Eigen::MatrixXd(1, begin.back()),
                         Eigen::MatrixXd::Zero(begin.back(), theta.size())};
    const auto common = static_cast<Index>(selection_.size());
    const auto own = static_cast<Index>(own_.size());
    info::parallelFor(static_cast<int>(series_.size()), threads_, [&](int i) {
      const auto s = static_cast<std::size_t>(i);
      const std::size_t trial = series_[s].trial;
      const Index first = begin[s], count = begin[s + 1] - begin[s];
      const TrialPredictor::Linearised part =
          experiments[s].withSensitivities(thetaOf(trial, theta));
      all.outputs.middleCols(first, count) = part.outputs.transpose();
      all.gamma.block(first, 0, count, common) = part.gamma.leftCols(common);
      all.gamma.block(first, common + static_cast<Index>(trial) * own, count, own) =
          part.gamma.rightCols(own);
    });
    return all;
  };
  return predictor;
}

std::string TrialSet::failure(std::size_t trial, const Eigen::VectorXd& theta) const {
  for (std::size_t s = 0; s < series_.size(); ++s) {
    if (series_[s].trial != trial) continue;
    try {
      return experiments_[s].simulate(thetaOf(trial, theta)).why;
    } catch (const std::exception& error) {
      return error.what();
    }
  }
  return {};
}

double TrialSet::meanSquare(const Eigen::MatrixXd& predicted) const {
  return (predicted - measured()).squaredNorm() / static_cast<double>(predicted.size());
}

double TrialSet::meanSquare(const Eigen::MatrixXd& predicted, std::size_t trial) const {
  double sum = 0;
  Index at = 0, count = 0;
  for (const MeasuredSeries& series : series_) {
    const Index n = series.values.size();
    if (series.trial == trial) {
      sum += (predicted.middleCols(at, n).transpose() - series.values).squaredNorm();
      count += n;
    }
    at += n;
  }
  return sum / static_cast<double>(count);
}

std::vector<double> TrialSet::largestDifferences(const Eigen::MatrixXd& a,
                                                 const Eigen::MatrixXd& b) const {
  std::vector<double> largest(trials_.size(), 0.0);
  Index at = 0;
  for (const MeasuredSeries& series : series_) {
    const Index n = series.values.size();
    const double difference = (a.middleCols(at, n) - b.middleCols(at, n)).cwiseAbs().maxCoeff();
    largest[series.trial] = std::max(largest[series.trial], difference);
    at += n;
  }
  return largest;
}

}  // namespace bio
