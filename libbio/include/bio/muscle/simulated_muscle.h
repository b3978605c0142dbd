#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "bio/muscle/muscle_parameters.h"
#include "bio/muscle/muscle_variant.h"
#include "bio/muscle/schutte_muscle.h"

namespace bio {

/// Numbers of a muscle that results are differentiated in. Of Schutte's class: MuscleQuantity
/// below activation1; of the others: places in the class's table of properties.
constexpr std::size_t mostMuscleNumbers = 40;
using PerMuscleNumber = std::array<double, mostMuscleNumbers>;

/// A muscle of any class as the integrators see it. Forces in N, lengths in m, speeds in m/s.
///
/// With an elastic tendon the fibre's length ℓ is a state with ℓ̇ = V(a, ℓ, L); with a rigid one
/// there is none, and the force F(a, L, L̇) follows the path.
class SimulatedMuscle {
 public:
  explicit SimulatedMuscle(const SchutteMuscle<double>& muscle)
      : schutte_(muscle), perFibre_(muscle.perFibre()) {}
  /// The other muscle must outlive this.
  explicit SimulatedMuscle(const muscles::AnyMuscle& other);

  /// Null for other classes.
  const SchutteMuscle<double>* ifSchutte() const { return schutte_ ? &*schutte_ : nullptr; }
  /// Null for Schutte's class.
  const muscles::AnyMuscle* ifOther() const { return other_; }
  /// @throws std::bad_optional_access for other classes
  const SchutteMuscle<double>& schutte() const { return schutte_.value(); }

  double perFibre() const { return perFibre_; }          ///< 1/ℓ0 [1/m]
  double thickness() const;                              ///< w [m]
  bool hasFibreState() const { return hasFibreState_; }  ///< false: rigid tendon
  /// Derivatives of w = ℓ0 sin α0 in the muscle's numbers [m per unit].
  PerMuscleNumber thicknessInNumbers() const;

  /// Length at which the class holds a fibre with an elastic tendon [m]: there it shortens no
  /// further, ℓ̇ = max(V, 0), and what pulls on it shortens the tendon. 0: never.
  double shortestFibre() const;
  bool isHeld(double fibreLength) const {
    return mayBeHeld(fibreLength) && fibreLength <= shortestFibre() * (1 + 1e-9);
  }

  /// V(a, ℓ, L) and F_T of an elastic muscle with first derivatives.
  FibreRateDerivatives rate(double activation, double fibreLength, double pathLength,
                            SchuttePieces& last) const {
    if (schutte_) {
      return fibreRateDerivatives(*schutte_, activation, fibreLength, pathLength, last);
    }
    return otherRate(activation, fibreLength, pathLength);
  }
  /// V and F_T for an implicit midpoint step of h [s] that has the fibre move with a velocity v
  /// from ℓ − h v/2 to ℓ + h v/2. For a class whose step solves the balance of forces
  /// R(a, ℓ, L, v) = 0 it is the velocity to which Newton's method moves v, v − R/R_v, with
  /// derivatives −R_x/R_v: exact where R = 0. Where a fibre is held it is the velocity that takes
  /// it to shortestFibre(), with derivatives 0, if v − V is more than that equation's error: the
  /// lesser of the two errors vanishes in the end.
  FibreRateDerivatives rateNear(double activation, double fibreLength, double pathLength,
                                double fibreVelocity, double h, SchuttePieces& last) const {
    if (schutte_) {
      return fibreRateDerivatives(*schutte_, activation, fibreLength, pathLength, last);
    }
    return otherRateNear(activation, fibreLength, pathLength, fibreVelocity, h);
  }
  /// F(a, L, L̇) of a muscle with a rigid tendon.
  muscles::RigidRate<double> rigidRate(double activation, double pathLength,
                                       double pathSpeed) const;

  /// F_T of either.
  double tendonForce(double activation, double fibreLength, double pathLength,
                     double pathSpeed) const;

  /// staticEquilibrium, restingFibre
  StaticEquilibrium rest(double activation, double pathLength) const;
  struct RestSlopes {
    double dl_dActivation;  ///< [m]
    double dl_dPathLength;  ///< [1]
    PerMuscleNumber dl_dNumber{};
  };
  RestSlopes restSlopes(double activation, double pathLength, const StaticEquilibrium& rest) const;

  /// ∂/∂θ of what rateNear gives at a solution; of the force alone with a rigid tendon.
  struct InNumbers {
    PerMuscleNumber dV{};  ///< [m/s per unit]
    PerMuscleNumber dF{};  ///< [N per unit]
  };
  /// @param last  as of rate()
  InNumbers inNumbers(double activation, double fibreLength, double pathLength,
                      double fibreVelocity, SchuttePieces& last) const;
  /// Derivatives of shortestFibre() in the muscle's numbers [m per unit].
  PerMuscleNumber shortestInNumbers() const;
  PerMuscleNumber rigidInNumbers(double activation, double pathLength, double pathSpeed) const;

 private:
  FibreRateDerivatives otherRate(double activation, double fibreLength, double pathLength) const;
  FibreRateDerivatives otherRateNear(double activation, double fibreLength, double pathLength,
                                     double fibreVelocity, double h) const;
  /// No class holds a fibre at its optimal length or beyond.
  bool mayBeHeld(double fibreLength) const { return other_ && !(fibreLength * perFibre_ >= 1); }

  std::optional<SchutteMuscle<double>> schutte_;
  const muscles::AnyMuscle* other_ = nullptr;
  double perFibre_;
  bool hasFibreState_ = true;
};

}  // namespace bio
