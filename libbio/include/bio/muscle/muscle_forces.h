#pragma once

#include <cmath>

#include "bio/muscle/hill_muscle.h"

namespace bio::muscles {

/// The parts of a muscle's force and the power of each, for reports.
struct MuscleForces {
  double tendonForce;         ///< F_T [N]
  double activeForce;         ///< F0 a f_l f_v, along the fibre [N]
  double passiveForce;        ///< F0 f_PE, along the fibre [N]
  double dampingForce;        ///< F0 B v, along the fibre [N]
  double activeMultiplier;    ///< f_l [1]
  double passiveMultiplier;   ///< f_PE [1]
  double velocityMultiplier;  ///< f_v [1]
  double pennation;           ///< α [rad]
  double tendonStrain;        ///< ε [1]
  double
      muscleTendonPower;  ///< F_T·L̇ [W]: what the skeleton puts into the muscle, < 0 when it drives
  double activePower;     ///< activeForce·ℓ̇ [W], < 0: the contractile element gives work
  double passivePower;  ///< passiveForce·ℓ̇ [W], stored in the parallel spring
  double dampingPower;  ///< dampingForce·ℓ̇ [W] ≥ 0, lost
  double tendonPower;   ///< F_T·ℓ̇_T [W], stored in the tendon
};

/// Velocities in m/s. Where the muscle balances, muscleTendonPower is the sum of the four others.
/// With a rigid tendon fibre length and velocity are those of rigidRate; the force that a class
/// cuts at 0 is taken up by the damper, as in OpenSim.
template <class Shape>
MuscleForces muscleForces(const HillMuscle<Shape>& muscle, double activation, double fibreLength,
                          double pathLength, double fibreVelocity, double pathSpeed) {
  const auto& p = muscle.parameters();
  const Shape& shape = muscle.shape();
  const double F0 = p.maxIsometricForce;
  const double l = fibreLength * muscle.perFibre(), v = fibreVelocity / muscle.speedScale();
  const double act = muscle.acting(activation);
  const double cosine = muscle.projected(fibreLength) / fibreLength;
  MuscleForces r{};
  r.activeMultiplier = shape.activeForce(l).value;
  r.passiveMultiplier = shape.passiveForce(l).value;
  r.velocityMultiplier = shape.forceVelocity(v, act).value;
  r.activeForce = F0 * act * r.activeMultiplier * r.velocityMultiplier;
  r.passiveForce = F0 * r.passiveMultiplier;
  r.dampingForce = F0 * shape.damping() * v;
  r.pennation = std::asin(muscle.thickness() / fibreLength);
  if (muscle.hasFibreState()) {
    r.tendonStrain = muscle.tendonStrain(fibreLength, pathLength);
    r.tendonForce = F0 * shape.tendonForce(r.tendonStrain).value;
  } else {
    const double fibre = r.activeForce + r.passiveForce + r.dampingForce;
    if (Shape::rigidForceIsCut && fibre < 0) r.dampingForce -= fibre;
    r.tendonForce = (r.activeForce + r.passiveForce + r.dampingForce) * cosine;
  }
  r.muscleTendonPower = r.tendonForce * pathSpeed;
  r.activePower = r.activeForce * fibreVelocity;
  r.passivePower = r.passiveForce * fibreVelocity;
  r.dampingPower = r.dampingForce * fibreVelocity;
  // d(ℓ cos α)/dt = ℓ̇/cos α, because the thickness is constant
  r.tendonPower = r.tendonForce * (pathSpeed - fibreVelocity / cosine);
  return r;
}

}  // namespace bio::muscles
