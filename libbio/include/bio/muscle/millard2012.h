#pragma once

#include <cmath>

#include "bio/muscle/activation_variant.h"
#include "bio/muscle/hill_shape.h"
#include "bio/muscle/millard_curves.h"
#include "bio/muscle/millard_speed.h"

namespace bio::muscles {

/// Numbers of Millard2012EquilibriumMuscle, at OpenSim's defaults. A file has either all or none of
/// the three optional numbers of the passive curve and of the tendon's; where it has none they
/// follow from the strains and are no parameters (passiveShapeIsGiven, tendonShapeIsGiven).
template <class T = double>
struct Millard2012Parameters : HillParameters<T>, MuscleSwitches {
  T fibreDamping = T(0.1);  ///< β [F0/(V ℓ0)] ≥ 0; below 0.001 it counts as 0: the undamped model
  // ActiveForceLengthCurve, over ℓ/ℓ0
  T minActiveLength = T(0.4441);
  T transitionLength = T(0.73);
  T maxActiveLength = T(1.8123);
  T shallowSlope = T(0.8616);
  T minActiveForce = T(0.1);  ///< acts as 0 but in the undamped model, there as 0.1 at least
  // FiberForceLengthCurve, strains of the fibre
  T passiveZeroStrain = T(0.0);
  T passiveUnitStrain = T(0.7);
  T passiveLowStiffness = T(0.2);
  T passiveUnitStiffness = T(2.0 / 0.7);
  T passiveCurviness = T(0.75);
  // TendonForceLengthCurve, strains of the tendon
  T tendonUnitStrain = T(0.049);
  T tendonUnitStiffness = T(1.375 / 0.049);
  T tendonToeForce = T(2.0 / 3.0);
  T tendonCurviness = T(0.5);
  // ForceVelocityCurve, over ℓ̇/(V ℓ0). The slopes at ±V act as 0 with damping or a rigid tendon,
  // else as half the slopes near ±V: so is OpenSim's inverse curve, whatever the file says.
  T concentricSlope = T(0.0);
  T concentricNearSlope = T(0.25);
  T isometricSlope = T(5.0);
  T eccentricSlope = T(0.0);
  T eccentricNearSlope = T(0.15);
  T maxEccentricForce = T(1.4);
  T concentricCurviness = T(0.6);
  T eccentricCurviness = T(0.9);
  T activationTime = T(0.010);                 ///< τ_a [s] > 0
  T deactivationTime = T(0.040);               ///< τ_d [s] > 0
  T minimumActivation = T(0.01);               ///< [1], 0 ≤ a_min < 1, ≥ 0.01 if undamped
  T maximumPennation = T(1.4706289056333368);  ///< [rad]; says where OpenSim holds the fibre
  bool passiveShapeIsGiven = false;
  bool tendonShapeIsGiven = false;

  Millard2012Parameters() { minControl = 0.01; }

