#pragma once

#include <cmath>
#include <limits>

#include "bio/muscle/activation_variant.h"
#include "bio/muscle/hill_shape.h"

namespace bio::muscles {

/// Numbers of DeGrooteFregly2016Muscle, at OpenSim's defaults.
template <class T = double>
struct DeGrooteFregly2016Parameters : HillParameters<T>, MuscleSwitches {
  T fibreDamping = T(0.0);         ///< β [F0/(V ℓ0)] ≥ 0
  T activeWidth = T(1.0);          ///< ω [1] ≥ 1, active_force_width_scale
  T passiveUnitStrain = T(0.6);    ///< e_M [1] > 0, passive_fiber_strain_at_one_norm_force
  T tendonUnitStrain = T(0.049);   ///< e_T [1] > 0, tendon_strain_at_one_norm_force
  T activationTime = T(0.015);     ///< τ_a [s] > 0
  T deactivationTime = T(0.060);   ///< τ_d [s] > 0
  T activationSmoothing = T(0.1);  ///< b [1] > 0, activation_dynamics_smoothing
  bool ignorePassiveFibreForce = false;

  static constexpr std::size_t count = 12;
  static constexpr std::array<MuscleProperty, count> properties{{
      common::properties[0],
      common::properties[1],
      common::properties[2],
      common::properties[3],
      common::properties[4],
      {"fiber_damping", "F0/(V l0)", notNegative},
      {"active_force_width_scale", "", {.low = 1, .withLow = true}},
      {"passive_fiber_strain_at_one_norm_force", "", positive},
      {"tendon_strain_at_one_norm_force", "", positive},
      {"activation_time_constant", "s", positive},
      {"deactivation_time_constant", "s", positive},
      {"activation_dynamics_smoothing", "", positive},
  }};
  template <class P>
  static constexpr auto& at(P& p, std::size_t i) {
    using M = DeGrooteFregly2016Parameters;
    constexpr std::array<T M::*, count> members{
        &M::maxIsometricForce, &M::optimalFibreLength,     &M::tendonSlackLength,
        &M::pennation,         &M::maxContractionVelocity, &M::fibreDamping,
        &M::activeWidth,       &M::passiveUnitStrain,      &M::tendonUnitStrain,
        &M::activationTime,    &M::deactivationTime,       &M::activationSmoothing};
    return p.*members[i];
  }
  template <class U>
  void takeSwitches(const DeGrooteFregly2016Parameters<U>& from) {
    MuscleSwitches::operator=(from);
    ignorePassiveFibreForce = from.ignorePassiveFibreForce;
  }
  /// @throws std::invalid_argument naming number, value and rule
  void requireRules() const;
  /// Whether the number of that place is one; all are.
  constexpr bool isGiven(std::size_t) const { return true; }
  /// The activation dynamics that numbers and switches mean.
  AnyActivation activation() const;
  friend bool operator==(const DeGrooteFregly2016Parameters&,
                         const DeGrooteFregly2016Parameters&) = default;
};

namespace degroote {

// The constants of f_v.
inline constexpr double d1 = -0.3211346127989808, d2 = -8.149, d3 = -0.374, d4 = 0.8825327733249912;

/// y = asinh(d₂v + d₃) where A·f_v(v) + B·v = P, A ≥ 0, B ≥ 0, not both 0: by Newton's
/// method in a bracket.
double dampedPlace(double P, double A, double B);

}  // namespace degroote

/// The shape of De Groote's and Fregly's muscle (De Groote, Kinney, Rao, Fregly 2016, Ann. Biomed.
/// Eng. 44, with the constants of OpenSim 4.6, DeGrooteFregly2016Muscle, where f_T(0) = 0,
/// f_l(1) = 1, f_v(−1) = 0 and f_v(0) = 1):
///
///     f_T(ε) = 0.2 exp(k ε) − 0.2,  k = ln 6/e_T                   negative where slack
///     f_l(l) = Σ b₁ exp(−½ (x − b₂)²/(b₃ + b₄x)²),  x = (l − 1)/ω + 1
///     f_PE(l) = (exp(4(l−1)/e_M) − o)/(e⁴ − o),  o = exp(−3.2/e_M)   0 at l = 0.2
///     f_v(v) = d₁ asinh(d₂v + d₃) + d₄
///
/// All curves are smooth for l > 0.1495 (f_l has an essential singularity there; the authors'
/// domain is 0.2 … 1.8). v(P, A) = (sinh((P/A − d₄)/d₁) − d₃)/d₂ grows beyond all bounds where A is
/// small: a step should solve the force balance instead (HillMuscle::fibreBalance).
///
/// Departures from OpenSim: damping (β > 0, not the default) acts on the fibre whatever
/// tendon_compliance_dynamics_mode says, there only with "implicit" or a rigid tendon; activation
/// acts as 1e-3 at least, where OpenSim divides by it.
template <class T>
class DeGrooteFregly2016 {
 public:
  using Number = T;
  using Parameters = DeGrooteFregly2016Parameters<T>;
  static constexpr const char* className = "DeGrooteFregly2016Muscle";
  static constexpr std::size_t numOwn = Parameters::count - common::count;
  static constexpr std::size_t dampingPlace = 5;
  static constexpr std::size_t minimumActivationPlace = Parameters::count;  ///< none
  static constexpr bool rigidForceIsCut = false;
  static constexpr bool stepsByBalance = true;

