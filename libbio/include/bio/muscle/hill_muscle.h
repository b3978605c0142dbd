#pragma once

#include <cmath>
#include <limits>
#include <utility>

#include "bio/muscle/hill_shape.h"

namespace bio::muscles {

/// Fibre velocity and tendon force at a state, with their first derivatives.
template <class T>
struct FibreRate {
  T fibreVelocity;    ///< ℓ̇ = V(a, ℓ, L) [m/s], lengthening > 0
  T tendonForce;      ///< F_T [N]
  T dV_dActivation;   ///< [m/s]
  T dV_dFibreLength;  ///< [1/s]
  T dV_dPathLength;   ///< [1/s]
  T dF_dFibreLength;  ///< [N/m]
  T dF_dPathLength;   ///< [N/m]
};

/// How far a state with a given fibre velocity is from balance, with first derivatives: an equation
/// for the fibre that stays good where V(a, ℓ, L) grows beyond bounds.
template <class T>
struct FibreBalance {
  T residual;     ///< [a f_l f_v + f_PE + B v] cos α − f_T, in units of F0
  T tendonForce;  ///< F_T [N]
  T dR_dActivation;
  T dR_dFibreLength;    ///< [1/m]
  T dR_dPathLength;     ///< [1/m]
  T dR_dFibreVelocity;  ///< [s/m] > 0: residual/dR_dFibreVelocity is about the error of ℓ̇
  T dF_dFibreLength;    ///< [N/m]
  T dF_dPathLength;     ///< [N/m]
};

/// The force of a muscle with a rigid tendon, which follows the path and has no state.
template <class T>
struct RigidRate {
  T tendonForce;     ///< F_T [N]
  T fibreLength;     ///< ℓ = √((L − ℓs)² + w²) [m]
  T fibreVelocity;   ///< ℓ̇ = L̇ cos α [m/s]; L̇ of a class whose fibreMovesAsPath
  T dF_dActivation;  ///< [N]
  T dF_dPathLength;  ///< [N/m]
  T dF_dPathSpeed;   ///< [N s/m] ≥ 0
};

/// Whether the fibre of a class with a rigid tendon has the velocity of the path.
template <class Shape>
inline constexpr bool fibreMovesAsPath = requires {
  requires Shape::fibreMovesAsPath;
};

/// The structure that all Hill muscles share: a fibre of constant thickness with activation, force–
/// length and force–velocity relation and damping, in series with a tendon; a Shape says which.
///
///     l = ℓ/ℓ0,  v = ℓ̇/(V ℓ0),  w = ℓ0 sin α0,  d = ℓ cos α = √(ℓ² − w²),  κ = 1/cos α
///     ε = (L − d)/ℓs − 1,   F_T = F0 f_T(ε)
///     f_T = [A f_v(v; a) + f_PE(l) + B v] cos α,   A = a f_l(l)
///     so that A f_v(v; a) + B v = P = κ f_T − f_PE
///
/// a acts as clamped to the class's least and largest activation. Domain: ℓ > w (and > 0); outside
/// every result is NaN, so that an iteration which steps there sees a failed step.
///
/// Where OpenSim holds a fibre, at shortestFibre() (ℓ̇ = 0 unless it lengthens, the force on the
/// skeleton unchanged), the law itself goes on; holding is what SimulatedMuscle and restingFibre
/// do.
template <class S>
class HillMuscle {
 public:
  using Shape = S;
  using T = typename Shape::Number;
  using Plain = decltype(plainValue(std::declval<T>()));
  using Parameters = typename Shape::Parameters;

  /// Nothing is checked here; Parameters::requireRules() does.
  explicit HillMuscle(const Parameters& p) : shape_(p) { takeNumbers(); }
  explicit HillMuscle(const Shape& shape) : shape_(shape) { takeNumbers(); }

  const Shape& shape() const { return shape_; }
  const Parameters& parameters() const { return shape_.parameters(); }
  const T& thickness() const { return thickness_; }    ///< w [m]
  const T& perFibre() const { return perFibre_; }      ///< 1/ℓ0 [1/m]
  const T& perTendon() const { return perTendon_; }    ///< 1/ℓs [1/m]
  const T& speedScale() const { return speedScale_; }  ///< V ℓ0 [m/s]

