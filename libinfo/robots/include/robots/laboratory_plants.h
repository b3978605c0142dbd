#pragma once

#include <cmath>

#include "info/dynamics/system.h"

/// Plants with more effects than the models that are fitted to them: motion out of the plane and
/// dry friction, smoothed below `slowRate`.
namespace info {

/// Moment −τ·ω/√(ω² + ε²) of dry friction, per unit of τ.
template <class T>
T dryFrictionShare(const T& rate, double slowRate) {
  using std::sqrt;
  return -rate / sqrt(rate * rate + slowRate * slowRate);
}

/// The cart with the double pendulum whose plane rotates by η about the cart's direction of travel,
/// as if by a third hinge. State (α, β, η, α̇, β̇, η̇), angles of the links absolute in their
/// plane.
///
///     L = ½ Σ m_i (ẋ_i² + ḣ_i² + h_i² η̇²) + ½ I_i (α̇_i² + η̇² cos²α_i) + g cos η Σ m_i h_i
/// with (x_i, h_i) the centres of mass in the plane, h downwards, I_i = m_i(L_i² + w_i²)/12 as of
/// thin rods. Moments −c φ̇ − τ φ̇/√(φ̇² + ε²) in both joints, none about the third hinge. Output: the
/// angles seen from the side, atan(tan α / cos η). θ = (m1 [kg], c [g m²/s]), u = ẍ [m/s²].
/// Defined while Σ m_i h_i² + I_i cos²α_i > 0. Dimensions as cart_double_pendulum.h.
struct TiltingDoublePendulum {
  static constexpr int stateSize = 6, inputSize = 1, parameterSize = 2, outputSize = 2;
  double dryFriction = 0;  ///< τ [N m] ≥ 0
  double slowRate = 0.02;  ///< ε [rad/s] > 0
  double gravity = 9.81;   ///< g [m/s²]
  double com1 = 0.146, com2 = 0.125, pivots = 0.305 - 2 * 0.0127, mass2 = 0.0847;
  double gyration1 = (0.305 * 0.305 + 0.0445 * 0.0445) / 12;
  double gyration2 = (0.305 * 0.305 + 0.0381 * 0.0381) / 12;

  std::vector<std::string> parameterNames() const { return {"m1", "c"}; }

  template <class T>
  Vector<T, 6> f(const Vector<T, 6>& x, const Vector<T, 1>& u, const Vector<T, 2>& theta) const {
    using std::cos, std::sin;
    const T m1 = theta[0], c = theta[1] * 1e-3;
    const double m2 = mass2;
    const T cosA = cos(x[0]), sinA = sin(x[0]), cosB = cos(x[1]), sinB = sin(x[1]);
    const T cosEta = cos(x[2]), sinEta = sin(x[2]);
    const T rateA = x[3], rateB = x[4], rateEta = x[5], rate2 = rateB - rateA;
    const T weight = gravity * cosEta;
    // depths, the inertia about the direction of travel and its slopes
    const T h1 = com1 * cosA, h2 = pivots * cosA + com2 * cosB;
    const T I1 = m1 * gyration1, I2 = T(m2 * gyration2);
    const T J = m1 * h1 * h1 + m2 * h2 * h2 + I1 * cosA * cosA + I2 * cosB * cosB;
    const T dJ_dA = -2.0 * (m1 * h1 * com1 + m2 * h2 * pivots) * sinA - 2.0 * I1 * cosA * sinA;
    const T dJ_dB = -2.0 * m2 * h2 * com2 * sinB - 2.0 * I2 * cosB * sinB;
    // in the plane: A α̈ + C cos(β−α) β̈ = a, C cos(β−α) α̈ + B β̈ = b
    const T moment1 = -c * rateA + dryFriction * dryFrictionShare(rateA, slowRate);
    const T moment2 = -c * rate2 + dryFriction * dryFrictionShare(rate2, slowRate);
    const T A = m1 * (com1 * com1 + gyration1) + m2 * pivots * pivots;
    const T B = I2 + m2 * com2 * com2;
    const T between = m2 * pivots * com2 * cos(T(x[1] - x[0]));
    const T coupling = m2 * pivots * com2 * sin(T(x[1] - x[0]));
    const T first = m1 * com1 + m2 * pivots, half = 0.5 * rateEta * rateEta;
    const T a = coupling * rateB * rateB - first * (weight * sinA + u[0] * cosA) + half * dJ_dA +
                moment1 - moment2;
    const T b = -coupling * rateA * rateA - (m2 * com2) * (weight * sinB + u[0] * cosB) +
                half * dJ_dB + moment2;
    const T determinant = A * B - between * between;
    const T turning = dJ_dA * rateA + dJ_dB * rateB;
    Vector<T, 6> xDot;
    xDot << rateA, rateB, rateEta, (B * a - between * b) / determinant,
        (A * b - between * a) / determinant,
        (-gravity * sinEta * (m1 * h1 + m2 * h2) - turning * rateEta) / J;
    return xDot;
  }
  template <class T>
  Vector<T, 2> g(const Vector<T, 6>& x, const Vector<T, 1>&, const Vector<T, 2>&) const {
    using std::atan2, std::cos, std::sin;
    const T tilt = cos(x[2]);
    Vector<T, 2> y;
    y << atan2(sin(x[0]), T(cos(x[0]) * tilt)), atan2(sin(x[1]), T(cos(x[1]) * tilt));
    return y;
  }
};

/// The cart with the mass on a string as a spherical pendulum. State (n, ṅ), n the unit vector
/// along the string, third component upwards, first along the cart's travel.
///
///     n̈ = −(a − (a·n) n)/ℓ − |ṅ|² n − τ/(mℓ²)·ṅ/√(|ṅ|² + ε²),   a = (u, 0, g)
///     y = F = m (ℓ |ṅ|² − a·n)       tension of the string [N]
/// θ = (m [kg], ℓ [m]), u = ẍ [m/s²]. In the plane this is SuspendedMass with n = (−sin φ, 0,
/// −cos φ).
struct SphericalSuspendedMass {
  static constexpr int stateSize = 6, inputSize = 1, parameterSize = 2, outputSize = 1;
  double dryFriction = 0;  ///< τ [N m] ≥ 0
  double slowRate = 0.02;  ///< ε [rad/s] > 0
  double gravity = 9.81;   ///< g [m/s²]

  std::vector<std::string> parameterNames() const { return {"mass", "length"}; }

  template <class T>
  Vector<T, 6> f(const Vector<T, 6>& x, const Vector<T, 1>& u, const Vector<T, 2>& theta) const {
    using std::sqrt;
    const Vector<T, 3> n = x.template head<3>(), rate = x.template tail<3>();
    Vector<T, 3> pull;
    pull << u[0], T(0.0), T(gravity);
    const T along = pull.dot(n), speed = rate.squaredNorm();
    const T friction =
        dryFriction / (theta[0] * theta[1] * theta[1] * sqrt(speed + slowRate * slowRate));
    Vector<T, 6> xDot;
    xDot.template head<3>() = rate;
    for (int i = 0; i < 3; ++i)
      xDot[3 + i] = -(pull[i] - along * n[i]) / theta[1] - speed * n[i] - friction * rate[i];
    return xDot;
  }
  template <class T>
  Vector<T, 1> g(const Vector<T, 6>& x, const Vector<T, 1>& u, const Vector<T, 2>& theta) const {
    const T along = u[0] * x[0] + gravity * x[2];
    const Vector<T, 3> rate = x.template tail<3>();
    Vector<T, 1> y;
    y << theta[0] * (theta[1] * rate.squaredNorm() - along);
    return y;
  }
};

}  // namespace info
