#include "bio/path/surface/opensim_ellipsoid.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace bio {
namespace {

using V3 = Eigen::Vector3d;

constexpr double fanOnly = 0.7073, axisOnly = 0.9, fadeAtEnds = 0.3;
constexpr int fanSamples = 300;
constexpr double nearPlane = 2e-13;  // a number that OpenSim takes for 0

/// The point of an ellipse nearest to u, v: a root of Σ (a_i u_i/(t + a_i²))² = 1 by Newton's
/// method on its polynomial, as far as OpenSim goes.
Eigen::Vector2d nearestOnEllipse(const Eigen::Array2d& a, const Eigen::Array2d& u) {
  const Eigen::Array2d a2 = a * a;
  const auto isNear = [&](int i) { return std::abs(u[i]) <= nearPlane; };
  if (isNear(0) && isNear(1)) {
    const int i = a[0] < a[1] ? 0 : 1;
    Eigen::Vector2d x = u;
    x[i] = u[i] < 0 ? -a[i] : a[i];
    return x;
  }
  for (const int i : {0, 1}) {  // on an axis of the ellipse
    const int other = 1 - i;
    if (!isNear(i)) continue;
    Eigen::Vector2d x = u;
    if (a[i] >= a[other] || std::abs(u[other]) >= a[other] - a2[i] / a[other]) {
      x[other] = u[other] >= 0 ? a[other] : -a[other];
    } else {
      x[other] = a2[other] * u[other] / (a2[other] - a2[i]);
      const double part = x[other] / a[other];
      x[i] = a[i] * std::sqrt(std::abs(1 - part * part));
    }
    return x;
  }
  const bool isInside = (u / a).square().sum() < 1;
  double t = isInside ? 0 : a.maxCoeff() * std::sqrt(u.square().sum());
  Eigen::Array2d P = t + a2;
  for (int n = 0; n < 64; ++n) {
    P = t + a2;
    const Eigen::Array2d w = a2 * u * u, P2 = P * P;
    const double f = P2[0] * P2[1] - w[0] * P2[1] - w[1] * P2[0];
    if (std::abs(f) < 1e-9) break;
    t -= f / (2 * (P[0] * P[1] * (P[0] + P[1]) - w[0] * P[1] - w[1] * P[0]));
  }
  return a2 * u / P;
}

/// In the section with axis `across` left as it is.
V3 nearestInSection(const V3& a, const V3& u, int across) {
  const int i = (across + 1) % 3, j = (across + 2) % 3;
  const Eigen::Vector2d x = nearestOnEllipse({a[i], a[j]}, {u[i], u[j]});
  V3 nearest = u;
  nearest[i] = x[0];
  nearest[j] = x[1];
  return nearest;
}

V3 nearestOnEllipsoid(const V3& a, const V3& u) {
  int across = -1;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(u[i]) > nearPlane) continue;
    // of several sections the narrowest
    if (across < 0 || a[i] > a[across]) across = i;
  }
  if (across >= 0) return nearestInSection(a, u, across);
  const Eigen::Array3d a2 = a.array().square(), w = a2 * u.array().square();
  const bool isInside = (u.array() / a.array()).square().sum() < 1;
  double t = isInside ? 0 : a.maxCoeff() * u.norm();
  Eigen::Array3d P = t + a2;
  for (int n = 0; n < 64; ++n) {
    P = t + a2;
    const Eigen::Array3d P2 = P * P;
    const double f = P2.prod() - w[0] * P2[1] * P2[2] - w[1] * P2[0] * P2[2] - w[2] * P2[0] * P2[1];
    if (std::abs(f) < 1e-9) break;
    const double PQ = P[0] * P[1], PR = P[0] * P[2], QR = P[1] * P[2];
    t -= f / (2 * (P.prod() * (QR + PR + PQ) - w[0] * QR * (P[1] + P[2]) -
                   w[1] * PR * (P[0] + P[2]) - w[2] * PQ * (P[0] + P[1])));
  }
  return a2 * u.array() / P;
}

