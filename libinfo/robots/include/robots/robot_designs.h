#pragma once

#include "info/design/discrete_projection.h"
#include "info/design/projection.h"
#include "robots/cart_double_pendulum.h"

/// The two robots of chapters 4 and 5 of Wilson's thesis as systems and tasks for the optimisation
/// of motions.
namespace info {

/// The variational step of the cart with the double pendulum, input the cart's position [m];
/// θ = (m1 [kg], c [dampingUnit kg m²/s]).
/// @param timeStep Δt [s] > 0
ExtendedStepMap doublePendulumSteps(double timeStep, double dampingUnit = 1e-3,
                                    const Vector<double, 2>& theta = {0.085, 0.5});

/// Chapter 5: 5 s from x(t) = 0.01 sin(2πt/5) m, information 1.25e4/λ_min, c = 0.05 in 10e-3 kg
/// m²/s, the unit of that chapter. Weights and the unit are not printed; those used here give an
/// information close to the printed one.
struct StepTask {
  ExtendedStepMap system;
  StepDesign design;
};
StepTask doublePendulumStepTask(double timeStep = 0.02, std::size_t stepsPerSample = 1);

/// Both robots in continuous time at θ, in the units of robot_experiments.h.
ExtendedFlow doublePendulumFlow(const Vector<double, 2>& theta = {0.085, 0.5});
ExtendedFlow suspendedMassFlow(const Vector<double, 2>& theta = {0.10, 0.60});

struct FlowTask {
  ExtendedFlow system;
  FlowDesign design;
};

/// Chapter 4: 5 s from x(t) = 0.05(1 − cos 2πt/5) m, information 100/λ_min per sample a second, at
/// θ = (0.085 kg, 0.5e-3 kg m²/s). Input the cart's acceleration [m/s²]. The source gives neither
/// start nor weights; those used here give its initial bound within 3 %.
FlowTask doublePendulumFlowTask(double step = 0.01);

/// Section 4.5: 5 s from x(t) = 0.0476(1 − cos 2πt/5) m, 2.07·κ against the cart's acceleration
/// weighted by 100, at θ = (0.10 kg, 0.60 m).
FlowTask suspendedMassFlowTask(double step = 0.01);

}  // namespace info
