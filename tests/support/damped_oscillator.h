#pragma once

#include <cmath>

#include "info/dynamics/system.h"

namespace info {

/// A driven linear oscillator with closed-form motion and sensitivities.
///
///     m q̈ + c q̇ + k q = u,   x = (q, q̇),   θ = (c, k),   y = q
/// q [m], u force [N], c [N s/m], k [N/m]; smooth everywhere.
struct DampedOscillator {
  static constexpr int stateSize = 2, inputSize = 1, parameterSize = 2, outputSize = 1;
  double mass = 1.0;  ///< m [kg] > 0

  std::vector<std::string> parameterNames() const { return {"damping", "stiffness"}; }
  template <class T>
  Vector<T, 2> f(const Vector<T, 2>& x, const Vector<T, 1>& u, const Vector<T, 2>& theta) const {
    Vector<T, 2> xDot;
    xDot << x[1], (u[0] - theta[0] * x[1] - theta[1] * x[0]) / mass;
    return xDot;
  }
  template <class T>
  Vector<T, 1> g(const Vector<T, 2>& x, const Vector<T, 1>&, const Vector<T, 2>&) const {
    return x.template head<1>();
  }

  /// q(t) without input from (q0, v0), underdamped:
  ///     q = e^(−γt) (q0 cos ωt + (v0 + γ q0)/ω sin ωt),   γ = c/2m,   ω = √(k/m − γ²)
  /// @throws std::domain_error unless c² < 4 k m
  template <class T>
  T freeMotion(const T& q0, const T& v0, const Vector<T, 2>& theta, double time) const {
    using std::cos, std::exp, std::sin, std::sqrt;
    const T gamma = theta[0] / (2.0 * mass);
    const T square = theta[1] / mass - gamma * gamma;
    if (!(plainValue(square) > 0.0))
      throw std::domain_error("damping: must satisfy c^2 < 4 k m, c = " +
                              std::to_string(plainValue(theta[0])) + " N s/m");
    const T omega = sqrt(square);
    const T rest = (v0 + gamma * q0) / omega;
    const T phase = omega * time, decay = -gamma * time;
    const T wave = q0 * cos(phase) + rest * sin(phase);
    return exp(decay) * wave;
  }
};

}  // namespace info
