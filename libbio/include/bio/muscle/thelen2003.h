#pragma once

#include <cmath>

#include "bio/muscle/activation_variant.h"
#include "bio/muscle/hill_shape.h"

namespace bio::muscles {

/// Numbers of Thelen2003Muscle, at OpenSim's defaults.
template <class T = double>
struct Thelen2003Parameters : HillParameters<T>, MuscleSwitches {
  T tendonStrainAtMaxForce = T(0.04);  ///< e_T [1] > 0, FmaxTendonStrain
  T passiveStrainAtMaxForce = T(0.6);  ///< e_M [1] > 0, FmaxMuscleStrain
  T activeWidth = T(0.45);             ///< γ [1] > 0, KshapeActive
  T passiveShape = T(5.0);             ///< k [1] > 0, KshapePassive
  T velocityShape = T(0.25);           ///< A_f [1] > 0, Af
  T maxLengtheningForce = T(1.4);      ///< F_len [1] > 1, Flen
  T extrapolationThreshold = T(0.95);  ///< ϑ [1], 1/F_len < ϑ < 1, fv_linear_extrap_threshold
  T maximumPennation = T(1.4706289056333368);  ///< [rad]; says where OpenSim holds the fibre
  T activationTime = T(0.015);                 ///< τ_a [s] > 0
  T deactivationTime = T(0.05);                ///< τ_d [s] > 0
  T minimumActivation = T(0.01);               ///< [1], 0.01 ≤ a_min < 1

  Thelen2003Parameters() { minControl = 0.01; }

  static constexpr std::size_t count = 16;
  static constexpr std::array<MuscleProperty, count> properties{{
      common::properties[0],
      common::properties[1],
      common::properties[2],
      common::properties[3],
      common::properties[4],
      {"FmaxTendonStrain", "", positive},
      {"FmaxMuscleStrain", "", positive},
      {"KshapeActive", "", positive},
      {"KshapePassive", "", positive},
      {"Af", "", positive},
      {"Flen", "", {.low = 1}},
      {"fv_linear_extrap_threshold", "", {.low = 0, .high = 1}},
      {"maximum_pennation_angle", "rad", {.low = 0, .high = 1.5707963267948966}},
      {"activation_time_constant", "s", positive},
      {"deactivation_time_constant", "s", positive},
      {"minimum_activation", "", {.low = 0.01, .high = 1, .withLow = true}},
  }};
  template <class P>
  static constexpr auto& at(P& p, std::size_t i) {
    using M = Thelen2003Parameters;
    constexpr std::array<T M::*, count> members{&M::maxIsometricForce,
                                                &M::optimalFibreLength,
                                                &M::tendonSlackLength,
                                                &M::pennation,
                                                &M::maxContractionVelocity,
                                                &M::tendonStrainAtMaxForce,
                                                &M::passiveStrainAtMaxForce,
                                                &M::activeWidth,
                                                &M::passiveShape,
                                                &M::velocityShape,
                                                &M::maxLengtheningForce,
                                                &M::extrapolationThreshold,
                                                &M::maximumPennation,
                                                &M::activationTime,
                                                &M::deactivationTime,
                                                &M::minimumActivation};
    return p.*members[i];
  }
  template <class U>
  void takeSwitches(const Thelen2003Parameters<U>& from) {
    MuscleSwitches::operator=(from);
  }
  /// Ranges and the rules between numbers.
  /// @throws std::invalid_argument naming number, value and rule
  void requireRules() const;
  /// Whether the number of that place is one; all are.
  constexpr bool isGiven(std::size_t) const { return true; }
  /// The activation dynamics that numbers and switches mean.
  AnyActivation activation() const;
  friend bool operator==(const Thelen2003Parameters&, const Thelen2003Parameters&) = default;
};

/// The shape of Thelen's muscle (Thelen 2003, J. Biomech. Eng. 125; OpenSim 4.6, Thelen2003Muscle):
///
///     f_T(ε) = 0 (ε ≤ 0),  0.33 (e^{3ε/e_toe} − 1)/(e³ − 1) (ε ≤ e_toe),  0.33 + k_lin (ε − e_toe)
///              e_toe = 99 e_T e³/(166 e³ − 67),  k_lin = 0.67/(e_T − e_toe)
///     f_l(l) = exp(−(l − 1)²/γ)
///     f_PE(l) = (e^{k(l−1)/e_M} − 1)/(e^k − 1),  0 for l ≤ 1
///     v(P; A, a), with c = ¼ + ¾a and m = (2 + 2/A_f)/(F_len − 1):
///         c (P − A)/(A + P/A_f)          for 0 < P ≤ A
///         c (P − A)/(m (A F_len − P))    for A < P < ϑ A F_len
///         the tangents of the two at P = 0 below and at P = ϑ A F_len above
///
/// No damping. f_T is C¹ but at ε = 0, f_PE is C⁰ at l = 1, the slope of v(P) halves at P = A:
/// there the derivatives are those of the upper side (lower at P = A, where v counts as
/// shortening).
template <class T>
class Thelen2003 {
 public:
  using Number = T;
  using Parameters = Thelen2003Parameters<T>;
  static constexpr const char* className = "Thelen2003Muscle";
  static constexpr std::size_t numOwn = Parameters::count - common::count;
  static constexpr std::size_t dampingPlace = Parameters::count;  ///< none
  static constexpr std::size_t minimumActivationPlace = 15;
  static constexpr bool rigidForceIsCut = true;
  static constexpr bool stepsByBalance = false;

