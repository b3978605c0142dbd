#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "info/estimation/convergence.h"
#include "info/estimation/monte_carlo.h"
#include "info/information/identifiability.h"
#include "robots/robot_experiments.h"
#include "robots/robot_work.h"

/// Information of a robot's experiment about its parameters, and how estimators perform on it.
namespace info::robot {

inline constexpr double experimentDuration = 5;  ///< as in the thesis [s]

/// An experiment of experimentDuration with the cart motion amplitude·(1 − cos 2πt/period).
struct ExperimentRequest {
  bool pendulum = true;  ///< else the suspended mass
  std::optional<double> amplitude = {},
                        period = {};  ///< [m] > 0 and [s] > 0; empty: those of the thesis
  bool bothMasses = false;            ///< θ = (m1, m2) in place of (m1, c); pendulum only
  bool undamped = false;              ///< c = 0; with bothMasses only
};

/// The double pendulum sampled at 30 Hz, the suspended mass at 100 Hz.
/// @throws std::invalid_argument for a request that breaks a rule
PlannedExperiment plannedExperiment(const ExperimentRequest& request);

/// Information of an experiment at the true parameters.
struct ExperimentInformation {
  Eigen::MatrixXd information;
  IdentifiabilityReport identifiability;
  Eigen::MatrixXd bound;        ///< Cramér–Rao bound; empty if a combination is undetermined
  Eigen::VectorXd eigenvalues;  ///< of `information`, rising
};
ExperimentInformation informationOf(const PlannedExperiment& plan);

/// Cramér–Rao bound of an experiment at the true parameters.
Eigen::MatrixXd boundOf(const PlannedExperiment& plan);

/// Simulated experiments with independent noise, each estimated from an initial guess drawn between
/// 0 and 2 times the true values.
/// @param threads number of threads; 0: all cores
/// @param doing told to `progress`
MonteCarloResult simulateTrials(const PlannedExperiment& plan, int trials, std::uint64_t seed,
                                int threads, const char* doing = "trials",
                                const WorkProgress& progress = {});

/// One estimator's way to the minimum.
struct EstimatorConvergence {
  std::string method;  ///< "gradient descent", "iterated least squares" or "Newton-Raphson"
  Estimate estimate;
  std::vector<ConvergenceRow> rows;
  double meanRatio;  ///< of the errors of successive iterations, over all of them
};

/// Three estimators on the suspended mass.
struct ConvergenceComparison {
  std::vector<EstimatorConvergence> quiet;   ///< the given motion, exact data
  std::vector<EstimatorConvergence> lively;  ///< suspendedMassLively(), one recording with noise
};

/// Gradient descent, iterated least squares and Newton–Raphson, on a motion with exact data as in
/// the thesis, and on a livelier motion with one noisy recording.
/// @param quiet of the suspended mass
/// @param seed of the noise
ConvergenceComparison compareEstimators(const PlannedExperiment& quiet, std::uint64_t seed,
                                        const WorkProgress& progress = {});

}  // namespace info::robot
