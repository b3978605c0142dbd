#pragma once

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "bio/calibration/calibrate.h"
#include "info/parallel_for.h"
#include "info/probability/random_stream.h"
#include "support/synthetic_elbow.h"

// Calibrations repeated on synthetic trials of a dynamometer, whose truth is known: the elbow held
// at three angles and turned at two speeds, the moment measured. Noise is drawn anew each time and
// estimated with the parameters; there are no priors.
namespace bio::fixtures {

struct TorqueStatistics {
  Eigen::ArrayXd bias;      ///< of the mean, in its own standard errors
  Eigen::ArrayXd variance;  ///< of the estimates, in units of the Cramér–Rao bound at the truth
  Eigen::ArrayXd coverage;  ///< share of 95 % intervals that hold the truth
  Eigen::ArrayXd bound;     ///< the bound itself, a variance
  int converged = 0;
};

/// What one study of the dynamometer measures beside the moment.
struct DynamometerStudy {
  bool fascicle = false;        ///< BRA.fiber_length by ultrasound, 0.3 mm of noise
  bool shoulder = false;        ///< the shoulder is turned instead, the elbow is free: its angle
  double momentNoise = 0.4;     ///< [N·m]
  double fascicleNoise = 3e-4;  ///< [m]
  double angleNoise = 0.5 / 180 * std::numbers::pi;  ///< [rad]
};

class Dynamometer {
 public:
  explicit Dynamometer(const DynamometerStudy& study)
      : study_(study),
        model_(readOsim(std::string(FISHERHILL_SOURCE_DIR) + "/models/elbow8.osim")) {
    driven_ = study.shoulder ? "shoulder_elv" : "elbow_flexion";
    if (study.shoulder) {  // a spring holds the elbow within its range
      options_.skeleton.freeCoordinates = {"elbow_flexion"};
      model_.springForces.push_back({"hold", "elbow_flexion", 8, 1.2, 0.4});
    }
    options_.skeleton.freeCoordinates.push_back(driven_);
    options_.prescribed = {driven_};
  }

  /// Parameters and their true values.
  std::vector<std::pair<std::string, double>> truth() const {
    return {{"BIClong.max_isometric_force", 700},
            {"BRA.max_isometric_force", 900},
            {"TRIlong.max_isometric_force", 750},
            study_.shoulder ? std::pair<std::string, double>{"hand.mass", 0.65}
                            : std::pair<std::string, double>{"TRI.radius", 0.0172}};
  }

  const Model& model() const { return model_; }
  const SystemOptions& options() const { return options_; }

  /// Exact trials of the model with the true values.
  std::vector<Trial> trials(const TrialSetOptions& set) const {
    std::vector<Trial> list;
    if (study_.shoulder) {
      for (const double frequency : {0.5, 0.8}) list.push_back(blank(30, 0, frequency));
    } else {
      for (const double angle : {40.0, 100.0}) list.push_back(blank(angle, 0, 0));
      list.push_back(blank(40, 45, 0));
      list.push_back(blank(110, -45, 0));
    }
    const TrialSet exact(model_, options_, list, set);
    Eigen::VectorXd theta(static_cast<Eigen::Index>(truth().size()));
    for (Eigen::Index i = 0; i < theta.size(); ++i) {
      theta[i] = truth()[static_cast<std::size_t>(i)].second;
    }
    const Eigen::MatrixXd y = exact.predictor().outputs(theta);
    Eigen::Index at = 0;
    for (const MeasuredSeries& series : exact.series()) {
      const Eigen::VectorXd values = y.middleCols(at, series.values.size()).transpose();
      at += series.values.size();
      Trial& trial = list[series.trial];
      for (MeasuredChannel& channel : trial.measured) {
        if (channel.what == series.what) channel.values = values;
      }
    }
    return list;
  }

  Trial noisy(Trial trial, std::uint64_t seed, std::uint64_t stream) const {
    info::RandomStream random(seed, stream);
    for (MeasuredChannel& channel : trial.measured) {
      if (channel.what.isCoordinate()) continue;
      for (double& value : channel.values) value += noiseOf(channel.what) * random.normal();
    }
    for (MeasuredChannel& motion : trial.measured) {  // the first value is the start
      if (!motion.what.isCoordinate()) continue;
      for (Eigen::Index k = 1; k < motion.values.size(); ++k) {
        motion.values[k] += study_.angleNoise * random.normal();
      }
    }
    return trial;
  }

  double noiseOf(const Observable& what) const {
    if (what.kind == Observable::Kind::moment) return study_.momentNoise;
    if (what.kind == Observable::Kind::fibreLength) return study_.fascicleNoise;
    return study_.angleNoise;
  }