  /// Whether the fibre's length is a state: false with a rigid tendon.
  bool hasFibreState() const { return !parameters().ignoreTendonCompliance; }
  /// Below it OpenSim holds the fibre [m], if the class does so.
  const Plain& shortestFibre() const { return shortest_; }

  /// ℓ cos α [m].
  template <class U>
  Joint<T, U> projected(const U& fibreLength) const {
    using R = Joint<T, U>;
    using std::sqrt;
    return branch(
        plainValue(fibreLength) > plainValue(thickness_),
        [&] { return R(sqrt(R(fibreLength * fibreLength - thickness_ * thickness_))); },
        [] { return R(std::numeric_limits<double>::quiet_NaN()); });
  }
  /// ε
  template <class U>
  Joint<T, U> tendonStrain(const U& fibreLength, const U& pathLength) const {
    return (pathLength - projected(fibreLength)) * perTendon_ - 1.0;
  }
  /// a as it acts.
  template <class R>
  R acting(const R& activation) const {
    const auto plain = plainValue(activation);
    return branch(
        plain < plainValue(shape_.minimumActivation()),
        [&] { return R(shape_.minimumActivation()); },
        [&] {
          return branch(
              plain > shape_.maximumActivation(), [&] { return R(shape_.maximumActivation()); },
              [&] { return activation; });
        });
  }
  /// Whether a acts as itself.
  template <class A>
  auto isActing(const A& activation) const {
    return activation >= plainValue(shape_.minimumActivation()) &&
           activation <= shape_.maximumActivation();
  }

  /// V(a, ℓ, L) and F_T. The kernel of a simulation: no allocation.
  template <class U>
  FibreRate<Joint<T, U>> fibreRate(const U& activation, const U& fibreLength,
                                   const U& pathLength) const {
    using R = Joint<T, U>;
    const R d = projected(fibreLength);
    const R perD = 1.0 / d;
    const R kappa = fibreLength * perD;
    const R kappa_l = -(thickness_ * thickness_) * perD * perD * perD;
    const CurvePoint<R> tendon = shape_.tendonForce(R((pathLength - d) * perTendon_ - 1.0));
    const R l = fibreLength * perFibre_;
    const CurvePoint<R> active = shape_.activeForce(l);
    const CurvePoint<R> passive = shape_.passiveForce(l);

    // P = κ f_T − f_PE and A = a f_l
    const R a = acting(R(activation));
    const R P = tendon.value * kappa - passive.value;
    const R A = a * active.value;
    const R stiffness = tendon.slope * perTendon_;
    const R P_l = -(stiffness * kappa * kappa) + tendon.value * kappa_l - passive.slope * perFibre_;
    const R A_l = a * active.slope * perFibre_;
    const FibreSpeed<R> s = shape_.speed(P, A, a);

    FibreRate<R> rate;
    rate.fibreVelocity = speedScale_ * s.v;
    rate.tendonForce = force_ * tendon.value;
    rate.dV_dActivation = branch(
        isActing(plainValue(activation)),
        [&] { return R(speedScale_ * (s.byActive * active.value + s.byActivation)); },
        [] { return R(0.0); });
    rate.dV_dFibreLength = speedScale_ * (s.byForce * P_l + s.byActive * A_l);
    rate.dV_dPathLength = speedScale_ * s.byForce * stiffness * kappa;
    rate.dF_dPathLength = force_ * stiffness;
    rate.dF_dFibreLength = -(rate.dF_dPathLength * kappa);
    return rate;
  }

