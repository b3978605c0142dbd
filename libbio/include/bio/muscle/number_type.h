#pragma once

#include <type_traits>

#include "info/autodiff/dual.h"

namespace bio::muscles {

using info::plainValue;

/// Number type of arithmetic between a law's numbers (T) and its arguments (U): laws whose numbers
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

// The branches of laws, written so that one text serves numbers of one state and numbers that hold
// several states side by side (simulation/simd), whose conditions hold for some of them. Those have
// functions of the same names, which join what the branches give.

/// yes() where the condition holds, no() elsewhere; each is evaluated only if it is needed.
template <class Yes, class No>
[[gnu::always_inline]] inline auto branch(bool condition, const Yes& yes, const No& no) {
  return condition ? yes() : no();
}
/// One of two values that are there anyway.
template <class T>
[[gnu::always_inline]] inline T choose(bool condition, const T& yes, const T& no) {
  return condition ? yes : no;
}
/// Whether the condition holds for all states.
inline bool everywhere(bool condition) {
  return condition;
}

/// A function's value with its first two derivatives in its argument.
template <class T>
struct CurvePoint {
  T value;
  T slope;
  T curvature;
};

}  // namespace bio::muscles
