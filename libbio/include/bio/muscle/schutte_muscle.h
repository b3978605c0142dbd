#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <optional>

#include "bio/muscle/curves/curves.h"
#include "bio/muscle/curves/force_velocity.h"
#include "bio/muscle/schutte_parameters.h"
#include "info/autodiff/dual.h"

namespace bio {

/// The three curves of a Schutte muscle, compiled; all ordinates are normalised by F0.
struct SchutteCurves {
  CubicSpline tendonForce;                  ///< over tendon strain
  CubicSpline activeForce;                  ///< f_l over ℓ/ℓ0, negative values count as 0
  std::optional<CubicSpline> passiveForce;  ///< f_PE over ℓ/ℓ0; absent: exp(8(l−1))/e⁴

  explicit SchutteCurves(const SchutteParameters& parameters);
};

/// The parameters with respect to which derivatives are available; meaning and rules as in
/// SchutteParameters.
template <class T>
struct SchutteQuantities {
  T maxIsometricForce;   ///< F0 [N] > 0
  T optimalFibreLength;  ///< ℓ0 [m] > 0
  T tendonSlackLength;   ///< ℓs [m] > 0
  T pennation;           ///< α0 [rad], 0 ≤ α0 < π/2
  T timeScale;           ///< t_s [s] > 0
  T damping;             ///< B [1] > 0
};

/// The parameters of a file, checked.
/// @throws std::invalid_argument naming the quantity, its value, unit and rule
SchutteQuantities<double> schutteQuantities(const SchutteParameters& parameters);

struct SchutteOptions {
  /// Lower limit of the activation, which keeps the equation regular [1] > 0.
  double activationFloor = 1e-3;
  /// Whether the velocity-dependent force P is limited to ≥ 0, as in OpenSim's class, so that a
  /// slack tendon never drives the fibre.
  bool clampForce = true;
};

/// Fibre velocity and tendon force of a muscle at a state.
template <class T>
struct FibreRate {
  T fibreVelocity;  ///< ℓ̇ = V(act, ℓ, ℓ_MT) [m/s], lengthening > 0
  T tendonForce;    ///< F_T [N] ≥ 0
};

/// Schutte's muscle (Schutte, Rodgers, Zajac, Glaser 1993): a fibre with activation, force–length
/// and force–velocity relation, damping and constant thickness, in series with an elastic tendon.
///
///     F̂_T(ε) = [ act·f_l(l)·f_v(v) + f_PE(l) + B·v ]·cos α                             (3.1)
///     l = ℓ/ℓ0,  v = ℓ̇·t_s/ℓ0,  sin α = ℓ0 sin α0/ℓ,  ε = (ℓ_MT − ℓ cos α)/ℓs − 1,  F_T = F0·F̂_T
///     f_v(v) = k_v(1+v)/(k_v−v) for −1 ≤ v ≤ 0 and 0 below;  (1.4v+σ)/(v+σ) for v > 0
///
/// Solved for the velocity in closed form: with A = act·f_l and P = F̂_T/cos α − f_PE, v is
///     P/B                                                    for P < −B
///     the lower root of B v² − (P + k_v A + k_v B) v + k_v(P − A)    for −B ≤ P < A
///     the upper root of B v² − (P − 1.4A − Bσ) v − σ(P − A)          for P ≥ A
/// written without cancellation. V is continuous; its slope jumps at P = A (the kink of f_v), at
/// P = −B and, when clamped, at P = 0.
///
/// Equation (3.1) of Wilson's thesis with the damping term and with cos α on the whole fibre force
/// (as printed it is on f_PE only). F̂_T = 0 for ε < 0.
///
/// Domain: ℓ > ℓ0 sin α0 (and > 0). Outside it there is no pennation angle and every result is NaN,
/// so that an iteration that steps there detects a failed step and can shorten it.
template <class T>
class SchutteMuscle {
 public:
  /// The curves must outlive the muscle.
  SchutteMuscle(const SchutteQuantities<T>& quantities, const SchutteCurves& curves,
                const SchutteOptions& options = {})
      : quantities_(quantities), curves_(&curves), options_(options) {
    using std::sin;
    thickness_ = T(quantities.optimalFibreLength * sin(quantities.pennation));
    perFibre_ = T(T(1.0) / quantities.optimalFibreLength);
    perTendon_ = T(T(1.0) / quantities.tendonSlackLength);
    speedScale_ = T(quantities.optimalFibreLength / quantities.timeScale);
  }

  const SchutteQuantities<T>& quantities() const { return quantities_; }
  const SchutteCurves& curves() const { return *curves_; }
  const SchutteOptions& options() const { return options_; }
  const T& thickness() const { return thickness_; }    ///< ℓ0 sin α0 [m], the shortest fibre
  const T& perFibre() const { return perFibre_; }      ///< 1/ℓ0 [1/m]
  const T& perTendon() const { return perTendon_; }    ///< 1/ℓs [1/m]
  const T& speedScale() const { return speedScale_; }  ///< ℓ0/t_s [m/s]

