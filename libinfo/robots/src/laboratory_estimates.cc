#include "robots/laboratory_estimates.h"

#include <algorithm>
#include <mutex>
#include <vector>

#include "info/parallel_for.h"

namespace info::robot {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;

constexpr int kRecordings = 25;

LeastSquares problemOf(const PlannedExperiment& plan, const MatrixXd& recording) {
  return {plan.predictor, {recording, plan.covariance}, plan.parameters};
}

}  // namespace

LaboratoryRobot doublePendulumInLaboratory(const LaboratoryEffects& effects) {
  const Vector2d truth(0.110, 0.180);
  return {[](const CartMotion& motion) { return doublePendulumExperiment(motion); },
          [=](const CartMotion& motion, std::uint64_t seed) {
            return measureDoublePendulum(motion, truth, effects, seed);
          },
          truth};
}

LaboratoryRobot suspendedMassInLaboratory(const LaboratoryEffects& effects) {
  const Vector2d truth(0.124, 0.50);
  return {[](const CartMotion& motion) { return suspendedMassExperiment(motion); },
          [=](const CartMotion& motion, std::uint64_t seed) {
            return measureSuspendedMass(motion, truth, effects, seed);
          },
          truth};
}

LaboratoryEstimates estimateInLaboratory(const LaboratoryRobot& robot, const CartMotion& motion,
                                         int recordings, std::uint64_t seed, int threads,
                                         const WorkProgress& progress) {
  const PlannedExperiment plan = robot.experiment(motion);
  const auto errorOf = [&](const Estimate& found) {
    return Vector2d((found.parameters.cwiseQuotient(robot.truth).array() - 1).abs());
  };
  LaboratoryEstimates out{problemOf(plan, robot.measure(motion, seed)), {}, {}, {}};
  out.first = estimate(out.problem);
  out.error = errorOf(out.first);
  std::vector<Vector2d> errors(static_cast<std::size_t>(recordings), out.error);
  std::mutex mutex;
  int done = 1;
  parallelFor(recordings - 1, threads, [&](int k) {
    const auto i = static_cast<std::size_t>(k) + 1;
    errors[i] = errorOf(estimate(problemOf(plan, robot.measure(motion, seed + i))));
    const std::lock_guard lock(mutex);
    if (progress) progress("laboratory", static_cast<double>(++done) / recordings);
  });
  for (Index i : {0, 1}) {
    std::vector<double> one;
    for (const Vector2d& error : errors) one.push_back(error[i]);
    std::nth_element(one.begin(), one.begin() + recordings / 2, one.end());
    out.medianError[i] = one[std::size_t(recordings / 2)];
  }
  return out;
}

LaboratoryComparison compareInLaboratory(const LaboratoryRobot& robot,
                                         const LaboratoryEffects& effects, const CartMotion& before,
                                         const CartMotion& after, std::uint64_t seed, int threads,
                                         const WorkProgress& progress) {
  const std::vector<Parameter> parameters = robot.experiment(before).parameters;
  return {effects,
          kRecordings,
          Vector2d(parameters[0].start, parameters[1].start),
          robot.truth,
          estimateInLaboratory(robot, before, kRecordings, seed, threads, progress),
          estimateInLaboratory(robot, after, kRecordings, seed, threads, progress)};
}

}  // namespace info::robot
