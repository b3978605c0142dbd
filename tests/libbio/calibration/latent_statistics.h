#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "bio/calibration/calibrate.h"
#include "bio/tables/latent_excitation.h"
#include "info/parallel_for.h"
#include "info/probability/random_stream.h"
#include "support/synthetic_elbow.h"

// Calibrations repeated on synthetic trials of an elbow in which one muscle has no electrode: its
// column is that of another muscle, and what it was excited by in truth is drawn anew from the
// declared prior each time, together with noise of 0.5° on the angle. Parameters have no priors.
namespace bio::fixtures {

/// Wilson's 95 % interval of a share out of n.
inline std::pair<double, double> wilson(double share, double n) {
  constexpr double z = 1.959963984540054;
  const double middle = share + z * z / (2 * n), width = 1 + z * z / n;
  const double half = z * std::sqrt(share * (1 - share) / n + z * z / (4 * n * n));
  return {(middle - half) / width, (middle + half) / width};
}

struct LatentStudy {
  LatentDeclaration unrecorded = {"BRD", 0.5, 0.5};
  std::string electrode = "BIClong";  ///< whose column it shares
  std::vector<std::pair<std::string, double>> truth = {{"hand.mass", 0.55},
                                                       {"BRA.max_isometric_force", 900}};
};

/// What one way to calibrate finds.
struct LatentOutcome {
  int converged = 0, failed = 0;  ///< failed: without an estimate, and not counted below
  Eigen::ArrayXd bias;            ///< of the mean, in its own standard errors
  Eigen::ArrayXd rms;             ///< of the errors, in the parameter's unit
  Eigen::ArrayXd sd;              ///< that the calibrations claim: root mean square
  Eigen::ArrayXd told;            ///< share of repetitions with an interval
  Eigen::ArrayXd coverage;        ///< share of those intervals (95 %) that hold the truth
};
struct LatentStatistics {
  int repetitions = 0;
  LatentOutcome latent, shared;
};

class LatentElbow {
 public:
  explicit LatentElbow(const LatentStudy& study) : study_(study) {
    for (const auto& [name, value] : study.truth) names_.push_back(name);
    for (const auto& [shipped, duration] :
         {std::pair{"curl_slow", 2.5}, std::pair{"curl_fast", 2.0}}) {
      Trial trial = elbow_.trial(shipped, duration, {}, 40, 2);
      trial.excitations.col(columnOf(trial, study.unrecorded.muscle)) =
          trial.excitations.col(columnOf(trial, study.electrode)).eval();
      trial.latent = {study.unrecorded};
      trials_.push_back(std::move(trial));
    }
  }

  /// Trials as they are recorded, with an excitation of their own of the muscle without electrode.
  std::vector<Trial> recorded(std::uint64_t stream) const {
    info::RandomStream random(8200, stream);
    std::vector<Trial> driven = trials_;
    for (Trial& trial : driven) {
      LatentExcitation latent =
          latentExcitation(study_.unrecorded, trial.times[0], trial.times[trial.times.size() - 1]);
      for (double& c : latent.values) c = latent.sd * random.normal();
      auto column = trial.excitations.col(columnOf(trial, study_.unrecorded.muscle));
      column = withLatent(trial.times, column.transpose(), latent).transpose().eval();
    }
    TrialSetOptions options;
    options.parameters = names_;
    const TrialSet exact(elbow_.model, SyntheticElbow::options(), driven, options);
    const Eigen::RowVectorXd y = exact.predictor().outputs(theta());
    std::vector<Trial> result = trials_;
    Eigen::Index at = 0;
    for (std::size_t i = 0; i < result.size(); ++i) {
      Eigen::VectorXd& values = result[i].measured[0].values;
      values = y.segment(at, values.size()).transpose();
      at += values.size();
      result[i] = SyntheticElbow::noisy(result[i], 0.5, 8300 + i, stream);
    }
    return result;
  }