  explicit DeGrooteFregly2016(const Parameters& p) : p_(p) {
    using std::exp;
    tendonRate_ = 1.791759469228055 / p.tendonUnitStrain;  // ln 6
    perWidth_ = 1.0 / p.activeWidth;
    passiveRate_ = 4.0 / p.passiveUnitStrain;
    offset_ = exp(T(-0.8 * passiveRate_));
    passiveScale_ = 1.0 / (e4 - offset_);
    if (p.ignorePassiveFibreForce) passiveScale_ = T(0.0);
  }

  const Parameters& parameters() const { return p_; }
  const T& damping() const { return p_.fibreDamping; }
  bool dampingActs() const { return true; }
  double minimumActivation() const { return 1e-3; }
  double maximumActivation() const { return std::numeric_limits<double>::infinity(); }
  auto shortestFibre(const T& thickness) const { return plainValue(thickness); }

  template <class U>
  CurvePoint<Joint<T, U>> tendonForce(const U& strain) const {
    using R = Joint<T, U>;
    using std::exp;
    const R power = 0.2 * exp(R(tendonRate_ * strain));
    const R slope = tendonRate_ * power;
    return {power - 0.2, slope, tendonRate_ * slope};
  }

  template <class U>
  CurvePoint<Joint<T, U>> activeForce(const U& l) const {
    using R = Joint<T, U>;
    const R x = (l - 1.0) * perWidth_ + 1.0;
    R value(0.0), slope(0.0), curvature(0.0);
    const auto add = [&](double b1, double b2, double b3, double b4) {
      using std::exp;
      // q = (x − b₂)/(b₃ + b₄x)
      const R per = 1.0 / (b3 + b4 * x);
      const R q = (x - b2) * per;
      const R dq = (b3 + b4 * b2) * per * per;
      const R term = b1 * exp(R(-0.5 * q * q));
      const R rate = q * dq;
      value += term;
      slope -= rate * term;
      curvature += (rate * rate - dq * dq + 2.0 * b4 * q * dq * per) * term;
    };
    add(0.8150671134243542, 1.055033428970575, 0.162384573599574, 0.063303448465465);
    add(0.433004984392647, 0.716775413397760, -0.029947116970696, 0.200356847296188);
    add(0.1, 1.0, 0.353553390593274, 0.0);
    return {value, slope * perWidth_, curvature * perWidth_ * perWidth_};
  }

