#pragma once

#include <Eigen/Dense>

#include "bio/skeleton/rigid_motion.h"

namespace bio {

/// Six numbers of a rigid body, all about the origin of one frame (here: the ground's).
///
/// A velocity or screw is (ω, s): a point at x moves with ω × x + s, so that s [m/s] belongs to the
/// point of the body that is just at the origin. A momentum or force is (n, f): moment about the
/// origin and force. Power is the plain product ω·n + s·f.
/// Source: Featherstone, Rigid Body Dynamics Algorithms (2008), chapter 2, with (ω, s) in his
/// order.
/// Plain numbers that are copied one by one: as packets, just after each was stored by itself, a
/// processor has to wait for them, which made the evaluation of a small tree slower by a tenth.
template <class T>
class SpatialVector {
 public:
  SpatialVector() = default;
  SpatialVector(const T& a, const T& b, const T& c, const T& d, const T& e, const T& f)
      : numbers_{a, b, c, d, e, f} {}
  SpatialVector(const SpatialVector& other) { *this = other; }
  SpatialVector& operator=(const SpatialVector& other) {
    const T a = other[0], b = other[1], c = other[2], d = other[3], e = other[4], f = other[5];
    numbers_[0] = a;
    numbers_[1] = b;
    numbers_[2] = c;
    numbers_[3] = d;
    numbers_[4] = e;
    numbers_[5] = f;
    return *this;
  }

  static SpatialVector Zero() {
    const T zero(0.0);
    return {zero, zero, zero, zero, zero, zero};
  }
  T& operator[](int i) { return numbers_[i]; }
  const T& operator[](int i) const { return numbers_[i]; }
  T* data() { return numbers_; }
  const T* data() const { return numbers_; }
  SpatialVector& operator+=(const SpatialVector& other) {
    for (int i = 0; i < 6; ++i) numbers_[i] += other.numbers_[i];
    return *this;
  }
  friend SpatialVector operator+(SpatialVector a, const SpatialVector& b) { return a += b; }

 private:
  T numbers_[6];
};

namespace detail {

/// out = a × b
template <class T>
inline void crossInto(const T* a, const T* b, T* out) {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

/// out += a × b
template <class T>
inline void addCross(const T* a, const T* b, T* out) {
  out[0] += a[1] * b[2] - a[2] * b[1];
  out[1] += a[2] * b[0] - a[0] * b[2];
  out[2] += a[0] * b[1] - a[1] * b[0];
}

}  // namespace detail

/// a × b of two velocities: how b changes when it is carried along by a.
/// (ω_a × ω_b, ω_a × s_b + s_a × ω_b)
template <class T>
inline SpatialVector<T> crossMotion(const SpatialVector<T>& a, const SpatialVector<T>& b) {
  return {a[1] * b[2] - a[2] * b[1],  //
          a[2] * b[0] - a[0] * b[2],  //
          a[0] * b[1] - a[1] * b[0],
          a[1] * b[5] - a[2] * b[4] + (a[4] * b[2] - a[5] * b[1]),
          a[2] * b[3] - a[0] * b[5] + (a[5] * b[0] - a[3] * b[2]),
          a[0] * b[4] - a[1] * b[3] + (a[3] * b[1] - a[4] * b[0])};
}

/// a ×* f: how a force or momentum f changes when it is carried along by the velocity a.
/// (ω × n + s × f, ω × f); for every velocity b, (a × b)·f = −b·(a ×* f).
template <class T>
inline SpatialVector<T> crossForce(const SpatialVector<T>& a, const SpatialVector<T>& f) {
  SpatialVector<T> c;
  detail::crossInto(a.data(), f.data(), c.data());
  detail::addCross(a.data() + 3, f.data() + 3, c.data());
  detail::crossInto(a.data(), f.data() + 3, c.data() + 3);
  return c;
}

/// Plain product of six numbers: a power, or twice an energy.
template <class T>
inline T dot(const SpatialVector<T>& a, const SpatialVector<T>& b) {
  return (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) + (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]);
}

/// ω × x + s: velocity of the point at x, or change of its place per unit of a screw's amount.
template <class T>
inline Eigen::Matrix<T, 3, 1> velocityAt(const SpatialVector<T>& screw,
                                         const Eigen::Matrix<T, 3, 1>& x) {
  Eigen::Matrix<T, 3, 1> u;
  detail::crossInto(screw.data(), x.data(), u.data());
  for (int i = 0; i < 3; ++i) u[i] += screw[i + 3];
  return u;
}

/// Inertia of any number of masses about the origin: Σ m, Σ m r and J = Σ m (r·r 1 − r rᵀ).
template <class T>
struct SpatialInertia {
  T mass{0.0};                                                         ///< [kg]
  Eigen::Matrix<T, 3, 1> massMoment = Eigen::Matrix<T, 3, 1>::Zero();  ///< [kg m]
  SpatialVector<T> J = SpatialVector<T>::Zero();  ///< xx yy zz xy xz yz [kg m²]