 private:
  /// Flexors and extensors contract one after the other.
  Trial blank(double degrees, double degreesPerSecond, double frequency) const {
    constexpr double duration = 1.5, every = 0.01;
    const auto rows = static_cast<Eigen::Index>(std::lround(duration / every)) + 1;
    Trial trial;
    trial.file = "dynamometer";
    trial.times = Eigen::VectorXd::LinSpaced(rows, 0, duration);
    for (const Muscle& muscle : model_.muscles) {
      if (muscle.enabled) trial.muscles.push_back(muscle.name);
    }
    trial.excitations.resize(rows, static_cast<Eigen::Index>(trial.muscles.size()));
    const double strength = study_.shoulder ? 0.08 : 0.5;
    for (Eigen::Index m = 0; m < trial.excitations.cols(); ++m) {
      const std::string& name = trial.muscles[static_cast<std::size_t>(m)];
      const bool extends = name.starts_with("TRI") || name == "ANC";
      for (Eigen::Index k = 0; k < rows; ++k) {
        const double t = trial.times[k] - (extends ? 0.8 : 0.2);
        const double pulse = t > 0 && t < 0.5 ? std::pow(std::sin(2 * std::numbers::pi * t), 2) : 0;
        trial.excitations(k, m) = 0.02 + strength * pulse * (name == "BRA" ? 0.7 : 1);
      }
    }
    MeasuredChannel course{ofCoordinate(driven_), trial.times, {}};
    course.values = (degrees + degreesPerSecond * trial.times.array() +
                     15 * (2 * std::numbers::pi * frequency * trial.times.array()).sin()) /
                    180 * std::numbers::pi;
    trial.prescribed = {course};
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(rows);
    trial.measured.push_back({{Observable::Kind::moment, driven_, 0}, trial.times, none});
    if (study_.fascicle) {
      trial.measured.push_back({{Observable::Kind::fibreLength, "BRA", 0}, trial.times, none});
    }
    if (study_.shoulder) {
      trial.measured.insert(trial.measured.begin(),
                            {ofCoordinate("elbow_flexion"), trial.times,
                             Eigen::VectorXd::Constant(rows, 60 / 57.29577951)});
    }
    return trial;
  }

  DynamometerStudy study_;
  Model model_;
  SystemOptions options_;
  std::string driven_;
};

inline TorqueStatistics repeatTorqueCalibration(int repetitions, const DynamometerStudy& study) {
  const Dynamometer dynamometer(study);
  CalibrationOptions options;
  for (const auto& [name, value] : dynamometer.truth()) options.trials.parameters.push_back(name);
  options.priors = false;
  const std::vector<Trial> exact = dynamometer.trials(options.trials);
  const auto p = static_cast<Eigen::Index>(dynamometer.truth().size());
  Eigen::VectorXd theta(p);
  for (Eigen::Index i = 0; i < p; ++i)
    theta[i] = dynamometer.truth()[static_cast<std::size_t>(i)].second;

  TorqueStatistics result;
  {
    const TrialSet set(dynamometer.model(), dynamometer.options(), exact, options.trials);
    Eigen::MatrixXd gamma = set.predictor().withSensitivities(theta).gamma;
    Eigen::Index at = 0;
    for (const MeasuredSeries& series : set.series()) {
      gamma.middleRows(at, series.values.size()) /= dynamometer.noiseOf(series.what);
      at += series.values.size();
    }
    result.bound = (gamma.transpose() * gamma).inverse().diagonal().array();
  }
  Eigen::ArrayXXd estimates(p, repetitions), covered(p, repetitions);
  Eigen::ArrayXd converged(repetitions);
  info::parallelFor(repetitions, 0, [&](int i) {
    std::vector<Trial> noisy;
    for (std::size_t t = 0; t < exact.size(); ++t) {
      noisy.push_back(dynamometer.noisy(exact[t], 4100 + t, static_cast<std::uint64_t>(i)));
    }
    const TrialSet set(dynamometer.model(), dynamometer.options(), noisy, options.trials);
    const Calibration found = calibrate(set, nullptr, options);
    converged[i] = found.converged;
    if (!found.converged) fmt::print("repetition {}: {}\n", i, info::describe(found.why));
    for (Eigen::Index k = 0; k < p; ++k) {
      const CalibratedParameter& one = found.parameters.at(static_cast<std::size_t>(k));
      estimates(k, i) = one.value;
      covered(k, i) = one.identifiable && one.lower <= theta[k] && theta[k] <= one.upper;
    }
  });
  result.converged = static_cast<int>(converged.sum());
  const Eigen::ArrayXd mean = estimates.rowwise().mean();
  const Eigen::ArrayXd variance =
      (estimates.colwise() - mean).square().rowwise().sum() / (repetitions - 1);
  result.bias = (mean - theta.array()) / (variance / repetitions).sqrt();
  result.variance = variance / result.bound;
  result.coverage = covered.rowwise().mean();
  fmt::print("{} repetitions, {} converged\n", repetitions, result.converged);
  for (Eigen::Index k = 0; k < p; ++k) {
    fmt::print(
        "{:<28} sd {:.3g}  bias {:+.2f} standard errors  variance/bound {:.3f}  coverage "
        "{:.1f} %\n",
        dynamometer.truth()[static_cast<std::size_t>(k)].first, std::sqrt(variance[k]),
        result.bias[k], result.variance[k], result.coverage[k] * 100);
  }
  return result;
}

}  // namespace bio::fixtures
