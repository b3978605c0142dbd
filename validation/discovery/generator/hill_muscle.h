#pragma once

#include <string>

#include "generator/force_curve.h"

namespace hidden {

/// A muscle of the true elbow: Schutte's, as docs/theory/muscle.md states it, written anew (the
/// velocity by Newton's iteration on the force balance, not in closed form).
struct HillMuscle {
  std::string name;
  double maxForce = 0;       ///< F0 [N]
  double fibreLength = 0;    ///< ℓ0 [m]
  double slackLength = 0;    ///< ℓs [m]
  double pennation = 0;      ///< α0 [rad]
  double timeScale = 0.1;    ///< t_s [s]
  double activation1 = 0;    ///< c₁ of t_s·ȧ = (u − a)(c₁u + c₂), rising
  double activation2 = 0;    ///< c₂ of t_s·ȧ = (u − a)c₂, falling
  double damping = 0;        ///< B
  double tendonStretch = 1;  ///< κ: the tendon's curve is taken at strain/κ
  ForceCurve tendon, active, passive;

  /// F_T [N] at fibre length ℓ and muscle–tendon length [m].
  double tendonForce(double fibre, double muscleTendon) const;
  /// ℓ̇ [m/s]; activations below 1e-3 act as 1e-3, the velocity force is not let below 0.
  /// @param strength  scale of the contractile element's force (fatigue)
  double fibreVelocity(double activation, double fibre, double muscleTendon,
                       double strength = 1) const;
  /// ȧ [1/s]
  double activationRate(double excitation, double activation) const;
  /// Stable fibre length at rest [m], the one nearest ℓ0; where neither pulls, the tendon is just
  /// taut. @throws std::runtime_error if the muscle is shorter than its slack tendon or nothing
  /// balances
  double restingFibre(double activation, double muscleTendon, double strength = 1) const;

 private:
  // F̂_T and the two parts of the fibre's force along it; cos α.
  struct Parts {
    double tendon, active, passive, cosine;
  };
  Parts parts(double activation, double fibre, double muscleTendon, double strength) const;
};

}  // namespace hidden