  static constexpr std::size_t count = 32;
  static constexpr std::array<MuscleProperty, count> properties{{
      common::properties[0],
      common::properties[1],
      common::properties[2],
      common::properties[3],
      common::properties[4],
      {"fiber_damping", "F0/(V l0)", notNegative},
      {"ActiveForceLengthCurve/min_norm_active_fiber_length", "", notNegative},
      {"ActiveForceLengthCurve/transition_norm_fiber_length", "", positive},
      {"ActiveForceLengthCurve/max_norm_active_fiber_length", "", {.low = 1}},
      {"ActiveForceLengthCurve/shallow_ascending_slope", "", notNegative},
      {"ActiveForceLengthCurve/minimum_value", "", notNegative},
      {"FiberForceLengthCurve/strain_at_zero_force", "", {.low = -1}},
      {"FiberForceLengthCurve/strain_at_one_norm_force", "", anyNumber},
      {"FiberForceLengthCurve/stiffness_at_low_force", "", positive},
      {"FiberForceLengthCurve/stiffness_at_one_norm_force", "", positive},
      {"FiberForceLengthCurve/curviness", "", fraction},
      {"TendonForceLengthCurve/strain_at_one_norm_force", "", positive},
      {"TendonForceLengthCurve/stiffness_at_one_norm_force", "", positive},
      {"TendonForceLengthCurve/norm_force_at_toe_end", "", {.low = 0, .high = 1}},
      {"TendonForceLengthCurve/curviness", "", fraction},
      {"ForceVelocityCurve/concentric_slope_at_vmax", "", notNegative},
      {"ForceVelocityCurve/concentric_slope_near_vmax",
       "",
       {.low = 0, .high = 1, .withHigh = true}},
      {"ForceVelocityCurve/isometric_slope", "", {.low = 1}},
      {"ForceVelocityCurve/eccentric_slope_at_vmax", "", notNegative},
      {"ForceVelocityCurve/eccentric_slope_near_vmax", "", positive},
      {"ForceVelocityCurve/max_eccentric_velocity_force_multiplier", "", {.low = 1}},
      {"ForceVelocityCurve/concentric_curviness", "", fraction},
      {"ForceVelocityCurve/eccentric_curviness", "", fraction},
      {"activation_time_constant", "s", positive},
      {"deactivation_time_constant", "s", positive},
      {"minimum_activation", "", {.low = 0, .high = 1, .withLow = true}},
      {"maximum_pennation_angle", "rad", {.low = 0, .high = 1.5707963267948966}},
  }};
  template <class P>
  static constexpr auto& at(P& p, std::size_t i) {
    using M = Millard2012Parameters;
    constexpr std::array<T M::*, count> members{
        &M::maxIsometricForce,   &M::optimalFibreLength,     &M::tendonSlackLength,
        &M::pennation,           &M::maxContractionVelocity, &M::fibreDamping,
        &M::minActiveLength,     &M::transitionLength,       &M::maxActiveLength,
        &M::shallowSlope,        &M::minActiveForce,         &M::passiveZeroStrain,
        &M::passiveUnitStrain,   &M::passiveLowStiffness,    &M::passiveUnitStiffness,
        &M::passiveCurviness,    &M::tendonUnitStrain,       &M::tendonUnitStiffness,
        &M::tendonToeForce,      &M::tendonCurviness,        &M::concentricSlope,
        &M::concentricNearSlope, &M::isometricSlope,         &M::eccentricSlope,
        &M::eccentricNearSlope,  &M::maxEccentricForce,      &M::concentricCurviness,
        &M::eccentricCurviness,  &M::activationTime,         &M::deactivationTime,
        &M::minimumActivation,   &M::maximumPennation};
    return p.*members[i];
  }
  template <class U>
  void takeSwitches(const Millard2012Parameters<U>& from) {
    MuscleSwitches::operator=(from);
    passiveShapeIsGiven = from.passiveShapeIsGiven;
    tendonShapeIsGiven = from.tendonShapeIsGiven;
  }
  bool isDamped() const { return plainValue(fibreDamping) >= 0.001; }
  /// Ranges and the rules between numbers.
  /// @throws std::invalid_argument naming number, value and rule
  void requireRules() const;
  /// Whether the number of that place is one: without the optional numbers of a curve theirs are
  /// not.
  constexpr bool isGiven(std::size_t i) const {
    return i >= 13 && i <= 15 ? passiveShapeIsGiven : i < 17 || i > 19 || tendonShapeIsGiven;
  }
  /// The activation dynamics that numbers and switches mean.
  AnyActivation activation() const;
  friend bool operator==(const Millard2012Parameters&, const Millard2012Parameters&) = default;
};

// The curves with the numbers that act in them, after OpenSim's silent changes.

template <class T>
BezierShape<T, 5> activeCurveOf(const Millard2012Parameters<T>& p) {
  const bool held = p.isDamped() || p.ignoreTendonCompliance;
  const T minimum = held ? T(0.0) : plainValue(p.minActiveForce) > 0.1 ? p.minActiveForce : T(0.1);
  return millardActiveForce<T>(p.minActiveLength, p.transitionLength, p.maxActiveLength,
                               p.shallowSlope, minimum);
}
template <class T>
BezierShape<T, 2> passiveCurveOf(const Millard2012Parameters<T>& p) {
  const T stiffness = 2.0 / (p.passiveUnitStrain - p.passiveZeroStrain);
  if (!p.passiveShapeIsGiven) {
    return millardPassiveForce<T>(p.passiveZeroStrain, p.passiveUnitStrain, T(0.2), stiffness,
                                  T(0.75));
  }
  return millardPassiveForce<T>(p.passiveZeroStrain, p.passiveUnitStrain, p.passiveLowStiffness,
                                p.passiveUnitStiffness, p.passiveCurviness);
}
template <class T>
BezierShape<T, 2> tendonCurveOf(const Millard2012Parameters<T>& p) {
  if (!p.tendonShapeIsGiven) {
    const T stiffness = 1.375 / p.tendonUnitStrain;
    return millardTendonForce<T>(p.tendonUnitStrain, stiffness, T(2.0 / 3.0), T(0.5));
  }
  return millardTendonForce<T>(p.tendonUnitStrain, p.tendonUnitStiffness, p.tendonToeForce,
                               p.tendonCurviness);
}
template <class T>
BezierShape<T, 4> forceVelocityCurveOf(const Millard2012Parameters<T>& p) {
  const bool held = p.isDamped() || p.ignoreTendonCompliance;
  const T C = held ? T(0.0) : 0.5 * p.concentricNearSlope;
  const T E = held ? T(0.0) : 0.5 * p.eccentricNearSlope;
  return millardForceVelocity<T>(C, p.concentricNearSlope, p.isometricSlope, E,
                                 p.eccentricNearSlope, p.maxEccentricForce, p.concentricCurviness,
                                 p.eccentricCurviness);
}

/// How the curves follow their own numbers, in the order of the properties.
struct MillardSensitivities {
  explicit MillardSensitivities(const Millard2012Parameters<double>& p);
  BezierSensitivity<5, 5> active;
  BezierSensitivity<5, 2> passive;
  BezierSensitivity<4, 2> tendon;
  BezierSensitivity<8, 4> forceVelocity;
};

/// The shape of Millard's muscle (Millard, Uchida, Seth, Delp 2013, J. Biomech. Eng. 135; OpenSim
/// 4.6, Millard2012EquilibriumMuscle): four curves of quintic Bézier sections (millard_curves.h), a
/// damper B = β beside the contractile element. All curves are C² and so is v(P, A).
///
/// Undamped (β < 0.001): B = 0. Departure: OpenSim finds v to 1e-10 F0 by Newton's method, here to
/// rounding.
template <class T>
class Millard2012 {
 public:
  using Number = T;
  using Parameters = Millard2012Parameters<T>;
  static constexpr const char* className = "Millard2012EquilibriumMuscle";
  static constexpr std::size_t numOwn = Parameters::count - common::count;
  static constexpr std::size_t dampingPlace = 5;
  static constexpr std::size_t minimumActivationPlace = 30;
  static constexpr bool rigidForceIsCut = true;
  static constexpr bool stepsByBalance = false;

