#pragma once

#include <array>
#include <concepts>
#include <cstddef>

#include "bio/muscle/muscle_property.h"
#include "bio/muscle/number_type.h"

namespace bio::muscles {

/// The multiplier f_v(v; a) of the active force, v = ℓ̇/(V ℓ0), with its slopes.
template <class T>
struct ForceVelocity {
  T value;
  T slope;         ///< ∂f_v/∂v
  T byActivation;  ///< ∂f_v/∂a at fixed v; 0 but for Thelen's
};

/// The speed v at which A·f_v(v; a) + B·v = P, with its slopes in P, A and a.
template <class T>
struct FibreSpeed {
  T v;
  T byForce;       ///< ∂v/∂P
  T byActive;      ///< ∂v/∂A
  T byActivation;  ///< ∂v/∂a at fixed P and A; 0 but for Thelen's
};

/// A muscle class, as what it adds to the structure that all Hill muscles share (HillMuscle):
/// four curves and the way from force to speed. Everything is a pure function of its arguments.
///
///     Parameters   the class's numbers in OpenSim's terms: T members, `count` of them in the order
///                  of `properties`, the five of HillParameters first, at(parameters, i), own rules
///                  in requireRules(), activation() the law of its activation; numOwn = count − 5
///                  are the shape's own
///     tendonForce(ε), activeForce(l), passiveForce(l)      CurvePoint, in units of F0
///     forceVelocity(v, a), speed(P, A, a)                  inverse of each other
///     …InOwn(…)    the same functions' derivatives in the class's own numbers (double only)
///     damping()    B of the fibre force's term B·v, and whether it follows its own number;
///     dampingPlace, minimumActivationPlace   places of the two numbers, `count` if there is none
///     minimumActivation(), maximumActivation()   activation acts as clamped to them
///     stepsByBalance     an implicit step solves the balance of forces, not ℓ̇ = V(a, ℓ, L)
///     shortestFibre(w)   length below which OpenSim holds the fibre [m], w = ℓ0 sin α0
///
/// Curves take any argument of the shape's number type, plain ones also dual numbers.
template <class S>
concept HillShape = requires(const S& s, const typename S::Number& x, double d) {
  typename S::Parameters;
  requires S::numOwn + common::count == S::Parameters::count;
  { S::className } -> std::convertible_to<const char*>;
  { s.tendonForce(x) } -> std::same_as<CurvePoint<typename S::Number>>;
  { s.activeForce(x) } -> std::same_as<CurvePoint<typename S::Number>>;
  { s.passiveForce(x) } -> std::same_as<CurvePoint<typename S::Number>>;
  { s.forceVelocity(x, x) } -> std::same_as<ForceVelocity<typename S::Number>>;
  { s.speed(x, x, x) } -> std::same_as<FibreSpeed<typename S::Number>>;
  { s.tendonForceInOwn(d) } -> std::same_as<std::array<double, S::numOwn>>;
  { s.activeForceInOwn(d) } -> std::same_as<std::array<double, S::numOwn>>;
  { s.passiveForceInOwn(d) } -> std::same_as<std::array<double, S::numOwn>>;
  { s.forceVelocityInOwn(d, d) } -> std::same_as<std::array<double, S::numOwn>>;
  { s.speedInOwn(d, d, d) } -> std::same_as<std::array<double, S::numOwn>>;
  { s.damping() } -> std::convertible_to<typename S::Number>;
  { s.dampingActs() } -> std::same_as<bool>;
  { S::dampingPlace } -> std::convertible_to<std::size_t>;
  { S::minimumActivationPlace } -> std::convertible_to<std::size_t>;
  { s.minimumActivation() } -> std::convertible_to<typename S::Number>;
  { s.maximumActivation() } -> std::convertible_to<double>;
  { s.shortestFibre(x) } -> std::convertible_to<double>;
  { S::rigidForceIsCut } -> std::convertible_to<bool>;
  { S::stepsByBalance } -> std::convertible_to<bool>;
};

/// Whether fibres of the class are held at shortestFibre(): of those with a largest pennation.
template <class Shape>
inline constexpr bool holdsFibre =
    placeOf<typename Shape::Parameters>("maximum_pennation_angle") < Shape::Parameters::count;

}  // namespace bio::muscles