  /// The balance of forces at a fibre velocity [m/s].
  template <class U>
  FibreBalance<Joint<T, U>> fibreBalance(const U& activation, const U& fibreLength,
                                         const U& pathLength, const U& fibreVelocity) const {
    using R = Joint<T, U>;
    const R d = projected(fibreLength);
    const R perLength = 1.0 / fibreLength;
    const R cosine = d * perLength;
    const R perD = 1.0 / d;
    const R cosine_l = thickness_ * thickness_ * perLength * perLength * perD;
    const CurvePoint<R> tendon = shape_.tendonForce(R((pathLength - d) * perTendon_ - 1.0));
    const R l = fibreLength * perFibre_;
    const CurvePoint<R> active = shape_.activeForce(l);
    const CurvePoint<R> passive = shape_.passiveForce(l);
    const R a = acting(R(activation));
    const R v = fibreVelocity / speedScale_;
    const ForceVelocity<R> f_v = shape_.forceVelocity(v, a);

    const R A = a * active.value;
    const R force = A * f_v.value + passive.value + shape_.damping() * v;
    const R stiffness = tendon.slope * perTendon_;
    FibreBalance<R> b;
    b.residual = force * cosine - tendon.value;
    b.tendonForce = force_ * tendon.value;
    b.dR_dActivation = branch(
        isActing(plainValue(activation)),
        [&] { return R((active.value * f_v.value + A * f_v.byActivation) * cosine); },
        [] { return R(0.0); });
    const R force_l = (a * active.slope * f_v.value + passive.slope) * perFibre_;
    b.dR_dFibreLength = force_l * cosine + force * cosine_l + stiffness * fibreLength * perD;
    b.dR_dPathLength = -stiffness;
    b.dR_dFibreVelocity = (A * f_v.slope + shape_.damping()) * cosine / speedScale_;
    b.dF_dPathLength = force_ * stiffness;
    b.dF_dFibreLength = -(b.dF_dPathLength * fibreLength * perD);
    return b;
  }

  /// V near a fibre velocity v for an implicit midpoint step of h [s] that has the fibre move from
  /// ℓ − h v/2 to ℓ + h v/2, and F_T. Of a class whose step solves the balance of forces
  /// R(a, ℓ, L, v) = 0 it is the velocity to which Newton's method moves v, v − R/R_v, with
  /// derivatives −R_x/R_v: exact where R = 0. Where a fibre is held it is the velocity that takes
  /// it to shortestFibre(), with derivatives 0, if v − V is more than that equation's error: the
  /// lesser of the two errors vanishes in the end.
  template <class R>
  FibreRate<R> rateNear(const R& activation, const R& fibreLength, const R& pathLength,
                        const R& fibreVelocity, const R& h) const {
    if constexpr (!holdsFibre<Shape>) {
      return unheldRateNear(activation, fibreLength, pathLength, fibreVelocity);
    } else {
      // no fibre is held at its optimal length or beyond
      const R end = fibreLength + h / 2 * fibreVelocity;
      const R shorter = choose(end < fibreLength, end, fibreLength);
      const R shortest = choose(shorter * perFibre_ >= 1, R(0.0), R(shortest_));
      // an iterate may be shorter than what is allowed, and even than the muscle's thickness
      const R least = shortest * (1 - 1e-9);
      const R length = choose(fibreLength < least, least, fibreLength);
      FibreRate<R> near = unheldRateNear(activation, length, pathLength, fibreVelocity);
      const auto tooShort = length > fibreLength;
      near.dV_dFibreLength = choose(tooShort, R(0.0), near.dV_dFibreLength);
      near.dF_dFibreLength = choose(tooShort, R(0.0), near.dF_dFibreLength);
      const R toShortest = (shortest - fibreLength) / h + fibreVelocity / 2;
      const auto held = shortest > 0 && near.fibreVelocity <= toShortest;
      near.fibreVelocity = choose(held, toShortest, near.fibreVelocity);
      near.dV_dActivation = choose(held, R(0.0), near.dV_dActivation);
      near.dV_dFibreLength = choose(held, R(0.0), near.dV_dFibreLength);
      near.dV_dPathLength = choose(held, R(0.0), near.dV_dPathLength);
      return near;
    }
  }