  Calibration calibrated(const std::vector<Trial>& trials, bool latent) const {
    CalibrationOptions options;
    options.trials.parameters = names_;
    options.trials.latent = latent;
    options.priors = false;
    return calibrate(TrialSet(elbow_.model, SyntheticElbow::options(), trials, options.trials),
                     nullptr, options);
  }

  Eigen::VectorXd theta() const {
    Eigen::VectorXd values(static_cast<Eigen::Index>(names_.size()));
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      values[i] = study_.truth[static_cast<std::size_t>(i)].second;
    }
    return values;
  }

 private:
  static Eigen::Index columnOf(const Trial& trial, const std::string& muscle) {
    return std::find(trial.muscles.begin(), trial.muscles.end(), muscle) - trial.muscles.begin();
  }

  LatentStudy study_;
  SyntheticElbow elbow_;
  std::vector<std::string> names_;
  std::vector<Trial> trials_;  ///< with the shared column
};

inline LatentStatistics repeatLatentCalibration(int repetitions, const LatentStudy& study = {}) {
  const LatentElbow elbow(study);
  const Eigen::VectorXd theta = elbow.theta();
  const Eigen::Index p = theta.size();
  LatentStatistics result;
  result.repetitions = repetitions;
  for (const bool latent : {true, false}) {
    Eigen::ArrayXXd errors = Eigen::ArrayXXd::Zero(p, repetitions), sds = errors, told = errors,
                    covered = errors;
    Eigen::ArrayXd converged = Eigen::ArrayXd::Zero(repetitions), estimated = converged;
    info::parallelFor(repetitions, 0, [&](int i) {
      const Calibration found =
          elbow.calibrated(elbow.recorded(static_cast<std::uint64_t>(i)), latent);
      converged[i] = found.converged;
      estimated[i] = found.failure.empty();
      if (!found.failure.empty()) return;
      for (Eigen::Index k = 0; k < p; ++k) {
        const CalibratedParameter& one = found.parameters.at(static_cast<std::size_t>(k));
        errors(k, i) = one.value - theta[k];
        if (!one.identifiable || one.atBound) continue;
        told(k, i) = 1;
        sds(k, i) = one.sd;
        covered(k, i) = one.lower <= theta[k] && theta[k] <= one.upper;
      }
    });
    LatentOutcome& outcome = latent ? result.latent : result.shared;
    outcome.converged = static_cast<int>(converged.sum());
    const double n = estimated.sum();
    outcome.failed = repetitions - static_cast<int>(n);
    const Eigen::ArrayXd mean = errors.rowwise().sum() / n;
    outcome.rms = (errors.square().rowwise().sum() / n).sqrt();
    const Eigen::ArrayXd variance = (outcome.rms.square() - mean.square()) * n / (n - 1);
    outcome.bias = mean / (variance / n).sqrt();
    const Eigen::ArrayXd count = told.rowwise().sum();
    outcome.told = count / n;
    outcome.sd = (sds.square().rowwise().sum() / count).sqrt();
    outcome.coverage = covered.rowwise().sum() / count;
    fmt::print("{}: {} repetitions, {} converged, {} failed\n",
               latent ? "latent" : "shared electrode", repetitions, outcome.converged,
               outcome.failed);
    for (Eigen::Index k = 0; k < p; ++k) {
      const auto [low, high] = wilson(outcome.coverage[k], count[k]);
      fmt::print(
          "  {:<28} RMS error {:.3g}  claimed sd {:.3g}  bias {:+.2f} standard errors  {:.0f} "
          "intervals, coverage {:.1f} % ({:.1f} to {:.1f})\n",
          study.truth[static_cast<std::size_t>(k)].first, outcome.rms[k], outcome.sd[k],
          outcome.bias[k], count[k], 100 * outcome.coverage[k], 100 * low, 100 * high);
    }
  }
  return result;
}

}  // namespace bio::fixtures
