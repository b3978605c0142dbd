#include "robots/instances.h"

namespace info {

template struct InformationRateCost<LengthUnknown>;
template struct InformationRateCost<MassAndLengthUnknown>;
template class SequentialActionControl<LengthUnknown>;
template class SequentialActionControl<MassAndLengthUnknown>;
template class OnlineLeastSquares<Rk4<LengthUnknown>>;
template class OnlineLeastSquares<Rk4<MassAndLengthUnknown>>;

template Predictor makePredictor(Rk4<SuspendedMass>, Experiment<Rk4<SuspendedMass>>);
template ExtendedStepMap extend(Rk4<SuspendedMass>, const Vector<double, 2>&);
template ExtendedFlow extendFlow(SuspendedMass, const Vector<double, 2>&);

}  // namespace info
