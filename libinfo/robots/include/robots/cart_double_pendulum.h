#pragma once

#include <cmath>

#include "info/dynamics/lagrangian.h"

namespace info {

/// The identified parameters of the cart with the double pendulum.
enum class DoublePendulumUnknowns {
  mass1AndDamping,  ///< θ = (m1 [kg], c [g m²/s])
  bothMasses,       ///< θ = (m1 [kg], m2 [kg]); c is the member `damping`
};

/// A cart with a double pendulum made of two plates on bearings: the robot of chapters 4 and 5 of
/// Wilson's thesis.
///
///     L = ½ Σ m_i |v_i|² + ½ I1 φ̇1² + ½ I2 (φ̇1 + φ̇2)² + g (m1 s1 + m2 d) cos φ1 + g m2 s2
///     cos(φ1+φ2) f = (−c φ̇1, −c φ̇2),   I_i = m_i (L_i² + w_i²)/12 about the centre of mass
/// q = (φ1, φ2) [rad], φ1 from hanging down, φ2 relative to link 1; ρ = x [m] the cart. Centres of
/// mass at x + s1 sin φ1 and x + d sin φ1 + s2 sin(φ1+φ2) with d = L1 − 2·offset the distance of
/// the pivots, s_i from the pivot. Outputs: the absolute angles φ1, φ1 + φ2 [rad].
///
/// As a continuous system x = (x, φ1, φ2, ẋ, φ̇1, φ̇2) and u = ẍ [m/s²]; as a Lagrangian system the
/// cart position is kinematic. Smooth everywhere for positive masses.
///
/// Source: Wilson, Information-based Trajectory Optimization, Table 4.1. The damping is a
/// rotational coefficient; its printed unit lacks m².
template <DoublePendulumUnknowns Unknowns = DoublePendulumUnknowns::mass1AndDamping>
struct CartDoublePendulum {
  static constexpr int stateSize = 6, inputSize = 1, parameterSize = 2, outputSize = 2;
  static constexpr int coordinateSize = 2, kinematicSize = 1, forceInputSize = 0,
                       measurementSize = 2;

  double length1 = 0.305;     ///< L1 [m] > 0
  double length2 = 0.305;     ///< L2 [m] > 0
  double width1 = 0.0445;     ///< w1 [m]
  double width2 = 0.0381;     ///< w2 [m]
  double offset = 0.0127;     ///< bearing from either end of link 1 [m]
  double com1 = 0.146;        ///< s1 [m]
  double com2 = 0.125;        ///< s2 [m]
  double mass2 = 0.0847;      ///< m2 [kg] > 0 if it is known
  double damping = 0.0;       ///< c [kg m²/s] if it is not identified
  double dampingUnit = 1e-3;  ///< unit of c in θ [kg m²/s]; 10e-3 in chapter 5 of the source
  double gravity = 9.81;      ///< g [m/s²]

  std::vector<std::string> parameterNames() const {
    if constexpr (Unknowns == DoublePendulumUnknowns::bothMasses)
      return {"m1", "m2"};
    else
      return {"m1", "c"};
  }

  /// The parameters θ in SI units.
  template <class T>
  struct Physical {
    T m1, m2, c;
  };
  template <class T>
  Physical<T> physical(const Vector<T, 2>& theta) const {
    if constexpr (Unknowns == DoublePendulumUnknowns::bothMasses)
      return {theta[0], theta[1], T(damping)};
    else
      return {theta[0], T(mass2), theta[1] * dampingUnit};
  }

