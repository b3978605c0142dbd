#pragma once

#include "info/design/sequential_action_control.h"
#include "info/dynamics/extended_system.h"
#include "info/dynamics/free_parameters.h"
#include "info/dynamics/integrate.h"
#include "info/dynamics/online_least_squares.h"
#include "info/dynamics/predictor.h"
#include "info/dynamics/variational.h"
#include "robots/cart_double_pendulum.h"
#include "robots/suspended_mass.h"

/// Explicit instantiations of the templates for the library's robots. A file that includes this
/// header does not compile them again, which saves compile time.
namespace info {

/// The suspended mass with its length, or mass and length, unknown.
using LengthUnknown = FreeParameters<SuspendedMass, 1>;
using MassAndLengthUnknown = FreeParameters<SuspendedMass, 0, 1>;

extern template struct InformationRateCost<LengthUnknown>;
extern template struct InformationRateCost<MassAndLengthUnknown>;
extern template class SequentialActionControl<LengthUnknown>;
extern template class SequentialActionControl<MassAndLengthUnknown>;
extern template class OnlineLeastSquares<Rk4<LengthUnknown>>;
extern template class OnlineLeastSquares<Rk4<MassAndLengthUnknown>>;

extern template Predictor makePredictor(Rk4<SuspendedMass>, Experiment<Rk4<SuspendedMass>>);
extern template ExtendedStepMap extend(Rk4<SuspendedMass>, const Vector<double, 2>&);
extern template ExtendedFlow extendFlow(SuspendedMass, const Vector<double, 2>&);

using DoublePendulumSteps = VariationalIntegrator<CartDoublePendulum<>>;
extern template class VariationalIntegrator<CartDoublePendulum<>>;
extern template Predictor makePredictor(DoublePendulumSteps, Experiment<DoublePendulumSteps>);
extern template ExtendedStepMap extend(DoublePendulumSteps, const Vector<double, 2>&);

}  // namespace info
