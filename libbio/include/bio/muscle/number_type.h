#pragma once

#include <type_traits>

#include "info/autodiff/dual.h"

namespace bio::muscles {

using info::plainValue;

/// What arithmetic between a law's own numbers (T) and its arguments (U) gives: laws whose numbers
/// are plain take arguments of any type; laws in dual numbers take arguments in plain numbers or in
/// the same type.
template <class T, class U>
using Joint = std::conditional_t<std::is_same_v<T, double>, U, T>;

/// How many derivatives, one inside the other, a number type carries: 0 for double, 1 for Dual<C>,
/// 2 for Dual<C, Dual<D>>. An unknown that Newton's method found in plain numbers follows what it
/// depends on after as many more of its steps in the number type.
template <class T>
inline constexpr int derivativeOrder = 0;
template <int C, class T>
inline constexpr int derivativeOrder<info::Dual<C, T>> = 1 + derivativeOrder<T>;

/// A function's value with its first two derivatives in its argument.
template <class T>
struct CurvePoint {
  T value;
  T slope;
  T curvature;
};

}  // namespace bio::muscles
