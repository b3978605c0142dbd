#pragma once

#include <array>
#include <cstddef>

#include "bio/muscle/hill_muscle.h"

namespace bio::muscles {

/// Scales of the curves, which every class has besides its own numbers; they are 1 as the model
/// stands and derivatives are taken there:
///     f_T(ε/s_T),   s_a·f_l(1 + (l − 1)/s_w),   s_p·f_PE(l)
namespace scales {
inline constexpr std::size_t tendonStrain = 0, activeForce = 1, activeWidth = 2, passiveForce = 3,
                             count = 4;
}

/// How many numbers results are differentiated in: one per property of the class, in the order of
/// Parameters::properties, then one per scale. maximum_pennation_angle enters only where a
/// fibre is held, the time constants of the activation no result here.
template <class Shape>
inline constexpr std::size_t numNumbers = Shape::Parameters::count + scales::count;
template <class Shape>
using PerNumber = std::array<double, numNumbers<Shape>>;

/// ∂/∂θ of shortestFibre() of a class that holds its fibres: of the shortest active fibre where the
/// class has one and that is longer, else of w/sin α_max.
template <class Shape>
PerNumber<Shape> shortestFibreInNumbers(const HillMuscle<Shape>& muscle) {
  static_assert(holdsFibre<Shape>);
  using Parameters = typename Shape::Parameters;
  constexpr std::size_t activePlace =
      placeOf<Parameters>("ActiveForceLengthCurve/min_norm_active_fiber_length");
  constexpr std::size_t pennationPlace = placeOf<Parameters>("maximum_pennation_angle");
  const Parameters& p = muscle.parameters();
  const double largest = Parameters::at(p, pennationPlace);
  PerNumber<Shape> r{};
  if constexpr (activePlace < Parameters::count) {
    const double active = Parameters::at(p, activePlace);
    if (active * p.optimalFibreLength >= muscle.thickness() / std::sin(largest)) {
      r[common::optimalFibreLength] = active;
      r[activePlace] = p.optimalFibreLength;
      return r;
    }
  }
  r[common::optimalFibreLength] = std::sin(p.pennation) / std::sin(largest);
  r[common::pennation] = p.optimalFibreLength * std::cos(p.pennation) / std::sin(largest);
  r[pennationPlace] = -muscle.shortestFibre() / std::tan(largest);
  return r;
}

/// Partial derivatives of an equation's left-hand side and of the tendon force in a muscle's
/// numbers. At a kink those of the side that the law itself takes.
template <class Shape>
struct InNumbers {
  PerNumber<Shape> equation{};     ///< of V [m/s per unit] or of the balance [1 per unit]
  PerNumber<Shape> tendonForce{};  ///< ∂F_T/∂θ [N per unit]
};

namespace detail {

template <class Shape>
void addOwn(PerNumber<Shape>& to, const std::array<double, Shape::numOwn>& own, double factor) {
  for (std::size_t i = 0; i < Shape::numOwn; ++i) to[common::count + i] += factor * own[i];
}

/// A = a f_l and f_PE with their derivatives in the numbers at fixed a and ℓ.
template <class Shape>
struct FibreInNumbers {
  double act;                ///< a as it acts
  bool isFloored;            ///< it acts as the class's least
  double w_l0, w_pennation;  ///< ∂w/∂ℓ0, ∂w/∂α0
  CurvePoint<double> active, passive;
  PerNumber<Shape> dActive{}, dPassive{};
};
template <class Shape>
FibreInNumbers<Shape> fibreInNumbers(const HillMuscle<Shape>& muscle, double activation,
                                     double fibreLength) {
  const auto& p = muscle.parameters();
  const Shape& shape = muscle.shape();
  constexpr std::size_t scale = Shape::Parameters::count;
  const double l = fibreLength * muscle.perFibre();
  const double l_l0 = -l * muscle.perFibre();
  FibreInNumbers<Shape> f{
      .act = muscle.acting(activation),
      .isFloored = activation < shape.minimumActivation() && Shape::minimumActivationPlace < scale,
      .w_l0 = std::sin(p.pennation),
      .w_pennation = p.optimalFibreLength * std::cos(p.pennation),
      .active = shape.activeForce(l),
      .passive = shape.passiveForce(l)};
  f.dActive[common::optimalFibreLength] = f.act * f.active.slope * l_l0;
  f.dActive[scale + scales::activeForce] = f.act * f.active.value;
  f.dActive[scale + scales::activeWidth] = -f.act * f.active.slope * (l - 1);
  addOwn<Shape>(f.dActive, shape.activeForceInOwn(l), f.act);
  if (f.isFloored) f.dActive[Shape::minimumActivationPlace] += f.active.value;
  f.dPassive[common::optimalFibreLength] = f.passive.slope * l_l0;
  f.dPassive[scale + scales::passiveForce] = f.passive.value;
  addOwn<Shape>(f.dPassive, shape.passiveForceInOwn(l), 1);
  return f;
}

/// f_T(ε) with its derivatives in the numbers at fixed ℓ and L.
template <class Shape>
struct TendonInNumbers {
  CurvePoint<double> tendon;
  PerNumber<Shape> dTendon{};
};
template <class Shape>
TendonInNumbers<Shape> tendonInNumbers(const HillMuscle<Shape>& muscle,
                                       const FibreInNumbers<Shape>& fibre, double projected,
                                       double pathLength) {
  const double strain = (pathLength - projected) * muscle.perTendon() - 1;
  TendonInNumbers<Shape> t{.tendon = muscle.shape().tendonForce(strain)};
  const double perStrain = t.tendon.slope * muscle.perTendon();
  const double byThickness = perStrain * muscle.thickness() / projected;
  t.dTendon[common::optimalFibreLength] = byThickness * fibre.w_l0;
  t.dTendon[common::pennation] = byThickness * fibre.w_pennation;
  t.dTendon[common::tendonSlackLength] = -perStrain * (strain + 1);
  t.dTendon[Shape::Parameters::count + scales::tendonStrain] = -t.tendon.slope * strain;
  addOwn<Shape>(t.dTendon, muscle.shape().tendonForceInOwn(strain), 1);
  return t;
}

template <class Shape>
void addForce(const HillMuscle<Shape>& muscle, const TendonInNumbers<Shape>& t,
              InNumbers<Shape>& r) {
  for (std::size_t i = 0; i < t.dTendon.size(); ++i) {
    r.tendonForce[i] = muscle.parameters().maxIsometricForce * t.dTendon[i];
  }
  r.tendonForce[common::maxIsometricForce] += t.tendon.value;
}

}  // namespace detail

/// ∂V/∂θ and ∂F_T/∂θ of fibreRate at fixed a, ℓ and L. With V = V₀ ℓ0 v(P, A, a; θ),
///     v_θ = v_P P_θ + v_A A_θ + v_θ|P,A
template <class Shape>
InNumbers<Shape> fibreRateInNumbers(const HillMuscle<Shape>& muscle, double activation,
                                    double fibreLength, double pathLength) {
  const auto& p = muscle.parameters();
  const double d = muscle.projected(fibreLength);
  const auto f = detail::fibreInNumbers(muscle, activation, fibreLength);
  const auto t = detail::tendonInNumbers(muscle, f, d, pathLength);
  const double kappa = fibreLength / d;
  const double P = t.tendon.value * kappa - f.passive.value, A = f.act * f.active.value;
  const FibreSpeed<double> s = muscle.shape().speed(P, A, f.act);
  const double speed = muscle.speedScale();

  InNumbers<Shape> r;
  for (std::size_t i = 0; i < r.equation.size(); ++i) {
    r.equation[i] =
        speed * (s.byForce * (kappa * t.dTendon[i] - f.dPassive[i]) + s.byActive * f.dActive[i]);
  }
  // κ_w = κ w/d²
  const double byThickness =
      speed * s.byForce * t.tendon.value * kappa * muscle.thickness() / (d * d);
  r.equation[common::optimalFibreLength] += byThickness * f.w_l0 + p.maxContractionVelocity * s.v;
  r.equation[common::pennation] += byThickness * f.w_pennation;
  r.equation[common::maxContractionVelocity] += p.optimalFibreLength * s.v;
  detail::addOwn<Shape>(r.equation, muscle.shape().speedInOwn(P, A, f.act), speed);
  if (f.isFloored) r.equation[Shape::minimumActivationPlace] += speed * s.byActivation;
  detail::addForce(muscle, t, r);
  return r;
}

/// ∂R/∂θ and ∂F_T/∂θ of fibreBalance at fixed a, ℓ, L and ℓ̇.
template <class Shape>
InNumbers<Shape> fibreBalanceInNumbers(const HillMuscle<Shape>& muscle, double activation,
                                       double fibreLength, double pathLength,
                                       double fibreVelocity) {
  const auto& p = muscle.parameters();
  const Shape& shape = muscle.shape();
  const double d = muscle.projected(fibreLength);
  const auto f = detail::fibreInNumbers(muscle, activation, fibreLength);
  const auto t = detail::tendonInNumbers(muscle, f, d, pathLength);
  const double cosine = d / fibreLength;
  const double v = fibreVelocity / muscle.speedScale();
  const double A = f.act * f.active.value;
  const ForceVelocity<double> f_v = shape.forceVelocity(v, f.act);
  const double force = A * f_v.value + f.passive.value + shape.damping() * v;
  const double force_v = A * f_v.slope + shape.damping();

  InNumbers<Shape> r;
  for (std::size_t i = 0; i < r.equation.size(); ++i) {
    r.equation[i] = (f.dActive[i] * f_v.value + f.dPassive[i]) * cosine - t.dTendon[i];
  }
  const double byThickness = -force * muscle.thickness() / (fibreLength * d);
  const double bySpeed = -force_v * v * cosine;  // v goes as 1/(V ℓ0)
  r.equation[common::optimalFibreLength] += byThickness * f.w_l0 + bySpeed / p.optimalFibreLength;
  r.equation[common::pennation] += byThickness * f.w_pennation;
  r.equation[common::maxContractionVelocity] += bySpeed / p.maxContractionVelocity;
  detail::addOwn<Shape>(r.equation, shape.forceVelocityInOwn(v, f.act), A * cosine);
  if (shape.dampingActs()) r.equation[Shape::dampingPlace] += v * cosine;
  if (f.isFloored) r.equation[Shape::minimumActivationPlace] += A * f_v.byActivation * cosine;
  detail::addForce(muscle, t, r);
  return r;
}

/// ∂F_T/∂θ of rigidRate at fixed a, L and L̇; 0 where the force is cut.
template <class Shape>
PerNumber<Shape> rigidForceInNumbers(const HillMuscle<Shape>& muscle, double activation,
                                     double pathLength, double pathSpeed) {
  PerNumber<Shape> r{};
  const RigidRate<double> rate = muscle.rigidRate(activation, pathLength, pathSpeed);
  const auto& p = muscle.parameters();
  const double along = pathLength - p.tendonSlackLength;
  if (along <= 0 || (Shape::rigidForceIsCut && rate.tendonForce <= 0)) return r;
  const Shape& shape = muscle.shape();
  const auto f = detail::fibreInNumbers(muscle, activation, rate.fibreLength);
  const double length = rate.fibreLength, w = muscle.thickness();
  const double cosine = along / length;
  const double v = rate.fibreVelocity / muscle.speedScale();
  const double A = f.act * f.active.value;
  const ForceVelocity<double> f_v = shape.forceVelocity(v, f.act);
  const double force = A * f_v.value + f.passive.value + shape.damping() * v;
  const double force_v = A * f_v.slope + shape.damping();

  const double scale = p.maxIsometricForce * cosine;
  for (std::size_t i = 0; i < r.size(); ++i) {
    r[i] = scale * (f.dActive[i] * f_v.value + f.dPassive[i]);
  }
  detail::addOwn<Shape>(r, shape.forceVelocityInOwn(v, f.act), scale * A);
  if (shape.dampingActs()) r[Shape::dampingPlace] += scale * v;
  if (f.isFloored) r[Shape::minimumActivationPlace] += scale * A * f_v.byActivation;
  // the thickness turns and lengthens the fibre and slows it
  const double cosine_w = -along * w / (length * length * length);
  const double force_w =
      (f.act * f.active.slope * f_v.value + f.passive.slope) * muscle.perFibre() * w / length +
      force_v * pathSpeed * (fibreMovesAsPath<Shape> ? 0 : cosine_w) / muscle.speedScale();
  const double byThickness = p.maxIsometricForce * (force_w * cosine + force * cosine_w);
  r[common::maxIsometricForce] += force * cosine;
  r[common::optimalFibreLength] +=
      byThickness * f.w_l0 - scale * force_v * v / p.optimalFibreLength;
  r[common::pennation] += byThickness * f.w_pennation;
  r[common::tendonSlackLength] -= rate.dF_dPathLength;
  r[common::maxContractionVelocity] -= scale * force_v * v / p.maxContractionVelocity;
  return r;
}

}  // namespace bio::muscles
