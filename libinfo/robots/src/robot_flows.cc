#include <cmath>
#include <numbers>

#include "robots/instances.h"
#include "robots/robot_designs.h"

namespace info {
namespace {

// The cart's acceleration of x(t) = amplitude(1 − cos 2πt/5) at the nodes of 5 s.
std::vector<Eigen::VectorXd> cosineStart(double amplitude, double step) {
  std::vector<Eigen::VectorXd> inputs;
  const double omega = 2 * std::numbers::pi / 5;
  const auto steps = static_cast<std::size_t>(std::lround(5 / step));
  for (std::size_t k = 0; k <= steps; ++k)
    inputs.push_back(Eigen::VectorXd::Constant(
        1, amplitude * omega * omega * std::cos(omega * static_cast<double>(k) * step)));
  return inputs;
}

}  // namespace

ExtendedFlow doublePendulumFlow(const Vector<double, 2>& theta) {
  return extendFlow(CartDoublePendulum<>{}, theta);
}

ExtendedFlow suspendedMassFlow(const Vector<double, 2>& theta) {
  return extendFlow(SuspendedMass{}, theta);
}

FlowTask doublePendulumFlowTask(double step) {
  FlowTask task{doublePendulumFlow(), {}};
  FlowDesign& d = task.design;
  d.step = step;
  d.x0 = Eigen::VectorXd::Zero(6);
  d.desiredInput = cosineStart(0.05, step);
  d.outputDensity = Eigen::Vector2d(1.12e-4, 4.79e-4).asDiagonal();
  d.information.e = 100;
  d.inputWeight = d.modelInput = d.gainInput = Eigen::MatrixXd::Identity(1, 1);
  Eigen::VectorXd model(18), gain(6);
  model << Eigen::VectorXd::Constant(6, 1e-3), Eigen::VectorXd::Ones(12);
  gain << 1, 1, 1, 1, 0.1, 0.1;
  d.modelState = model.asDiagonal();
  d.gainState = gain.asDiagonal();
  return task;
}

FlowTask suspendedMassFlowTask(double step) {
  FlowTask task{suspendedMassFlow(), {}};
  FlowDesign& d = task.design;
  d.step = step;
  d.x0 = Eigen::VectorXd::Zero(4);
  d.desiredInput = cosineStart(0.0476, step);
  d.outputDensity = Eigen::MatrixXd::Constant(1, 1, 5.0 / 33044);
  d.information.condition = 2.07;
  d.inputWeight = d.modelInput = Eigen::MatrixXd::Constant(1, 1, 100);
  d.modelState = 1e-6 * Eigen::MatrixXd::Identity(12, 12);
  d.gainState = Eigen::MatrixXd::Identity(4, 4);
  d.gainInput = Eigen::MatrixXd::Identity(1, 1);
  return task;
}

}  // namespace info