  SpatialInertia& operator+=(const SpatialInertia& other) {
    mass += other.mass;
    massMoment += other.massMoment;
    J += other.J;
    return *this;
  }
};

/// Momentum (J ω + Σmr × s, Σm s + ω × Σmr) of the masses moving with velocity v.
template <class T>
inline SpatialVector<T> operator*(const SpatialInertia<T>& I, const SpatialVector<T>& v) {
  const T* w = v.data();
  const T* s = w + 3;
  const T* J = I.J.data();
  SpatialVector<T> h;
  h[0] = J[0] * w[0] + J[3] * w[1] + J[4] * w[2];
  h[1] = J[3] * w[0] + J[1] * w[1] + J[5] * w[2];
  h[2] = J[4] * w[0] + J[5] * w[1] + J[2] * w[2];
  detail::addCross(I.massMoment.data(), s, h.data());
  for (int i = 0; i < 3; ++i) h[i + 3] = I.mass * s[i];
  detail::addCross(w, I.massMoment.data(), h.data() + 3);
  return h;
}

/// Inertia of one rigid body about the origin: central inertia C (xx yy zz xy xz yz, in the body's
/// frame) turned by X and shifted to the mass centre, which is at `center` in the body's frame.
template <class T>
SpatialInertia<T> inertiaInGround(const Placement<T>& X, double mass, const Eigen::Vector3d& center,
                                  const Eigen::Matrix<double, 6, 1>& C) {
  const auto& R = X.R;
  SpatialInertia<T> I;
  I.mass = T(mass);
  if (mass != 0) {
    for (int i = 0; i < 3; ++i) {
      I.massMoment[i] =
          mass * (R(i, 0) * center[0] + R(i, 1) * center[1] + R(i, 2) * center[2] + X.p[i]);
    }
  }
  // RC, then the six entries of RCRᵀ
  T A[3][3];
  for (int i = 0; i < 3; ++i) {
    A[i][0] = R(i, 0) * C[0] + R(i, 1) * C[3] + R(i, 2) * C[4];
    A[i][1] = R(i, 0) * C[3] + R(i, 1) * C[1] + R(i, 2) * C[5];
    A[i][2] = R(i, 0) * C[4] + R(i, 1) * C[5] + R(i, 2) * C[2];
  }
  constexpr int row[6] = {0, 1, 2, 0, 0, 1};
  constexpr int column[6] = {0, 1, 2, 1, 2, 2};
  for (int e = 0; e < 6; ++e) {
    const int i = row[e], j = column[e];
    I.J[e] = A[i][0] * R(j, 0) + A[i][1] * R(j, 1) + A[i][2] * R(j, 2);
  }
  // m (c·c 1 − c cᵀ) with Σ m r = m c
  if (mass != 0) {
    const double perMass = 1 / mass;
    const auto& m = I.massMoment;
    const T xx = m[0] * m[0] * perMass, yy = m[1] * m[1] * perMass, zz = m[2] * m[2] * perMass;
    I.J[0] += yy + zz;
    I.J[1] += xx + zz;
    I.J[2] += xx + yy;
    I.J[3] -= m[0] * m[1] * perMass;
    I.J[4] -= m[0] * m[2] * perMass;
    I.J[5] -= m[1] * m[2] * perMass;
  }
  return I;
}

}  // namespace bio