  template <class T>
  T lagrangian(const Vector<T, 2>& q, const Vector<T, 2>& qDot, const Vector<T, 1>&,
               const Vector<T, 1>& rhoDot, const Vector<T, 2>& theta) const {
    using std::cos, std::sin;
    const Physical<T> p = physical(theta);
    const T angle2 = q[0] + q[1], rate2 = qDot[0] + qDot[1];
    const T c1 = cos(q[0]), s1 = sin(q[0]), c2 = cos(angle2), s2 = sin(angle2);
    // velocities of the two centres of mass
    const T x1 = rhoDot[0] + com1 * c1 * qDot[0], z1 = com1 * s1 * qDot[0];
    const T x2 = rhoDot[0] + pivots() * c1 * qDot[0] + com2 * c2 * rate2;
    const T z2 = pivots() * s1 * qDot[0] + com2 * s2 * rate2;
    const T kinetic1 = x1 * x1 + z1 * z1 + gyration1() * qDot[0] * qDot[0];
    const T kinetic2 = x2 * x2 + z2 * z2 + gyration2() * rate2 * rate2;
    const T height1 = com1 * c1, height2 = pivots() * c1 + com2 * c2;
    const T one = p.m1 * (0.5 * kinetic1 + gravity * height1);
    const T two = p.m2 * (0.5 * kinetic2 + gravity * height2);
    return one + two;
  }
  template <class T>
  Vector<T, 2> force(const Vector<T, 2>&, const Vector<T, 2>& qDot, const Vector<T, 1>&,
                     const Vector<T, 1>&, const Vector<T, 0>&, const Vector<T, 2>& theta) const {
    const T c = physical(theta).c;
    Vector<T, 2> torque;
    torque << -c * qDot[0], -c * qDot[1];
    return torque;
  }
  template <class T>
  Vector<T, 2> measure(const Vector<T, 2>& q, const Vector<T, 1>&, const Vector<T, 2>&) const {
    Vector<T, 2> y;
    y << q[0], q[0] + q[1];
    return y;
  }

  /// The equations of motion: mass matrix, Coriolis, gravity, cart, damping.
  template <class T>
  Vector<T, 6> f(const Vector<T, 6>& x, const Vector<T, 1>& u, const Vector<T, 2>& theta) const {
    using std::cos, std::sin;
    const Physical<T> p = physical(theta);
    const double d = pivots();
    const T angle2 = x[1] + x[2], rate2 = x[4] + x[5];
    const T c1 = cos(x[1]), s1 = sin(x[1]), c2 = cos(angle2), s2 = sin(angle2);
    // in the absolute angles (α, β) = (φ1, φ1 + φ2): A α̈ + C β̈ = a, C α̈ + B β̈ = b
    const T cosine = cos(x[2]), sine = sin(x[2]);
    const T A = p.m1 * (com1 * com1 + gyration1()) + p.m2 * (d * d);
    const T B = p.m2 * (com2 * com2 + gyration2());
    const T C = p.m2 * (d * com2) * cosine;
    const T coupling = p.m2 * (d * com2) * sine;
    const T first = p.m1 * com1 + p.m2 * d, second = p.m2 * com2;
    const T damping2 = p.c * x[5];
    const T a =
        coupling * rate2 * rate2 - first * (gravity * s1 + u[0] * c1) - p.c * x[4] + damping2;
    const T b = -coupling * x[4] * x[4] - second * (gravity * s2 + u[0] * c2) - damping2;
    const T determinant = A * B - C * C;
    const T alpha = (B * a - C * b) / determinant, beta = (A * b - C * a) / determinant;
    Vector<T, 6> xDot;
    xDot << x[3], x[4], x[5], u[0], alpha, beta - alpha;
    return xDot;
  }
  template <class T>
  Vector<T, 2> g(const Vector<T, 6>& x, const Vector<T, 1>&, const Vector<T, 2>&) const {
    Vector<T, 2> y;
    y << x[1], x[1] + x[2];
    return y;
  }

 private:
  double pivots() const { return length1 - 2.0 * offset; }
  double gyration1() const { return (length1 * length1 + width1 * width1) / 12.0; }
  double gyration2() const { return (length2 * length2 + width2 * width2) / 12.0; }
};

}  // namespace info
