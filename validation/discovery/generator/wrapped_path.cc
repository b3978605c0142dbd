#include "generator/wrapped_path.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace hidden {

Vec turned(const Vec& v, const Vec& axis, double angle) {
  return v * std::cos(angle) + axis.cross(v) * std::sin(angle) +
         axis * axis.dot(v) * (1 - std::cos(angle));
}

SpanLength straight(const Vec& P, const Vec& Q) {
  const Vec d = Q - P;
  return {d.norm(), d.normalized(), false};
}

int sideOf(const Cylinder& c, const Vec& P, const Vec& Q) {
  const auto across = [&](const Vec& p) -> Vec {
    const Vec d = p - c.centre;
    return (d - c.z * c.z.dot(d)).normalized();
  };
  const Vec u = across(P), w = across(Q);
  const int shorter = c.z.dot(u.cross(w)) >= 0 ? 1 : -1;
  if (!c.onPlusX) return shorter;
  return c.x.dot(u + w) >= 0 ? shorter : -shorter;
}

SpanLength around(const Cylinder& c, int side, const Vec& P, const Vec& Q) {
  const Vec p = P - c.centre, q = Q - c.centre;
  const double pz = c.z.dot(p), qz = c.z.dot(q);
  const double pr = std::hypot(c.x.dot(p), c.y.dot(p));
  const double qr = std::hypot(c.x.dot(q), c.y.dot(q));
  const double r = c.radius;
  if (!(pr > r && qr > r)) return straight(P, Q);

  // the angle from P to Q on this side, less what the two tangents take
  const double from = std::atan2(c.y.dot(p), c.x.dot(p));
  const double to = std::atan2(c.y.dot(q), c.x.dot(q));
  constexpr double turn = 2 * std::numbers::pi;
  double phi = side * (to - from);
  phi -= turn * std::floor(phi / turn);
  // nothing is wound round that far: it has slipped off
  if (phi > 0.75 * turn) return straight(P, Q);
  const double arc = phi - std::acos(r / pr) - std::acos(r / qr);
  if (!(arc > 0)) return straight(P, Q);

  const double before = std::sqrt(pr * pr - r * r);
  const double after = std::sqrt(qr * qr - r * r);
  const double flat = before + r * arc + after;
  const double climb = (qz - pz) / flat;
  const double firstHeight = pz + climb * before;
  const double lastHeight = qz - climb * after;
  if (std::abs(firstHeight) > c.halfLength && std::abs(lastHeight) > c.halfLength) {
    return straight(P, Q);
  }
  const double leave = to - side * std::acos(r / qr);
  const Vec contact =
      c.centre + r * (std::cos(leave) * c.x + std::sin(leave) * c.y) + lastHeight * c.z;
  return {std::hypot(flat, qz - pz), (Q - contact).normalized(), true};
}

}  // namespace hidden