  template <class U>
  CurvePoint<Joint<T, U>> passiveForce(const U& l) const {
    using R = Joint<T, U>;
    using std::exp;
    const R power = passiveScale_ * exp(R(passiveRate_ * (l - 1.0)));
    const R slope = passiveRate_ * power;
    return {power - passiveScale_ * offset_, slope, passiveRate_ * slope};
  }

  template <class U>
  ForceVelocity<Joint<T, U>> forceVelocity(const U& v, const U&) const {
    using R = Joint<T, U>;
    using std::log, std::sqrt;
    const R x = R(d2 * v + d3);
    const R root = sqrt(R(x * x + 1.0));
    // asinh x, without cancellation on either side
    const R area = branch(
        plainValue(x) < 0, [&] { return R(-log(R(root - x))); },
        [&] { return R(log(R(root + x))); });
    return {d1 * area + d4, d1 * d2 / root, R(0.0)};
  }

  template <class U>
  FibreSpeed<Joint<T, U>> speed(const U& P, const U& A, const U&) const {
    using R = Joint<T, U>;
    using std::exp;
    if (std::is_same_v<T, double> && plainValue(p_.fibreDamping) == 0) {
      const R perA = 1.0 / A;
      const R f = P * perA;
      const R power = exp(R((f - d4) * (1 / d1)));
      const R inverse = 1.0 / power;
      const R v = (0.5 * (power - inverse) - d3) * (1 / d2);
      const R byForce = 0.5 / (d1 * d2) * (power + inverse) * perA;
      return {v, byForce, -(f * byForce), R(0.0)};
    }
    // y = asinh(d₂v + d₃): A (d₁y + d₄) + β (sinh y − d₃)/d₂ = P
    R y = R(degroote::dampedPlace(plainValue(P), plainValue(A), plainValue(p_.fibreDamping)));
    R v, f, slope;
    for (int k = 0; k <= derivativeOrder<R>; ++k) {
      const R power = exp(y);
      const R inverse = 1.0 / power;
      v = (0.5 * (power - inverse) - d3) * (1 / d2);
      f = d1 * y + d4;
      slope = d1 * d2 / (0.5 * (power + inverse));
      const R excess = A * f + p_.fibreDamping * v - P;
      if (k < derivativeOrder<R>) y = y - excess / (A * d1 + p_.fibreDamping * d1 / slope);
    }
    const R byForce = 1.0 / (A * slope + p_.fibreDamping);
    return {v, byForce, -(f * byForce), R(0.0)};
  }

  using Own = std::array<double, numOwn>;
  Own tendonForceInOwn(double strain) const;
  Own activeForceInOwn(double l) const;
  Own passiveForceInOwn(double l) const;
  Own forceVelocityInOwn(double v, double a) const;
  Own speedInOwn(double P, double A, double a) const;

 private:
  static constexpr double e4 = 54.598150033144236;
  static constexpr double d1 = degroote::d1, d2 = degroote::d2, d3 = degroote::d3,
                          d4 = degroote::d4;

  Parameters p_;
  T tendonRate_, perWidth_, passiveRate_, offset_, passiveScale_;
};

template <>
void DeGrooteFregly2016Parameters<double>::requireRules() const;
template <>
AnyActivation DeGrooteFregly2016Parameters<double>::activation() const;
template <>
auto DeGrooteFregly2016<double>::tendonForceInOwn(double strain) const -> Own;
template <>
auto DeGrooteFregly2016<double>::activeForceInOwn(double l) const -> Own;
template <>
auto DeGrooteFregly2016<double>::passiveForceInOwn(double l) const -> Own;
template <>
auto DeGrooteFregly2016<double>::forceVelocityInOwn(double v, double a) const -> Own;
template <>
auto DeGrooteFregly2016<double>::speedInOwn(double P, double A, double a) const -> Own;

}  // namespace bio::muscles