/// What decides the plane: c, and how much of it is the fan's.
struct PlanePoint {
  V3 c;
  double fanWeight;
};

PlanePoint planePoint(const V3& a, const V3& along, const V3& r1, const V3& r1r2) {
  V3 mu = along.normalized().cwiseAbs();
  int axis = 0;
  for (const int i : {1, 2}) {
    if (mu[i] > mu[axis]) axis = i;
  }
  const double t = -r1[axis] / r1r2[axis];
  double largest = mu[axis];
  if (largest > fanOnly) {
    const double inside = std::clamp(std::min(t, 1 - t) / fadeAtEnds, 0.0, 1.0);
    largest = fanOnly + inside * (largest - fanOnly);
  }
  const double ofAxis = (largest - fanOnly) / (axisOnly - fanOnly);
  V3 c = V3::Zero();
  if (largest > fanOnly) c = nearestInSection(a, r1 + t * r1r2, axis);
  if (largest >= axisOnly) return {c, std::min(1 - ofAxis, 1.0)};
  V3 sum = V3::Zero();
  for (int i = 1; i < fanSamples - 1; ++i) {
    const V3 at = r1 + (static_cast<double>(i) / fanSamples) * r1r2;
    sum += (nearestOnEllipsoid(a, at) - at).normalized();
  }
  const V3 fan = nearestOnEllipsoid(a, r1 + 0.5 * r1r2 + sum.normalized());
  if (largest <= fanOnly) return {fan, 1};
  return {nearestOnEllipsoid(a, ofAxis * c + (1 - ofAxis) * fan), 1 - ofAxis};
}

/// Brings c to the quadrant's side.
void reflect(const V3& a, WrapQuadrant quadrant, PlanePoint& point) {
  const V3 side = directionOf(quadrant);
  if (side.isZero() || point.c.dot(side) >= 0) return;
  int axis = 0;
  side.cwiseAbs().maxCoeff(&axis);
  point.c[axis] = -point.c[axis];
  const double weight = std::min(point.fanWeight, 1.0);
  if (!(weight > 0)) return;
  point.c[axis] -= weight * point.c[axis];  // towards the middle of the two, 0
  point.c = nearestOnEllipsoid(a, point.c);
}

/// A plane section, in lengths divided by the semi-axes: a circle.
struct Section {
  V3 centre, e1, e2;  // e1 towards P's tangent point
  double radius = 0, angle = 0;
  V3 at(double phi) const { return centre + radius * (std::cos(phi) * e1 + std::sin(phi) * e2); }
  V3 slope(double phi) const { return radius * (-std::sin(phi) * e1 + std::cos(phi) * e2); }
};

/// @param P, Q, c  divided by the semi-axes
std::optional<Section> sectionOf(const V3& P, const V3& Q, const V3& c) {
  const V3 normal = (Q - P).cross(c - P);
  if (!(normal.norm() > 1e-12 * (Q - P).norm())) return {};
  const V3 n = normal.normalized();
  Section s;
  s.centre = n * n.dot(P);
  s.radius = std::sqrt(std::max(0.0, 1 - s.centre.squaredNorm()));
  // of the two tangent points of an end, the one on c's side of the chord
  const V3 towards = n.cross(Q - P).normalized();
  const auto tangentPoint = [&](const V3& X, double turn) -> V3 {
    const V3 d = X - s.centre;
    const double cosine = std::min(1.0, s.radius / d.norm());
    const double sine = std::sqrt(1 - cosine * cosine);
    const V3 x = d.normalized();
    return s.radius * (cosine * x + turn * sine * n.cross(x));
  };
  const double side = towards.dot(c - P) > 0 ? 1 : -1;
  // going from P to Q on that side turns about −side·n
  const V3 A = tangentPoint(P, -side), B = tangentPoint(Q, side);
  s.e1 = A.normalized();
  s.e2 = -side * n.cross(s.e1);
  const double angle = std::atan2(B.dot(s.e2), B.dot(s.e1));
  s.angle = angle < 0 ? angle + 2 * std::numbers::pi : angle;
  return s;
}

