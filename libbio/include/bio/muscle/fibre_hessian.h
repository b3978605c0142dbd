#pragma once

#include "bio/muscle/hill_muscle.h"

namespace bio::muscles {

/// A fibre rate with second derivatives over (activation, ℓ, L), in that order.
struct FibreRateHessian {
  FibreRate<double> first;
  Eigen::Matrix3d d2V;  ///< ∂²V
  Eigen::Matrix3d d2F;  ///< ∂²F_T
};

/// The first derivatives written out, differentiated through the number type. At a kink those of
/// the side that fibreRate takes.
template <class Shape>
FibreRateHessian fibreRateHessian(const HillMuscle<Shape>& muscle, double activation,
                                  double fibreLength, double pathLength) {
  using D = info::Dual<3>;
  const FibreRate<D> r =
      muscle.fibreRate(D(activation, 3, 0), D(fibreLength, 3, 1), D(pathLength, 3, 2));
  FibreRateHessian h;
  h.first = {r.fibreVelocity.value(),   r.tendonForce.value(),    r.dV_dActivation.value(),
             r.dV_dFibreLength.value(), r.dV_dPathLength.value(), r.dF_dFibreLength.value(),
             r.dF_dPathLength.value()};
  h.d2V.row(0) = r.dV_dActivation.derivatives().transpose();
  h.d2V.row(1) = r.dV_dFibreLength.derivatives().transpose();
  h.d2V.row(2) = r.dV_dPathLength.derivatives().transpose();
  h.d2F.row(0).setZero();
  h.d2F.row(1) = r.dF_dFibreLength.derivatives().transpose();
  h.d2F.row(2) = r.dF_dPathLength.derivatives().transpose();
  return h;
}

}  // namespace bio::muscles
