#include "bio/sensitivity/cost_gradient.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "sensitivity/adjoint_pass.h"
#include "sensitivity/parameter_directions.h"

namespace bio {
namespace {

void checkSlopes(const CostOfMotion& slopes, const Trajectory& motion) {
  for (const Eigen::MatrixXd* one : {&slopes.q, &slopes.qDot}) {
    if (one->rows() != motion.q.rows() || one->cols() != motion.q.cols()) {
      throw std::invalid_argument(
          fmt::format("slopes of the cost: {} × {}, must be as the motion, {} × {}", one->rows(),
                      one->cols(), motion.q.rows(), motion.q.cols()));
    }
  }
}

CostGradient unknownGradient(CostGradient result, Eigen::Index parameters,
                             const ExcitationSignal& driven) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  result.cost = nan;
  result.gradient.setConstant(parameters, nan);
  result.startCoordinate.setConstant(result.motion.q.rows(), nan);
  result.startSpeed = result.startCoordinate;
  result.excitation.setConstant(driven.numMuscles(),
                                static_cast<Eigen::Index>(driven.times().size()), nan);
  return result;
}

}  // namespace

CostGradient simulateWithGradient(const MusculoskeletalSystem& system,
                                  const ParameterCatalogue& catalogue,
                                  const ParameterCatalogue::Setting& setting,
                                  const std::vector<std::size_t>& wanted,
                                  const ExcitationSignal& trial, const SimulationOptions& options,
                                  const MotionCost& cost) {
  return simulateWithGradient(system, setting, stepping::directionsOf(catalogue, setting, wanted),
                              trial, options, cost);
}

CostGradient simulateWithGradient(const MusculoskeletalSystem& system,
                                  const ParameterCatalogue::Setting& setting,
                                  const std::vector<ParameterDirection>& wanted,
                                  const ExcitationSignal& trial, const SimulationOptions& given,
                                  const MotionCost& cost) {
  SimulationOptions own;
  const SimulationOptions& options = stepping::withOwnForces(system, given, own);
  if (!isVariational(options.integrator)) {
    throw std::invalid_argument(
        "gradient of a cost: integrator must be vi-adaptive, vi or vi-left");
  }
  const ExcitationSignal driven = drivenExcitation(trial, muscleNames(system), setting.mapping);
  const SystemState start = startOf(system, setting, driven, options.startTime);
  stepping::checkSimulation(system, driven, start, options);
  stepping::StepTape tape;
  CostGradient result;
  result.motion = stepping::simulateVariational(system, driven, start, options, &tape);
  stepping::completeStates(system, driven, result.motion);
  stepping::addReactions(system, driven, options, result.motion);
  const stepping::StopWatch watch;
  const CostOfMotion slopes = cost(result.motion);
  result.cost = slopes.value;
  const auto parameters = static_cast<Eigen::Index>(wanted.size());
  if (!std::isfinite(slopes.value)) {
    return unknownGradient(std::move(result), parameters, driven);
  }
  checkSlopes(slopes, result.motion);
  const stepping::ParameterEffects effects(system, setting, wanted);
  stepping::withCoordinates(system.skeleton(), [&](auto N) {
    stepping::AdjointPass<decltype(N)::value> pass(system, effects, setting, driven, parameters,
                                                   options);
    pass.run(start, tape, trial, setting.mapping, slopes, result);
  });
  result.wallSeconds = watch.seconds();
  return result;
}

}  // namespace bio