  /// F_T [N].
  T tendonForce(const T& fibreLength, const T& muscleTendonLength) const {
    const T force = quantities_.maxIsometricForce *
                    normalisedTendonForce(tendonStrain(fibreLength, muscleTendonLength));
    return force;
  }

  /// ε = ℓ_T/ℓs − 1.
  T tendonStrain(const T& fibreLength, const T& muscleTendonLength) const {
    const T tendonLength = muscleTendonLength - projectedFibreLength(fibreLength);
    const T strain = tendonLength * perTendon_ - T(1.0);
    return strain;
  }

  /// ℓ cos α [m], NaN outside the domain.
  T projectedFibreLength(const T& fibreLength) const {
    using std::sqrt;
    if (!(plainValue(fibreLength) > plainValue(thickness_))) {
      return T(std::numeric_limits<double>::quiet_NaN());
    }
    const T square = fibreLength * fibreLength - thickness_ * thickness_;
    const T projected = sqrt(square);
    return projected;
  }

  /// F_T/F0 at strain ε.
  T normalisedTendonForce(const T& strain) const {
    if (plainValue(strain) < 0) return T(0.0);
    return curves_->tendonForce.value(strain);
  }

  /// f_l ≥ 0 at l = ℓ/ℓ0.
  T activeForceLength(const T& normalisedLength) const {
    const T value = curves_->activeForce.value(normalisedLength);
    if (plainValue(value) < 0) return T(0.0);
    return value;
  }

  /// f_PE at l = ℓ/ℓ0.
  T passiveForceLength(const T& normalisedLength) const {
    using std::exp;
    if (curves_->passiveForce) return curves_->passiveForce->value(normalisedLength);
    const T exponent = T(8.0) * normalisedLength - T(12.0);
    const T value = exp(exponent);
    return value;
  }

  /// ℓ̇ = V(act, ℓ, ℓ_MT) and F_T. Activation is dimensionless (0…1), lengths in m.
  FibreRate<T> fibreVelocity(const T& activation, const T& fibreLength,
                             const T& muscleTendonLength) const;

  /// F_T − F0·[act·f_l·f_v + f_PE + B·v]·cos α [N] for a fibre velocity in m/s: zero in
  /// equilibrium. P is not clamped; the activation floor applies.
  T equilibriumResidual(const T& activation, const T& fibreLength, const T& muscleTendonLength,
                        const T& fibreVelocity) const;

