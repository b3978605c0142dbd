#include "robots/instances.h"

namespace info {

template class VariationalIntegrator<CartDoublePendulum<>>;
template Predictor makePredictor(DoublePendulumSteps, Experiment<DoublePendulumSteps>);
template ExtendedStepMap extend(DoublePendulumSteps, const Vector<double, 2>&);

}  // namespace info
