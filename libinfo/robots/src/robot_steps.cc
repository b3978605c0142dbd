#include <cmath>
#include <numbers>

#include "robots/instances.h"
#include "robots/robot_designs.h"

namespace info {

ExtendedStepMap doublePendulumSteps(double timeStep, double dampingUnit,
                                    const Vector<double, 2>& theta) {
  CartDoublePendulum<> system;
  system.dampingUnit = dampingUnit;
  return extend(DoublePendulumSteps(system, timeStep), theta);
}

StepTask doublePendulumStepTask(double timeStep, std::size_t stepsPerSample) {
  StepTask task{doublePendulumSteps(timeStep, 1e-2, {0.085, 0.05}), {}};
  StepDesign& d = task.design;
  d.timeStep = timeStep;
  d.x0 = Eigen::VectorXd::Zero(4);
  const auto steps = static_cast<std::size_t>(std::lround(5 / timeStep));
  for (std::size_t k = 0; k <= steps; ++k)
    d.desiredInput.push_back(Eigen::VectorXd::Constant(
        1, 0.01 * std::sin(2 * std::numbers::pi * static_cast<double>(k) * timeStep / 5)));
  d.outputCovariance = Eigen::Vector2d(1.12e-4, 4.79e-4).asDiagonal();
  d.stepsPerSample = stepsPerSample;
  d.information.e = 1.25e4;
  d.inputWeight = d.rateWeight = Eigen::MatrixXd::Constant(1, 1, 0.01);
  // x = (φ1, φ2, p1, p2), the cart, ψ of m1, ψ of c
  Eigen::VectorXd model(13);
  model << Eigen::VectorXd::Constant(5, 1e-3), Eigen::VectorXd::Constant(4, 1e-2),
      Eigen::VectorXd::Constant(4, 1);
  d.modelState = model.asDiagonal();
  d.modelInput = Eigen::MatrixXd::Constant(1, 1, 0.02);
  d.modelRate = Eigen::MatrixXd::Constant(1, 1, 0.11);
  d.gainState = Eigen::MatrixXd::Identity(5, 5);
  d.gainInput = Eigen::MatrixXd::Identity(1, 1);
  return task;
}

}  // namespace info