 private:
  SchutteQuantities<T> quantities_;
  const SchutteCurves* curves_;
  SchutteOptions options_;
  T thickness_;
  T perFibre_;
  T perTendon_;
  T speedScale_;
};

namespace schutte {

/// f_v(v), v normalised by ℓ0/t_s. C⁰: its slope is 0 below −1 and jumps at −1 and at 0.
template <class T>
T forceVelocity(const T& v) {
  if (plainValue(v) < -1) return T(0.0);
  if (plainValue(v) <= 0) {
    const T value = T(shapeShortening) * (T(1.0) + v) / (T(shapeShortening) - v);
    return value;
  }
  const T value = (T(maxLengtheningForce) * v + T(shapeLengthening)) / (v + T(shapeLengthening));
  return value;
}

/// v with A·f_v(v) + B·v = P: the inverse of the damped force–velocity relation, for A ≥ 0, B > 0.
template <class T>
T velocityFromForce(const T& P, const T& A, const T& B) {
  using std::sqrt;
  if (plainValue(P) < -plainValue(B)) {
    const T v = P / B;
    return v;
  }
  if (plainValue(P) < plainValue(A)) {
    const T b = P + T(shapeShortening) * (A + B);
    const T c = T(shapeShortening) * (P - A);
    const T discriminant = b * b - T(4.0) * B * c;
    const T root = sqrt(discriminant);
    if (plainValue(b) > 0) {
      const T v = T(2.0) * c / (b + root);
      return v;
    }
    const T v = (b - root) / (T(2.0) * B);
    return v;
  }
  const T b = P - T(maxLengtheningForce) * A - T(shapeLengthening) * B;
  const T c = T(shapeLengthening) * (P - A);
  const T discriminant = b * b + T(4.0) * B * c;
  const T root = sqrt(discriminant);
  if (plainValue(b) > 0) {
    const T v = (b + root) / (T(2.0) * B);
    return v;
  }
  const T v = T(2.0) * c / (root - b);
  return v;
}
}  // namespace schutte

template <class T>
FibreRate<T> SchutteMuscle<T>::fibreVelocity(const T& activation, const T& fibreLength,
                                             const T& muscleTendonLength) const {
  // Tendon force along the fibre.
  const T projected = projectedFibreLength(fibreLength);
  const T strain = (muscleTendonLength - projected) * perTendon_ - T(1.0);
  const T tendon = normalisedTendonForce(strain);
  // The force of the contractile element and the damper.
  const T l = fibreLength * perFibre_;
  T P = tendon * fibreLength / projected - passiveForceLength(l);
  if (options_.clampForce && plainValue(P) < 0) P = T(0.0);
  const bool floored = plainValue(activation) < options_.activationFloor;
  const T active = (floored ? T(options_.activationFloor) : activation) * activeForceLength(l);
  const T v = schutte::velocityFromForce<T>(P, active, quantities_.damping);
  return {T(v * speedScale_), T(tendon * quantities_.maxIsometricForce)};
}

template <class T>
T SchutteMuscle<T>::equilibriumResidual(const T& activation, const T& fibreLength,
                                        const T& muscleTendonLength, const T& fibreVelocity) const {
  const T l = fibreLength * perFibre_;
  const T v = fibreVelocity / speedScale_;
  const T cosPennation = projectedFibreLength(fibreLength) / fibreLength;
  const bool floored = plainValue(activation) < options_.activationFloor;
  const T active = (floored ? T(options_.activationFloor) : activation) * activeForceLength(l);
  const T fibre =
      active * schutte::forceVelocity<T>(v) + passiveForceLength(l) + quantities_.damping * v;
  const T residual = tendonForce(fibreLength, muscleTendonLength) -
                     quantities_.maxIsometricForce * fibre * cosPennation;
  return residual;
}

// In plain numbers
// ---------------------------------------------------------------------------------

/// A fibre rate and its partial derivatives.
struct FibreRateDerivatives {
  double fibreVelocity;           ///< V [m/s]
  double tendonForce;             ///< F_T [N]
  double dV_dActivation;          ///< [m/s]
  double dV_dFibreLength;         ///< [1/s]
  double dV_dMuscleTendonLength;  ///< [1/s]
  double dF_dFibreLength;         ///< [N/m]
  double dF_dMuscleTendonLength;  ///< [N/m]
};

/// The curve segments that contained a muscle's last state, which it rarely leaves from one step to
/// the next.
struct SchuttePieces {
  PiecewiseCubic::Piece tendonForce, activeForce, passiveForce;
};

/// fibreVelocity with hand-written first derivatives; at a kink those of the right-hand side in P
/// (lengthening at P = A). The kernel of every simulation: no allocation, no branches except
/// between regimes.
FibreRateDerivatives fibreRateDerivatives(const SchutteMuscle<double>& muscle, double activation,
                                          double fibreLength, double muscleTendonLength);
/// Fibre rate and derivatives, faster if the state lies in the curve segments of the last one.
FibreRateDerivatives fibreRateDerivatives(const SchutteMuscle<double>& muscle, double activation,
                                          double fibreLength, double muscleTendonLength,
                                          SchuttePieces& last);

/// The parts of the fibre force and the power of each, for reports.
struct MuscleForces {
  double tendonForce;        ///< F_T [N]
  double activeForce;        ///< F0·act·f_l·f_v, along the fibre [N]
  double passiveForce;       ///< F0·f_PE, along the fibre [N]
  double dampingForce;       ///< F0·B·v, along the fibre [N]
  double pennation;          ///< α [rad]
  double tendonStrain;       ///< ε [1]
  double muscleTendonPower;  ///< F_T·ℓ̇_MT [W]: power that the skeleton puts into the muscle, < 0
                             ///< when it drives
  double activePower;   ///< activeForce·ℓ̇ [W], < 0: the contractile element does work
  double passivePower;  ///< passiveForce·ℓ̇ [W], stored in the parallel spring
  double dampingPower;  ///< dampingForce·ℓ̇ [W] ≥ 0, lost
  double tendonPower;   ///< F_T·ℓ̇_T [W], stored in the tendon
};
/// Velocities in m/s. In equilibrium (equilibriumResidual = 0) muscleTendonPower is the sum of the
/// four other powers.
MuscleForces muscleForces(const SchutteMuscle<double>& muscle, double activation,
                          double fibreLength, double muscleTendonLength, double fibreVelocity,
                          double muscleTendonVelocity);

/// Result of the search for static equilibrium.
struct StaticEquilibrium {
  enum class Why {
    found,  ///< the fibre force balances the tendon force
    /// fibre and tendon carry no force: where the tendon goes slack the fibre's curves are 0, to
    /// within the ripple of the splines (1e-4 F0); fibreLength leaves the tendon just slack
    forceFree,
    tendonTooShort,  ///< ℓ_MT ≤ ℓs: the tendon is slack at every fibre length, so the fibre only
                     ///< shortens
    notBracketed,  ///< no sign change of the force difference between the borders
  };
  Why why;
  double fibreLength;  ///< ℓ [m]; NaN unless found or forceFree
  double tendonForce;  ///< F_T [N]; NaN unless found or forceFree
  int count;           ///< stable equilibria in the bracket; above 1 the one nearest ℓ0 is given
  bool isUsable() const { return why == Why::found || why == Why::forceFree; }
};

/// The stable fibre length with V = 0, by a bracketing method between the shortest fibre and the
/// one that leaves the tendon slack.
/// @throws std::invalid_argument for an activation or length that is not finite
StaticEquilibrium staticEquilibrium(const SchutteMuscle<double>& muscle, double activation,
                                    double muscleTendonLength);

/// One-line description, e.g. "the tendon is slack at every fibre length".
const char* describe(StaticEquilibrium::Why why);

}  // namespace bio
