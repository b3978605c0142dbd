#pragma once

#include <cmath>

#include "info/dynamics/system.h"

namespace info {

/// A mathematical pendulum on a fixed pivot, hanging down at φ = 0.
///
///     m ℓ² φ̈ + c φ̇ + m g ℓ sin φ = τ,   x = (φ, φ̇),   u = τ,   θ = (ℓ, c),   y = φ
/// φ [rad], τ [N m], ℓ [m] > 0, c [N m s]; smooth for ℓ > 0.
struct Pendulum {
  static constexpr int stateSize = 2, inputSize = 1, parameterSize = 2, outputSize = 1;
  double mass = 1.0;      ///< m [kg] > 0
  double gravity = 9.81;  ///< g [m/s²]

  std::vector<std::string> parameterNames() const { return {"length", "damping"}; }
  template <class T>
  Vector<T, 2> f(const Vector<T, 2>& x, const Vector<T, 1>& u, const Vector<T, 2>& theta) const {
    using std::sin;
    const T length = theta[0];
    const T inertia = mass * length * length;
    const T sine = sin(x[0]);
    const T moment = u[0] - theta[1] * x[1] - mass * gravity * length * sine;
    Vector<T, 2> xDot;
    xDot << x[1], moment / inertia;
    return xDot;
  }
  template <class T>
  Vector<T, 1> g(const Vector<T, 2>& x, const Vector<T, 1>&, const Vector<T, 2>&) const {
    return x.template head<1>();
  }

  /// ½ m ℓ² φ̇² − m g ℓ cos φ [J]
  template <class T>
  T energy(const Vector<T, 2>& x, const Vector<T, 2>& theta) const {
    using std::cos;
    const T cosine = cos(x[0]);
    const T speed = theta[0] * x[1];
    return 0.5 * mass * speed * speed - mass * gravity * theta[0] * cosine;
  }
};

}  // namespace info
