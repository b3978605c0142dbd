#pragma once

#include <array>
#include <limits>

#include "bio/muscle/activation_variant.h"
#include "bio/muscle/curves/curves.h"
#include "bio/muscle/hill_muscle.h"

namespace bio::muscles {

/// The curves of a RigidTendonMuscle, in units of F0.
struct RigidTendonCurves {
  SplineFunction activeForceLength;   ///< f_l over ℓ/ℓ0
  SplineFunction passiveForceLength;  ///< f_PE over ℓ/ℓ0
  SplineFunction forceVelocity;       ///< f_v over ℓ̇/(V ℓ0)
  friend bool operator==(const RigidTendonCurves&, const RigidTendonCurves&) = default;
};

/// Curves that OpenSim's class has where a file gives none.
const RigidTendonCurves& openSimRigidTendonCurves();

/// How the class holds its curves, by number type.
template <class T>
struct RigidTendonForm {
  using Curves = RigidTendonCurves;
  using Spline = CubicSpline;
  static const Curves& defaults() { return openSimRigidTendonCurves(); }
};

/// The value and slopes of a spline in another number type.
template <class R, class U>
CurvePoint<R> splinePoint(const CubicSpline& curve, const U& x) {
  const PiecewiseCubic::Segment& s = curve.segmentAt(plainValue(x));
  const R t = R(x) - s.start;
  return {s.value + t * (s.slope + t * (s.quadratic + t * s.cubic)),
          s.slope + t * (2.0 * s.quadratic + t * (3.0 * s.cubic)),
          2.0 * s.quadratic + t * (6.0 * s.cubic)};
}

/// The numbers of a RigidTendonMuscle: those of every muscle, and three curves.
template <class T>
struct RigidTendonParameters : HillParameters<T>, MuscleSwitches {
  typename RigidTendonForm<T>::Curves curves = RigidTendonForm<T>::defaults();

  /// The tendon is always rigid, and activation always the control.
  RigidTendonParameters() { ignoreTendonCompliance = ignoreActivationDynamics = true; }

  static constexpr std::size_t count = common::count;
  static constexpr std::array<MuscleProperty, count> properties = common::properties;
  template <class P>
  static constexpr auto& at(P& p, std::size_t i) {
    using M = RigidTendonParameters;
    constexpr std::array<T M::*, count> members{&M::maxIsometricForce, &M::optimalFibreLength,
                                                &M::tendonSlackLength, &M::pennation,
                                                &M::maxContractionVelocity};
    return p.*members[i];
  }
  template <class U>
  void takeSwitches(const RigidTendonParameters<U>& from) {
    MuscleSwitches::operator=(from);
    curves = from.curves;
  }
  /// Ranges, and curves that a spline can go through.
  /// @throws std::invalid_argument naming number or curve, value and rule
  void requireRules() const;
  constexpr bool isGiven(std::size_t) const { return true; }
  AnyActivation activation() const;
  friend bool operator==(const RigidTendonParameters&, const RigidTendonParameters&) = default;
};

/// The shape of OpenSim's RigidTendonMuscle (OpenSim 4.6):
///
///     F_T = F0 (a f_l(l) f_v(v) + f_PE(l)) cos α,   v = L̇/(V ℓ0)
///
/// with splines f_l, f_PE (held within 0 to 10) and f_v, and a the control, not held within
/// anything. The fibre's velocity is that of the path, L̇, where the other classes with a rigid
/// tendon have L̇ cos α. There is no tendon curve, and no speed that a force would have: f_v need
/// not rise.
template <class T>
class RigidTendon {
 public:
  using Number = T;
  using Parameters = RigidTendonParameters<T>;
  using Spline = typename RigidTendonForm<T>::Spline;
  static constexpr const char* className = "RigidTendonMuscle";
  static constexpr std::size_t numOwn = 0;
  static constexpr std::size_t dampingPlace = Parameters::count;            ///< none
  static constexpr std::size_t minimumActivationPlace = Parameters::count;  ///< none
  static constexpr bool rigidForceIsCut = false;
  static constexpr bool stepsByBalance = true;
  static constexpr bool fibreMovesAsPath = true;

  explicit RigidTendon(const Parameters& p)
      : p_(p),
        active_(p.curves.activeForceLength),
        passive_(p.curves.passiveForceLength),
        velocity_(p.curves.forceVelocity) {}

  const Parameters& parameters() const { return p_; }
  const Spline& activeSpline() const { return active_; }
  const Spline& passiveSpline() const { return passive_; }
  const Spline& velocitySpline() const { return velocity_; }
  double damping() const { return 0; }
  bool dampingActs() const { return false; }
  T minimumActivation() const { return T(-std::numeric_limits<double>::infinity()); }
  double maximumActivation() const { return std::numeric_limits<double>::infinity(); }
  double shortestFibre(const T&) const { return 0; }

  template <class U>
  CurvePoint<Joint<T, U>> tendonForce(const U&) const {
    using R = Joint<T, U>;
    return {R(0.0), R(0.0), R(0.0)};
  }
  template <class U>
  CurvePoint<Joint<T, U>> activeForce(const U& l) const {
    return splinePoint<Joint<T, U>>(active_, l);
  }
  template <class U>
  CurvePoint<Joint<T, U>> passiveForce(const U& l) const {
    using R = Joint<T, U>;
    using Point = CurvePoint<R>;
    const Point point = splinePoint<R>(passive_, l);
    return branch(
        plainValue(point.value) < 0,
        [] {
          return Point{R(0.0), R(0.0), R(0.0)};
        },
        [&] {
          return branch(
              plainValue(point.value) > 10,
              [] {
                return Point{R(10.0), R(0.0), R(0.0)};
              },
              [&] { return point; });
        });
  }
  template <class U>
  ForceVelocity<Joint<T, U>> forceVelocity(const U& v, const U&) const {
    using R = Joint<T, U>;
    const CurvePoint<R> point = splinePoint<R>(velocity_, v);
    return {point.value, point.slope, R(0.0)};
  }
  /// NaN: the force follows the speed, not the other way round.
  template <class U>
  FibreSpeed<Joint<T, U>> speed(const U&, const U&, const U&) const {
    const Joint<T, U> none(std::numeric_limits<double>::quiet_NaN());
    return {none, none, none, none};
  }

  using Own = std::array<double, numOwn>;
  Own tendonForceInOwn(double) const { return {}; }
  Own activeForceInOwn(double) const { return {}; }
  Own passiveForceInOwn(double) const { return {}; }
  Own forceVelocityInOwn(double, double) const { return {}; }
  Own speedInOwn(double, double, double) const { return {}; }

 private:
  Parameters p_;
  Spline active_, passive_, velocity_;
};

template <>
void RigidTendonParameters<double>::requireRules() const;
template <>
AnyActivation RigidTendonParameters<double>::activation() const;

}  // namespace bio::muscles