  /// The force with a rigid tendon,
  ///     F = F0 [a f_l f_v + f_PE + B v] cos α,  v = L̇ cos α/(V ℓ0), L̇/(V ℓ0) of a class whose
  ///     fibreMovesAsPath,
  /// cut at 0 from below where the class does so. 0 for L ≤ ℓs, with ℓ = w.
  template <class U>
  RigidRate<Joint<T, U>> rigidRate(const U& activation, const U& pathLength,
                                   const U& pathSpeed) const {
    using R = Joint<T, U>;
    const R along = pathLength - parameters().tendonSlackLength;
    return branch(
        plainValue(along) <= 0,
        [&] { return RigidRate<R>{R(0.0), R(thickness_), R(0.0), R(0.0), R(0.0), R(0.0)}; },
        [&] { return tautRate<R>(R(activation), along, R(pathSpeed)); });
  }

 private:
  void takeNumbers() {
    using std::sin;
    const Parameters& p = parameters();
    force_ = p.maxIsometricForce;
    perFibre_ = 1.0 / p.optimalFibreLength;
    perTendon_ = 1.0 / p.tendonSlackLength;
    speedScale_ = p.maxContractionVelocity * p.optimalFibreLength;
    thickness_ = p.optimalFibreLength * sin(p.pennation);
    shortest_ = shape_.shortestFibre(thickness_);
  }

  /// V(a, ℓ, L) by the class's own equation near a velocity v: see rateNear.
  template <class R>
  FibreRate<R> unheldRateNear(const R& activation, const R& fibreLength, const R& pathLength,
                              const R& fibreVelocity) const {
    if constexpr (Shape::stepsByBalance) {
      const FibreBalance<R> b = fibreBalance(activation, fibreLength, pathLength, fibreVelocity);
      const R per = -1.0 / b.dR_dFibreVelocity;
      return {fibreVelocity + b.residual * per,
              b.tendonForce,
              b.dR_dActivation * per,
              b.dR_dFibreLength * per,
              b.dR_dPathLength * per,
              b.dF_dFibreLength,
              b.dF_dPathLength};
    } else {
      return fibreRate(activation, fibreLength, pathLength);
    }
  }

  /// rigidRate for L > ℓs.
  template <class R>
  RigidRate<R> tautRate(const R& activation, const R& along, const R& pathSpeed) const {
    using std::sqrt;
    RigidRate<R> r{R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0)};
    r.fibreLength = sqrt(R(along * along + thickness_ * thickness_));
    const R perLength = 1.0 / r.fibreLength;
    const R cosine = along * perLength;
    const R cosine_L = thickness_ * thickness_ * perLength * perLength * perLength;
    // ℓ̇ = L̇ s with the share s that follows the path
    const R share = fibreMovesAsPath<Shape> ? R(1.0) : cosine;
    const R share_L = fibreMovesAsPath<Shape> ? R(0.0) : cosine_L;
    r.fibreVelocity = pathSpeed * share;
    const R v = r.fibreVelocity / speedScale_;
    const R l = r.fibreLength * perFibre_;
    const CurvePoint<R> active = shape_.activeForce(l);
    const CurvePoint<R> passive = shape_.passiveForce(l);
    const R a = acting(activation);
    const ForceVelocity<R> f_v = shape_.forceVelocity(v, a);

    const R A = a * active.value;
    const R force = A * f_v.value + passive.value + shape_.damping() * v;
    return branch(
        Shape::rigidForceIsCut && plainValue(force) < 0, [&] { return r; },
        [&] {
          const R force_v = A * f_v.slope + shape_.damping();
          const R force_L = (a * active.slope * f_v.value + passive.slope) * perFibre_ * cosine +
                            force_v * pathSpeed * share_L / speedScale_;
          r.tendonForce = force_ * force * cosine;
          r.dF_dPathLength = force_ * (force_L * cosine + force * cosine_L);
          r.dF_dPathSpeed = force_ * force_v * share * cosine / speedScale_;
          r.dF_dActivation = branch(
              isActing(plainValue(activation)),
              [&] {
                return R(force_ * (active.value * f_v.value + A * f_v.byActivation) * cosine);
              },
              [] { return R(0.0); });
          return r;
        });
  }

  Shape shape_;
  T force_, perFibre_, perTendon_, speedScale_, thickness_;
  Plain shortest_;
};

}  // namespace bio::muscles
