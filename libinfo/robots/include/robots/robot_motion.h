#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "info/design/projected_motion.h"
#include "robots/laboratory_estimates.h"
#include "robots/robot_information.h"

/// The motion of a robot that is most informative about two of its parameters.
namespace info::robot {

/// The system to optimise, and the initial motion.
struct MotionRequest {
  bool pendulum = true;   ///< else the suspended mass
  bool discrete = false;  ///< the variational integrator's motion (chapter 5)
  std::optional<double> amplitude = {},
                        period = {};   ///< of the initial motion, [m] ≥ 0 and [s] > 0
  std::optional<double> perturb = {};  ///< added to the initial input [unit of the input] > 0
  std::vector<double> warmStart = {};  ///< the initial inputs (numInputs); empty: none

  std::optional<InformationWeights> objective = {};      ///< else the task's own
  std::optional<double> inputWeight = {};                ///< R, else the task's own
  std::optional<std::pair<double, double>> limits = {};  ///< of the input, lower and upper
  std::optional<double> tolerance = {};  ///< |DJ·ζ| at which the search ends, ≥ 0
  std::optional<int> iterations = {};    ///< at most, ≥ 0
  int stepsPerSample = 1;                ///< of the discrete motion, ≥ 1

  std::optional<RobustRule> robust = {};         ///< over these values of θ
  std::vector<Eigen::Vector2d> candidates = {};  ///< empty: θ, and each parameter ±30 %
  std::optional<LaboratoryEffects> laboratory =
      {};  ///< try both motions there; not with `discrete`

  int trials = 300;        ///< simulated experiments of the double pendulum, ≥ 1
  std::uint64_t seed = 1;  ///< of the perturbation, the trials and the laboratory
  int threads = 1;         ///< 0: all cores
  WorkProgress progress = {};
};

/// The number of inputs of the initial motion.
std::size_t numInputs(const MotionRequest& request);

/// A motion at the times k·step, from continuous or discrete time; of several candidates that of
/// the first.
struct TimedMotion {
  double step;  ///< [s]
  std::vector<Eigen::VectorXd> x, u;
  std::vector<Eigen::MatrixXd> grown;  ///< information up to each time
};

/// λ_min for every set of parameter values, for three motions.
struct RobustOutcome {
  std::vector<Eigen::Vector2d> candidates;
  Eigen::VectorXd initial, nominal, robust;
};

/// A motion of the double pendulum as an experiment, and simulated trials of it.
struct MotionTrials {
  PlannedExperiment plan;
  MonteCarloResult result;
};

/// Two estimators on exact data of a motion of the suspended mass.
struct ExactEstimates {
  LeastSquares problem;
  Estimate gradientDescent, iteratedLeastSquares;
};

/// A search and its results.
struct MotionResult {
  TimedMotion before, after;
  std::vector<std::string> states;  ///< names of the elements of x, with units
  SearchResult search;
  double secondsPerIteration = 0;
  MotionDesign design;                      ///< with the request's objective, weights and limits
  std::vector<Parameter> unknown;           ///< names and units of the parameters
  Eigen::MatrixXd boundBefore, boundAfter;  ///< Cramér–Rao bounds of one experiment
  std::optional<RobustOutcome> robust;

  std::optional<MotionTrials> trialsBefore, trialsAfter;  ///< double pendulum
  std::optional<ExactEstimates> exactBefore, exactAfter;  ///< suspended mass
  std::optional<LaboratoryComparison> laboratory;
};

/// Searches the motion and tries both motions. With `robust` the search is repeated for θ alone,
/// for comparison. No progress of the search is a result.
/// @throws NoInformation if the initial motion has no information about a combination of parameters
/// @throws std::invalid_argument, std::domain_error for a request that breaks a rule
MotionResult optimiseMotion(const MotionRequest& request);

/// Time of an iteration of the double pendulum's search in continuous time at this step [s], for
/// comparison.
double secondsPerContinuousIteration(double step);

}  // namespace info::robot
