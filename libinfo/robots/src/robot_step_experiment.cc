#include <stdexcept>

#include "robots/instances.h"
#include "robots/robot_experiments.h"

namespace info {

PlannedExperiment doublePendulumStepExperiment(const std::vector<double>& position, double timeStep,
                                               std::size_t stepsPerSample) {
  if (stepsPerSample < 1 || position.size() <= stepsPerSample)
    throw std::invalid_argument("cart motion: there must be at least one sample");
  CartDoublePendulum<> system;
  system.dampingUnit = 1e-2;
  using Map = DoublePendulumSteps;
  const Map map(system, timeStep);
  std::vector<InputOf<Map>> inputs;
  for (double x : position) inputs.push_back(InputOf<Map>(x));
  return {makePredictor(map, Experiment<Map>{StateOf<Map>::Zero(), inputs,
                                             stepsEvery(stepsPerSample, stepsPerSample,
                                                        position.size() - 1)}),
          OutputCovariance(Eigen::Vector2d(1.12e-4, 4.79e-4).asDiagonal().toDenseMatrix()),
          {{.name = "m1", .unit = "kg", .start = 0.085, .lower = 1e-3},
           {.name = "c", .unit = "10e-3 kg m²/s", .start = 0.05}},
          Eigen::Vector2d(0.085, 0.05)};
}

}  // namespace info