  explicit Millard2012(const Parameters& p)
      : p_(p),
        damping_(p.isDamped() ? p.fibreDamping : T(0.0)),
        tendon_(tendonCurveOf(p)),
        active_(activeCurveOf(p)),
        passive_(passiveCurveOf(p)),
        forceVelocity_(forceVelocityCurveOf(p)),
        speed_(forceVelocity_),
        inOwn_(p) {}

  /// The curves where they are there already, and B.
  struct Curves {
    T damping;
    BezierCurve<T, 2> tendon;
    BezierCurve<T, 5> active;
    BezierCurve<T, 2> passive;
    BezierCurve<T, 4> forceVelocity;
    MillardSpeed<T> speed;
  };
  Millard2012(const Parameters& p, const Curves& curves)
      : p_(p),
        damping_(curves.damping),
        tendon_(curves.tendon),
        active_(curves.active),
        passive_(curves.passive),
        forceVelocity_(curves.forceVelocity),
        speed_(curves.speed),
        inOwn_(p) {}

  const Parameters& parameters() const { return p_; }
  const T& damping() const { return damping_; }
  bool dampingActs() const { return p_.isDamped(); }
  const T& minimumActivation() const { return p_.minimumActivation; }
  double maximumActivation() const { return 1; }
  /// The larger of x₀ ℓ0 and w/sin α_max.
  auto shortestFibre(const T& thickness) const {
    using std::sin;
    const auto active = plainValue(p_.minActiveLength) * plainValue(p_.optimalFibreLength);
    const auto pennate = plainValue(thickness) / sin(plainValue(p_.maximumPennation));
    return choose(active < pennate, pennate, active);
  }

