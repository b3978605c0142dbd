#include "bio/calibration/trial_predictor.h"

#include <fmt/format.h>

#include <limits>
#include <stdexcept>

#include "simulation/motion_weights.h"

namespace bio {
namespace {

using Eigen::Index;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TrialPredictor::TrialPredictor(const ParameterCatalogue& catalogue, const SystemOptions& arm,
                               ExcitationSignal trial, const std::string& coordinate,
                               std::vector<double> times, std::vector<std::size_t> selection,
                               const SimulationOptions& options)
    : catalogue_(&catalogue),
      armOptions_(arm),
      trial_(std::move(trial)),
      coordinate_(-1),
      times_(std::move(times)),
      selection_(std::move(selection)),
      options_(options) {
  const auto& free = arm.skeleton.freeCoordinates;
  for (std::size_t i = 0; i < free.size(); ++i) {
    if (free[i] == coordinate) coordinate_ = static_cast<int>(i);
  }
  if (coordinate_ < 0) {
    throw std::invalid_argument(fmt::format("observed coordinate '{}' is not free", coordinate));
  }
  if (options.integrator != Integrator::variational &&
      options.integrator != Integrator::variationalLeft) {
    throw std::invalid_argument("sensitivities: integrator must be vi or vi-left");
  }
  double last = -std::numeric_limits<double>::infinity();
  for (const double t : times_) {
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

Trajectory TrialPredictor::simulate(const Eigen::VectorXd& theta) const {
  return simulateAt(catalogue_->at(selection_, theta));
}
Trajectory TrialPredictor::simulateAt(ParameterCatalogue::Setting setting) const {
  SimulationOptions options = options_;
  for (const Nudge& nudge : nudges_) apply(nudge, setting.model, options.externalForce);
  const MusculoskeletalSystem arm(setting.model, armOptions_);
  return simulateSetting(arm, setting, trial_, options);
}

SensitivityTrajectory TrialPredictor::simulateWithSensitivities(
    const Eigen::VectorXd& theta) const {
  return sensitivitiesAt(catalogue_->at(selection_, theta));
}
SensitivityTrajectory TrialPredictor::sensitivitiesAt(ParameterCatalogue::Setting setting) const {
  SimulationOptions options = options_;
  for (const Nudge& nudge : nudges_) apply(nudge, setting.model, options.externalForce);
  const MusculoskeletalSystem arm(setting.model, armOptions_);
  return bio::simulateWithSensitivities(arm, *catalogue_, setting, selection_, trial_,
                                        {options, false});
}

Eigen::VectorXd TrialPredictor::outputs(const Eigen::VectorXd& theta) const {
  Eigen::VectorXd y = Eigen::VectorXd::Constant(static_cast<Index>(times_.size()), nan);
  const ParameterCatalogue::Setting setting = catalogue_->at(selection_, theta);
  Trajectory motion;
  try {
    motion = simulateAt(setting);
  } catch (const std::exception&) {
    return y;  // outside the model's domain
  }
  for (std::size_t i = 0; i < times_.size(); ++i) {
    if (const auto w = weightsAt(motion.time, times_[i])) {
      y[static_cast<Index>(i)] = w->value(motion.q.row(coordinate_), motion.qDot.row(coordinate_));
    }
  }
  return y;
}

TrialPredictor::Linearised TrialPredictor::withSensitivities(const Eigen::VectorXd& theta) const {
  const auto K = static_cast<Index>(times_.size());
  Linearised result{Eigen::VectorXd::Constant(K, nan),
                    Eigen::MatrixXd::Constant(K, theta.size(), nan)};
  const ParameterCatalogue::Setting setting = catalogue_->at(selection_, theta);
  SensitivityTrajectory s;
  try {
    s = sensitivitiesAt(setting);
  } catch (const std::exception&) {
    return result;
  }
  const auto c = static_cast<std::size_t>(coordinate_);
  for (Index i = 0; i < K; ++i) {
    const auto w = weightsAt(s.motion.time, times_[static_cast<std::size_t>(i)]);
    if (!w) continue;
    result.outputs[i] = w->value(s.motion.q.row(coordinate_), s.motion.qDot.row(coordinate_));
    result.gamma.row(i) = w->rows(s.q[c], s.qDot[c]);
  }
  return result;
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
  return predictor;
}

info::Predictor joined(const std::vector<TrialPredictor>& experiments) {
  if (experiments.empty()) throw std::invalid_argument("must have at least one experiment to join");
  Index samples = 0;
  for (const TrialPredictor& experiment : experiments) {
    if (experiment.selection() != experiments.front().selection()) {
      throw std::invalid_argument("joined experiments must have the same parameters");
    }
    samples += static_cast<Index>(experiment.times().size());
  }
  info::Predictor predictor;
  predictor.outputs = [experiments, samples](const Eigen::VectorXd& theta) {
    Eigen::MatrixXd y(1, samples);
    Index at = 0;
    for (const TrialPredictor& experiment : experiments) {
      const auto count = static_cast<Index>(experiment.times().size());
      y.middleCols(at, count) = experiment.outputs(theta).transpose();
      at += count;
    }
    return y;
  };
  predictor.withSensitivities = [experiments, samples](const Eigen::VectorXd& theta) {
    info::Prediction all{Eigen::MatrixXd(1, samples), Eigen::MatrixXd(samples, theta.size())};
    Index at = 0;
    for (const TrialPredictor& experiment : experiments) {
      const auto count = static_cast<Index>(experiment.times().size());
      const TrialPredictor::Linearised part = experiment.withSensitivities(theta);
      all.outputs.middleCols(at, count) = part.outputs.transpose();
      all.gamma.middleRows(at, count) = part.gamma;
      at += count;
    }
    return all;
  };
  return predictor;
}

}  // namespace bio
