#pragma once

#include <Eigen/Dense>
#include <concepts>
#include <stdexcept>
#include <string>
#include <vector>

#include "info/autodiff/dual.h"

namespace info {

/// A size known only at run time (a model read from a file); every other size is a number ≥ 0.
inline constexpr int dynamic = Eigen::Dynamic;

/// Thrown if the length of a vector does not match the system; with fixed sizes this is a
/// compile-time error.
struct DimensionError : std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// The sizes of x, u, θ and y.
struct Dimensions {
  int state;      ///< n, length of x
  int input;      ///< m, length of u
  int parameter;  ///< p, length of θ
  int output;     ///< l, length of y
};

/// The four sizes as compile-time constants; `dynamic` (−1) for a size that is known at run time
/// only.
template <class S>
concept Sized = requires {
  { S::stateSize } -> std::convertible_to<int>;
  { S::inputSize } -> std::convertible_to<int>;
  { S::parameterSize } -> std::convertible_to<int>;
  { S::outputSize } -> std::convertible_to<int>;
};

template <class S, class T = double>
using StateOf = Vector<T, S::stateSize>;
template <class S, class T = double>
using InputOf = Vector<T, S::inputSize>;
template <class S, class T = double>
using ParametersOf = Vector<T, S::parameterSize>;
template <class S, class T = double>
using OutputOf = Vector<T, S::outputSize>;

/// The output y = g(x, u, θ) and the names of θ, in order; names appear in messages and reports.
template <class S>
concept Observed = Sized<S> &&
    requires(const S& s, const StateOf<S>& x, const InputOf<S>& u, const ParametersOf<S>& theta) {
  { s.g(x, u, theta) } -> std::convertible_to<OutputOf<S>>;
  { s.parameterNames() } -> std::convertible_to<std::vector<std::string>>;
};

/// A continuous system ẋ = f(x, u, θ), y = g(x, u, θ) evaluated in double.
///
/// A user's system is one small struct:
///
///     struct Decay {  // ẋ = −θ x + u, y = x
///       static constexpr int stateSize = 1, inputSize = 1, parameterSize = 1, outputSize = 1;
///       std::vector<std::string> parameterNames() const { return {"rate"}; }
///       template <class T>
///       Vector<T, 1> f(const Vector<T, 1>& x, const Vector<T, 1>& u, const Vector<T, 1>& theta)
///       const {
///         Vector<T, 1> xDot;
///         xDot << -theta[0] * x[0] + u[0];
///         return xDot;
///       }
///       template <class T>
///       Vector<T, 1> g(const Vector<T, 1>& x, const Vector<T, 1>&, const Vector<T, 1>&) const {
///         return x;
///       }
///     };
///
/// Contract: f and g are pure, i.e. equal arguments give equal results, from any thread, in any
/// order. Time does not appear (make it a state or an input). The length of θ is the number of
/// names, in the same order. With a `dynamic` size the struct also has `Dimensions dimensions()
/// const`, and its vectors are Vector<T, dynamic> there. Constants of the model that are not to be
/// identified are members of the struct; parameters to be identified are in θ. SI units and
/// radians.
template <class S>
concept System = Observed<S> &&
    requires(const S& s, const StateOf<S>& x, const InputOf<S>& u, const ParametersOf<S>& theta) {
  { s.f(x, u, theta) } -> std::convertible_to<StateOf<S>>;
};

/// A System whose f and g are templates over one scalar T shared by x, u and θ.
///
/// T is double, Dual<C> or Dual<C> of Dual<C> (dual.h). The same code path must serve all of them:
/// no conversion to double, `using std::sin;` before an unqualified `sin(x)`, constants written as
/// plain numbers, intermediate results stored as T, never as `auto`. f and g are differentiable
/// once for ψ, twice for Ω and Newton's method.
template <class S>
concept SmoothSystem = System<S> &&
    requires(const S& s, const StateOf<S, Dual<1>>& x, const InputOf<S, Dual<1>>& u,
             const ParametersOf<S, Dual<1>>& theta) {
  requires std::same_as<typename std::remove_cvref_t<decltype(s.f(x, u, theta))>::Scalar, Dual<1>>;
  requires std::same_as<typename std::remove_cvref_t<decltype(s.g(x, u, theta))>::Scalar, Dual<1>>;
};

/// A discrete system x_{k+1} = Φ(x_k, u_k, u_{k+1}, θ), y_k = g(x_k, u_k, θ), in one of three
/// kinds.
///
/// Explicit: one member
///     template <class T> Vector<T, n> step(x, u0, u1, theta) const;
/// Implicit: x_{k+1} solves r(x_{k+1}; x_k, u_k, u_{k+1}, θ) = 0,
///     template <class T> Vector<T, n> residual(x1, x, u0, u1, theta) const;
/// with ∂r/∂x_{k+1} regular at the solution. Differentiated: its own `solve`, `linearise` and
/// `contractedHessian` with the signatures of step_map.h, for maps with faster algorithms.
///
/// Contract: pure, like a System; the time step is a member. The free functions of step_map.h
/// (solve, linearise, contractedHessian, advance) work for every kind.
template <class M>
concept ExplicitStepMap = Observed<M> &&
    requires(const M& map, const StateOf<M>& x, const InputOf<M>& u, const ParametersOf<M>& theta) {
  { map.step(x, u, u, theta) } -> std::convertible_to<StateOf<M>>;
};
template <class M>
concept ImplicitStepMap = Observed<M> &&
    requires(const M& map, const StateOf<M>& x, const InputOf<M>& u, const ParametersOf<M>& theta) {
  { map.residual(x, x, u, u, theta) } -> std::convertible_to<StateOf<M>>;
};
template <class M>
concept DifferentiatedStepMap = Observed<M> &&
    requires(const M& map, const StateOf<M>& x, const InputOf<M>& u, const ParametersOf<M>& theta) {
  { map.solve(x, u, u, theta).x1 } -> std::convertible_to<StateOf<M>>;
  { map.linearise(x, u, u, theta).solution.x1 } -> std::convertible_to<StateOf<M>>;
};
template <class M>
concept StepMap = ExplicitStepMap<M> || ImplicitStepMap<M> || DifferentiatedStepMap<M>;

/// The sizes of a system or step map, from its constants where fixed, from `dimensions()`
/// otherwise.
/// @throws DimensionError if a fixed size and dimensions() disagree or a size is negative
template <Sized S>
Dimensions dimensionsOf(const S& s) {
  Dimensions d{S::stateSize, S::inputSize, S::parameterSize, S::outputSize};
  if constexpr (requires { s.dimensions(); }) {
    const Dimensions given = s.dimensions();
    const auto refitBase = [](int& fixed, int run, const char* name) {
      if (run < 0 || (fixed != dynamic && fixed != run))
        throw DimensionError(std::string("dimensions(): ") + name + " size is " +
                             std::to_string(run) + ", must be " +
                             (fixed == dynamic ? ">= 0" : "equal to " + std::to_string(fixed)));
      fixed = run;
    };
    refitBase(d.state, given.state, "state");
    refitBase(d.input, given.input, "input");
    refitBase(d.parameter, given.parameter, "parameter");
    refitBase(d.output, given.output, "output");
  } else {
    static_assert(
        S::stateSize >= 0 && S::inputSize >= 0 && S::parameterSize >= 0 && S::outputSize >= 0,
        "a system with a dynamic size needs `Dimensions dimensions() const`");
  }
  return d;
}

/// @throws DimensionError naming the quantity unless `length` is `expected`
inline void requireLength(const char* quantity, Eigen::Index length, Eigen::Index expected) {
  if (length != expected)
    throw DimensionError(std::string(quantity) + ": length is " + std::to_string(length) +
                         ", must be " + std::to_string(expected));
}

/// @throws DimensionError naming x, u or θ if its length is not that of the system
template <Sized S>
void requireSizes(const S& s, const StateOf<S>& x, const InputOf<S>& u,
                  const ParametersOf<S>& theta) {
  if constexpr (S::stateSize == dynamic || S::inputSize == dynamic || S::parameterSize == dynamic) {
    const Dimensions d = dimensionsOf(s);
    requireLength("state x", x.size(), d.state);
    requireLength("input u", u.size(), d.input);
    requireLength("parameters theta", theta.size(), d.parameter);
  }
}

}  // namespace info
