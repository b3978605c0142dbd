#include "bio/observation/trial_predictor.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <new>
#include <stdexcept>

#include "bio/observation/least_squares_cost.h"

namespace bio {
namespace {

using Eigen::Index;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::vector<ObservedSeries> coordinateAt(const std::string& name,
                                         const std::vector<double>& times) {
  std::vector<ObservedSeries> series(1);
  series.front().what.object = name;
  series.front().times = Eigen::VectorXd::Map(times.data(), static_cast<Index>(times.size()));
  return series;
}

}  // namespace

TrialPredictor::TrialPredictor(const ParameterCatalogue& catalogue, const SystemOptions& system,
                               ExcitationSignal trial, const std::string& coordinate,
                               std::vector<double> times, std::vector<std::size_t> selection,
                               const SimulationOptions& options)
    : TrialPredictor(catalogue, system, std::move(trial), coordinateAt(coordinate, times),
                     std::move(selection), options) {
  const auto& free = system.skeleton.freeCoordinates;
  if (std::find(free.begin(), free.end(), coordinate) == free.end()) {
    throw std::invalid_argument(fmt::format("observed coordinate '{}' is not free", coordinate));
  }
}

TrialPredictor::TrialPredictor(const ParameterCatalogue& catalogue, const SystemOptions& system,
                               ExcitationSignal trial, std::vector<ObservedSeries> series,
                               std::vector<std::size_t> selection, const SimulationOptions& options)
    : catalogue_(&catalogue),
      systemOptions_(system),
      trial_(std::move(trial)),
      series_(std::move(series)),
      selection_(std::move(selection)),
      options_(options) {
  if (!isVariational(options.integrator)) {
    throw std::invalid_argument("sensitivities: integrator must be vi-adaptive, vi or vi-left");
  }
  for (const ObservedSeries& observed : series_) {
    size_ += observed.times.size();
    double last = -std::numeric_limits<double>::infinity();
    for (const double t : observed.times) {
      const bool inside = t >= options.startTime - 1e-9 &&
                          t <= options.startTime + options.duration + 1e-9 && t > last;
      if (!inside) {
        throw std::invalid_argument(
            fmt::format("observed time {} s must rise and lie within {} to {} s", t,
                        options.startTime, options.startTime + options.duration));
      }
      last = t;
    }
  }
}

TrialPredictor::Held TrialPredictor::heldAt(ParameterCatalogue::Setting setting) const {
  SimulationOptions options = options_;
  for (const Nudge& nudge : nudges_) apply(nudge, setting.model, options.externalForce);
  MusculoskeletalSystem system(setting.model, systemOptions_);
  return {std::move(setting), std::move(options), std::move(system)};
}

Trajectory TrialPredictor::simulate(const Eigen::VectorXd& theta) const {
  const Held held = heldAt(catalogue_->at(selection_, theta));
  return simulateSetting(held.system, held.setting, trial_, held.options);
}

SensitivityTrajectory TrialPredictor::simulateWithSensitivities(
    const Eigen::VectorXd& theta) const {
  return sensitivitiesOf(heldAt(catalogue_->at(selection_, theta)), false, false);
}

SensitivityTrajectory TrialPredictor::sensitivitiesOf(const Held& held, bool muscles,
                                                      bool reactions) const {
  SensitivityOptions options;
  options.simulation = held.options;
  options.muscles = muscles;
  options.reactions = reactions;
  return bio::simulateWithSensitivities(held.system, *catalogue_, held.setting, selection_, trial_,
                                        options);
}

Eigen::VectorXd TrialPredictor::outputs(const Eigen::VectorXd& theta) const {
  const ParameterCatalogue::Setting setting = catalogue_->at(selection_, theta);
  try {
    const Held held = heldAt(setting);
    return ObservedMotion(held.system, series_)
        .values(simulateSetting(held.system, held.setting, trial_, held.options));
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    return Eigen::VectorXd::Constant(size_, nan);  // outside the model's domain: whyUndefined()
  }
}

std::string TrialPredictor::whyUndefined(const Eigen::VectorXd& theta) const {
  try {
    return simulate(theta).why;
  } catch (const std::exception& error) {
    return error.what();
  }
}

TrialPredictor::Linearised TrialPredictor::withSensitivities(const Eigen::VectorXd& theta) const {
  const ParameterCatalogue::Setting setting = catalogue_->at(selection_, theta);
  try {
    const Held held = heldAt(setting);
    const ObservedMotion observed(held.system, series_);
    ObservedMotion::Linearised at = observed.linearised(
        sensitivitiesOf(held, observed.needsMuscles(), observed.needsReactions()));
    return {std::move(at.values), std::move(at.gamma)};
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    return {Eigen::VectorXd::Constant(size_, nan),
            Eigen::MatrixXd::Constant(size_, theta.size(), nan)};
  }
}

CostGradient TrialPredictor::leastSquares(const Eigen::VectorXd& theta,
                                          const Eigen::VectorXd& measured,
                                          const Eigen::VectorXd& sd) const {
  const Held held = heldAt(catalogue_->at(selection_, theta));
  return simulateWithGradient(held.system, *catalogue_, held.setting, selection_, trial_,
                              held.options, leastSquaresCost(held.system, series_, measured, sd));
}

info::Predictor TrialPredictor::predictor() const {
  info::Predictor predictor;
  predictor.outputs = [this](const Eigen::VectorXd& theta) -> Eigen::MatrixXd {
    return outputs(theta).transpose();
  };
  predictor.withSensitivities = [this](const Eigen::VectorXd& theta) {
    Linearised at = withSensitivities(theta);
    return info::Prediction{at.outputs.transpose(), std::move(at.gamma)};
  };
  predictor.whyUndefined = [this](const Eigen::VectorXd& theta) { return whyUndefined(theta); };
  return predictor;
}

info::Predictor joined(const std::vector<TrialPredictor>& experiments) {
  if (experiments.empty()) throw std::invalid_argument("must have at least one experiment to join");
  Index samples = 0;
  for (const TrialPredictor& experiment : experiments) {
    if (experiment.selection() != experiments.front().selection()) {
      throw std::invalid_argument("joined experiments must have the same parameters");
    }
    samples += experiment.size();
  }
  info::Predictor predictor;
  predictor.outputs = [experiments, samples](const Eigen::VectorXd& theta) {
    Eigen::MatrixXd y(1, samples);
    Index at = 0;
    for (const TrialPredictor& experiment : experiments) {
      const Index count = experiment.size();
      y.middleCols(at, count) = experiment.outputs(theta).transpose();
      at += count;
    }
    return y;
  };
  predictor.withSensitivities = [experiments, samples](const Eigen::VectorXd& theta) {
    info::Prediction all{Eigen::MatrixXd(1, samples), Eigen::MatrixXd(samples, theta.size())};
    Index at = 0;
    for (const TrialPredictor& experiment : experiments) {
      const Index count = experiment.size();
      const TrialPredictor::Linearised part = experiment.withSensitivities(theta);
      all.outputs.middleCols(at, count) = part.outputs.transpose();
      all.gamma.middleRows(at, count) = part.gamma;
      at += count;
    }
    return all;
  };
  predictor.whyUndefined = [experiments](const Eigen::VectorXd& theta) {
    std::string why;
    for (std::size_t i = 0; i < experiments.size() && why.empty(); ++i)
      why = experiments[i].whyUndefined(theta);
    return why;
  };
  return predictor;
}

}  // namespace bio