  explicit Thelen2003(const Parameters& p) : p_(p) {
    using std::exp;
    toeStrain_ = p.tendonStrainAtMaxForce * toeShare;
    perToe_ = 3.0 / toeStrain_;
    linearSlope_ = 0.67 / (p.tendonStrainAtMaxForce - toeStrain_);
    perWidth_ = 1.0 / p.activeWidth;
    passiveRate_ = p.passiveShape / p.passiveStrainAtMaxForce;
    passiveScale_ = 1.0 / (exp(p.passiveShape) - 1.0);
    numbers_ = {p.velocityShape, p.maxLengtheningForce, p.extrapolationThreshold};
    branches_ = branchesOf(numbers_);
  }

  const Parameters& parameters() const { return p_; }
  double damping() const { return 0; }
  bool dampingActs() const { return false; }
  const T& minimumActivation() const { return p_.minimumActivation; }
  double maximumActivation() const { return 1; }
  /// w/sin α_max
  auto shortestFibre(const T& thickness) const {
    using std::sin;
    return plainValue(thickness) / sin(plainValue(p_.maximumPennation));
  }

  template <class U>
  CurvePoint<Joint<T, U>> tendonForce(const U& strain) const {
    using R = Joint<T, U>;
    using std::exp;
    using Point = CurvePoint<R>;
    return branch(
        plainValue(strain) <= 0,
        [] {
          return Point{R(0.0), R(0.0), R(0.0)};
        },
        [&] {
          return branch(
              plainValue(strain) > plainValue(toeStrain_),
              [&] {
                return Point{0.33 + linearSlope_ * (strain - toeStrain_), R(linearSlope_), R(0.0)};
              },
              [&] {
                const R power = toeScale * exp(R(perToe_ * strain));
                const R slope = perToe_ * power;
                return Point{power - toeScale, slope, perToe_ * slope};
              });
        });
  }

  template <class U>
  CurvePoint<Joint<T, U>> activeForce(const U& l) const {
    using R = Joint<T, U>;
    using std::exp;
    const R x = l - 1.0;
    const R value = exp(R(-(x * x) * perWidth_));
    const R rate = -2.0 * x * perWidth_;
    return {value, rate * value, (rate * rate - 2.0 * perWidth_) * value};
  }

  template <class U>
  CurvePoint<Joint<T, U>> passiveForce(const U& l) const {
    using R = Joint<T, U>;
    using std::exp;
    using Point = CurvePoint<R>;
    return branch(
        plainValue(l) <= 1,
        [] {
          return Point{R(0.0), R(0.0), R(0.0)};
        },
        [&] {
          const R power = passiveScale_ * exp(R(passiveRate_ * (l - 1.0)));
          const R slope = passiveRate_ * power;
          return Point{power - passiveScale_, slope, passiveRate_ * slope};
        });
  }

  /// v(P; A, a), A > 0.
  template <class U>
  FibreSpeed<Joint<T, U>> speed(const U& P, const U& A, const U& a) const {
    using R = Joint<T, U>;
    return speedOf<R>(numbers_, branches_, R(P), R(A), R(a));
  }

  /// f_v(v; a): the inverse of v at A = 1; not bounded, negative for v < −c.
  template <class U>
  ForceVelocity<Joint<T, U>> forceVelocity(const U& v, const U& a) const {
    using R = Joint<T, U>;
    return forceOf<R>(numbers_, branches_, R(v), R(a));
  }

  using Own = std::array<double, numOwn>;
  Own tendonForceInOwn(double strain) const;
  Own activeForceInOwn(double l) const;
  Own passiveForceInOwn(double l) const;
  Own forceVelocityInOwn(double v, double a) const;
  Own speedInOwn(double P, double A, double a) const;

 private:
  static constexpr double e3 = 20.085536923187668;
  static constexpr double toeShare = 99 * e3 / (166 * e3 - 67);
  static constexpr double toeScale = 0.33 / (e3 - 1);