  template <class U>
  CurvePoint<Joint<T, U>> tendonForce(const U& strain) const {
    return tendon_.evaluate(U(strain + 1.0));
  }
  template <class U>
  CurvePoint<Joint<T, U>> activeForce(const U& l) const {
    return active_.evaluate(l);
  }
  template <class U>
  CurvePoint<Joint<T, U>> passiveForce(const U& l) const {
    return passive_.evaluate(l);
  }
  template <class U>
  ForceVelocity<Joint<T, U>> forceVelocity(const U& v, const U&) const {
    const CurvePoint<Joint<T, U>> f = forceVelocity_.evaluate(v);
    return {f.value, f.slope, Joint<T, U>(0.0)};
  }
  template <class U>
  FibreSpeed<Joint<T, U>> speed(const U& P, const U& A, const U&) const {
    return speed_.solve(forceVelocity_, damping_, P, A);
  }

  using Own = std::array<double, numOwn>;
  Own tendonForceInOwn(double strain) const;
  Own activeForceInOwn(double l) const;
  Own passiveForceInOwn(double l) const;
  Own forceVelocityInOwn(double v, double a) const;
  Own speedInOwn(double P, double A, double a) const;

  // what numbers of several states side by side look up state by state
  const BezierCurve<T, 2>& tendonCurve() const { return tendon_; }
  const BezierCurve<T, 5>& activeCurve() const { return active_; }
  const BezierCurve<T, 2>& passiveCurve() const { return passive_; }
  const BezierCurve<T, 4>& forceVelocityCurve() const { return forceVelocity_; }
  const MillardSpeed<T>& speedSolver() const { return speed_; }

 private:
  struct None {
    explicit None(const Parameters&) {}
  };

  Parameters p_;
  T damping_;
  BezierCurve<T, 2> tendon_;
  BezierCurve<T, 5> active_;
  BezierCurve<T, 2> passive_;
  BezierCurve<T, 4> forceVelocity_;
  MillardSpeed<T> speed_;
  std::conditional_t<std::is_same_v<T, double>, MillardSensitivities, None> inOwn_;
};

template <>
void Millard2012Parameters<double>::requireRules() const;
template <>
AnyActivation Millard2012Parameters<double>::activation() const;
template <>
auto Millard2012<double>::tendonForceInOwn(double strain) const -> Own;
template <>
auto Millard2012<double>::activeForceInOwn(double l) const -> Own;
template <>
auto Millard2012<double>::passiveForceInOwn(double l) const -> Own;
template <>
auto Millard2012<double>::forceVelocityInOwn(double v, double a) const -> Own;
template <>
auto Millard2012<double>::speedInOwn(double P, double A, double a) const -> Own;

}  // namespace bio::muscles
