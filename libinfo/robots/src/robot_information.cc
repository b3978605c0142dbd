#include "robots/robot_information.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "info/information/fisher.h"
#include "info/information/symmetric_eigen.h"

namespace info::robot {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct NamedMethod {
  Method method;
  const char* name;
  int maxIterations;
};
constexpr NamedMethod kMethods[] = {{Method::gradientDescent, "gradient descent", 1000},
                                    {Method::iteratedLeastSquares, "iterated least squares", 100},
                                    {Method::newtonRaphson, "Newton-Raphson", 100}};

MatrixXd fisherOf(const PlannedExperiment& plan) {
  return fisherInformation(plan.predictor.withSensitivities(plan.truth).gamma, plan.covariance);
}

/// @param knownMinimum empty: found by Newton–Raphson from the true values
std::vector<EstimatorConvergence> waysToMinimum(const PlannedExperiment& experiment,
                                                const MatrixXd& data,
                                                const std::optional<VectorXd>& knownMinimum,
                                                const char* doing, const WorkProgress& progress) {
  const LeastSquares problem(experiment.predictor, {data, experiment.covariance},
                             experiment.parameters);
  EstimateOptions options;
  VectorXd minimum;
  if (knownMinimum) {
    minimum = *knownMinimum;
  } else {
    options.method = Method::newtonRaphson;
    options.decrementTolerance = 0;
    minimum = estimate(problem, experiment.truth, options).parameters;
    options = {};
  }
  std::vector<EstimatorConvergence> all;
  for (const NamedMethod& method : kMethods) {
    options.method = method.method;
    options.maxIterations = method.maxIterations;
    if (progress)
      options.progress = [&](const EstimateProgress& p) {
        progress(doing, static_cast<double>(p.iteration) / method.maxIterations);
        return true;
      };
    Estimate found = estimate(problem, options);
    auto rows = convergenceTable(found, minimum);
    // over all iterations, since single steps of gradient descent zigzag
    const double meanRatio =
        std::pow(rows.back().error / rows.front().error, 1.0 / std::max(1, found.iterations));
    all.push_back({method.name, std::move(found), std::move(rows), meanRatio});
  }
  return all;
}

}  // namespace

PlannedExperiment plannedExperiment(const ExperimentRequest& request) {
  if (!request.pendulum && (request.bothMasses || request.undamped))
    throw std::invalid_argument(
        "unknown masses and the absence of damping: must be of the double pendulum");
  if (request.undamped && !request.bothMasses)
    throw std::invalid_argument("undamped: must not be with an unknown damping");
  const bool own = !request.amplitude && !request.period;
  const double period = request.period.value_or(5);
  if (!request.pendulum)
    return suspendedMassExperiment(
        own ? suspendedMassStart()
            : cosineMotion(request.amplitude.value_or(0.0476), period, experimentDuration, 100, 1));
  const CartMotion motion =
      own ? doublePendulumStart()
          : cosineMotion(request.amplitude.value_or(0.05), period, experimentDuration, 30, 2);
  return request.bothMasses ? doublePendulumExperiment(motion, DoublePendulumUnknowns::bothMasses,
                                                       request.undamped ? 0.0 : 5e-4)
                            : doublePendulumExperiment(motion);
}

ExperimentInformation informationOf(const PlannedExperiment& plan) {
  ExperimentInformation found;
  found.information = fisherOf(plan);
  std::vector<Parameter> atTruth = plan.parameters;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < atTruth.size(); ++i) {
    atTruth[i].start = plan.truth[static_cast<Eigen::Index>(i)];
    names.push_back(atTruth[i].name);
  }
  found.identifiability = identifiability(found.information, atTruth);
  found.eigenvalues = symmetricEigenvalues(found.information);
  if (found.identifiability.rank == std::ssize(atTruth))
    found.bound = cramerRaoBound(found.information, names);
  return found;
}

MatrixXd boundOf(const PlannedExperiment& plan) {
  return cramerRaoBound(fisherOf(plan));
}

MonteCarloResult simulateTrials(const PlannedExperiment& plan, int trials, std::uint64_t seed,
                                int threads, const char* doing, const WorkProgress& progress) {
  MonteCarloOptions options;
  options.trials = trials;
  options.seed = seed;
  options.threads = threads;
  options.startSpread = 1;
  if (progress)
    options.progress = [&](int done, int all) {
      progress(doing, static_cast<double>(done) / all);
      return true;
    };
  return monteCarlo(plan.predictor, plan.truth, plan.covariance, plan.parameters, options);
}

ConvergenceComparison compareEstimators(const PlannedExperiment& quiet, std::uint64_t seed,
                                        const WorkProgress& progress) {
  const PlannedExperiment lively = suspendedMassExperiment(suspendedMassLively());
  return {waysToMinimum(quiet, quiet.predictor.outputs(quiet.truth), std::optional(quiet.truth),
                        "quiet motion", progress),
          waysToMinimum(lively, simulateMeasurement(lively, seed), {}, "lively motion", progress)};
}

}  // namespace info::robot