  template <class N>
  struct Numbers {
    N shape, lengthening, threshold;  // A_f, F_len, ϑ
  };
  /// Terms that the branches of v(P) have in common.
  template <class N>
  struct Branches {
    N perShape;  // 1/A_f
    N m;         // (2 + 2/A_f)/(F_len − 1)
    N end;       // ϑ F_len: P/A where the last tangent begins
    N endSpeed;  // v/c there
    N endSlope;  // A/c ∂v/∂P there
  };
  template <class N>
  static Branches<N> branchesOf(const Numbers<N>& n) {
    Branches<N> b;
    b.perShape = 1.0 / n.shape;
    b.m = (2.0 + 2.0 * b.perShape) / (n.lengthening - 1.0);
    b.end = n.threshold * n.lengthening;
    const N left = n.lengthening - b.end;
    b.endSpeed = (b.end - 1.0) / (b.m * left);
    b.endSlope = (n.lengthening - 1.0) / (b.m * left * left);
    return b;
  }

  template <class R, class N>
  static FibreSpeed<R> speedOf(const Numbers<N>& n, const Branches<N>& b, const R& P, const R& A,
                               const R& a) {
    using Speed = FibreSpeed<R>;
    const R c = 0.25 + 0.75 * a;
    const auto shortening = [&] {
      const R per = 1.0 / (A + P * b.perShape);
      const R share = (P - A) * per;
      const R slope = c * (1.0 + b.perShape) * per * per;
      return Speed{c * share, slope * A, -(slope * P), 0.75 * share};
    };
    const auto beyondShortening = [&] {
      const R perA = 1.0 / A;
      const R slope = (1.0 + b.perShape) * perA;
      const R share = slope * P - 1.0;
      return Speed{c * share, c * slope, -(c * slope * P * perA), 0.75 * share};
    };
    const auto lengthening = [&] {
      const R per = 1.0 / (A * n.lengthening - P);
      const R share = (P - A) * per / b.m;
      const R slope = c * (n.lengthening - 1.0) / b.m * per * per;
      return Speed{c * share, slope * A, -(slope * P), 0.75 * share};
    };
    const auto beyondLengthening = [&] {
      const R perA = 1.0 / A;
      const R slope = b.endSlope * perA;
      const R share = b.endSpeed + slope * P - b.endSlope * b.end;
      return Speed{c * share, c * slope, -(c * slope * P * perA), 0.75 * share};
    };
    return branch(plainValue(P) > 0 && plainValue(P) <= plainValue(A), shortening, [&] {
      return branch(plainValue(P) <= 0, beyondShortening, [&] {
        return branch(plainValue(P) < plainValue(b.end) * plainValue(A), lengthening,
                      beyondLengthening);
      });
    });
  }

  template <class R, class N>
  static ForceVelocity<R> forceOf(const Numbers<N>& n, const Branches<N>& b, const R& v,
                                  const R& a) {
    const R c = 0.25 + 0.75 * a;
    const auto plain = plainValue(v);
    // everything depends on x = v/c: ∂f_v/∂a = −¾ f_v′(x) x/c
    const R perC = 1.0 / c;
    const R x = v * perC;
    struct Point {
      R value, slope;  // slope over x
    };
    const auto beyondShortening = [&] {
      const R slope = R(1.0 / (1.0 + b.perShape));
      return Point{(x + 1.0) * slope, slope};
    };
    const auto shortening = [&] {
      const R per = 1.0 / (1.0 - x * b.perShape);
      return Point{(1.0 + x) * per, (1.0 + b.perShape) * per * per};
    };
    const auto lengthening = [&] {
      const R per = 1.0 / (1.0 + b.m * x);
      return Point{(1.0 + b.m * x * n.lengthening) * per, b.m * (n.lengthening - 1.0) * per * per};
    };
    const auto beyondLengthening = [&] {
      const R slope = R(1.0 / b.endSlope);
      return Point{b.end + (x - b.endSpeed) * slope, slope};
    };
    const Point f = branch(plain < -plainValue(c), beyondShortening, [&] {
      return branch(plain <= 0, shortening, [&] {
        return branch(plainValue(x) < plainValue(b.endSpeed), lengthening, beyondLengthening);
      });
    });
    const R slope = f.slope * perC;
    return {f.value, slope, -0.75 * x * slope};
  }

  Parameters p_;
  T toeStrain_, perToe_, linearSlope_, perWidth_, passiveRate_, passiveScale_;
  Numbers<T> numbers_;
  Branches<T> branches_;
};

template <>
void Thelen2003Parameters<double>::requireRules() const;
template <>
AnyActivation Thelen2003Parameters<double>::activation() const;
template <>
auto Thelen2003<double>::tendonForceInOwn(double strain) const -> Own;
template <>
auto Thelen2003<double>::activeForceInOwn(double l) const -> Own;
template <>
auto Thelen2003<double>::passiveForceInOwn(double l) const -> Own;
template <>
auto Thelen2003<double>::forceVelocityInOwn(double v, double a) const -> Own;
template <>
auto Thelen2003<double>::speedInOwn(double P, double A, double a) const -> Own;

}  // namespace bio::muscles