double exactArc(const V3& a, const Section& s) {
  constexpr int pieces = 64;  // Simpson's rule, error below 1e-9 of the arc
  double sum = 0;
  for (int i = 0; i <= pieces; ++i) {
    const double weight = i == 0 || i == pieces ? 1 : i % 2 == 1 ? 4 : 2;
    sum += weight * a.cwiseProduct(s.slope(s.angle * i / pieces)).norm();
  }
  return sum * s.angle / (3 * pieces);
}

/// Chords at equal angles about a point of the plane, which is not the section's centre: where an
/// axis of the ellipsoid meets the plane, the axis nearest to the normal.
double chordsOf(const V3& a, const Section& s) {
  const V3 A = a.cwiseProduct(s.at(0)), B = a.cwiseProduct(s.at(s.angle));
  const double apart = (B - A).norm();
  const int count = std::min(499, static_cast<int>(apart / 1e-3));
  if (count < 1) return apart;
  const V3 normal = a.cwiseProduct(s.e1).cross(a.cwiseProduct(s.e2)).normalized();
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  const V3 middle = V3::Unit(axis) * (normal.dot(A) / normal[axis]);
  const V3 x = (A - middle).normalized();
  const V3 toB = (B - middle).normalized();
  const V3 y = (toB - x * x.dot(toB)).normalized();
  const double whole = std::acos(std::clamp(x.dot(toB), -1.0, 1.0));
  double sum = 0;
  V3 from = A;
  for (int i = 1; i <= count; ++i) {
    const double phi = whole * i / count;
    V3 to = B;
    if (i < count) {
      const V3 r = std::cos(phi) * x + std::sin(phi) * y;
      const V3 f = r.cwiseQuotient(a), g = middle.cwiseQuotient(a);
      const double half = f.dot(g);
      const double reach = -half + std::sqrt(half * half - f.squaredNorm() * (g.squaredNorm() - 1));
      to = middle + reach / f.squaredNorm() * r;
    }
    sum += (to - from).norm();
    from = to;
  }
  return sum;
}

}  // namespace

OpenSimSpan openSimEllipsoid(const Vec3<double>& semiAxes, WrapQuadrant quadrant,
                             const Vec3<double>& p_CP, const Vec3<double>& p_CQ,
                             ArcLength measure) {
  const OpenSimSpan straight{false, (p_CQ - p_CP).norm()};
  const double scale = 3 / semiAxes.sum();
  const V3 a = scale * semiAxes, P = scale * p_CP, Q = scale * p_CQ;
  const V3 inP = P.cwiseQuotient(a), inQ = Q.cwiseQuotient(a);
  if (inP.squaredNorm() - 1 < -1e-4 || inQ.squaredNorm() - 1 < -1e-4) return straight;
  if (std::abs(P.normalized().dot(Q.normalized()) - 1) < 1e-4) return straight;
  // Q + l·(Q → P direction reversed): P − Q scaled by l cuts the ellipsoid
  const V3 along = P - Q, f = along.cwiseQuotient(a);
  const double half = f.dot(inQ), square = f.squaredNorm();
  const double under = half * half - square * (inQ.squaredNorm() - 1);
  if (under < 0) return straight;
  const double l1 = (-half + std::sqrt(under)) / square, l2 = (-half - std::sqrt(under)) / square;
  if (!(l1 > 0 && l1 < 1 && l2 > 0 && l2 < 1)) return straight;
  const V3 r1 = Q + l1 * along, r1r2 = (l2 - l1) * along;
  PlanePoint point = planePoint(a, along, r1, r1r2);
  reflect(a, quadrant, point);
  const std::optional<Section> section = sectionOf(inP, inQ, point.c.cwiseQuotient(a));
  if (!section) return straight;
  const V3 A = semiAxes.cwiseProduct(section->at(0));
  const V3 B = semiAxes.cwiseProduct(section->at(section->angle));
  const double arc =
      measure == ArcLength::exact ? exactArc(semiAxes, *section) : chordsOf(semiAxes, *section);
  return {true, (A - p_CP).norm() + arc + (p_CQ - B).norm()};
}

}  // namespace bio
