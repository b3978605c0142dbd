#include "bio/path/surface/way.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "bio/path/surface/chain.h"

namespace bio {
namespace {

using Eigen::Vector3d;

Vector3d anyAcross(const Vector3d& d) {
  int least = 0;
  d.cwiseAbs().minCoeff(&least);
  return d.cross(Vector3d::Unit(least)).normalized();
}

// Where the tangent plane with normal w touches.
Vector3d farthest(const EllipsoidSurface& s, const Vector3d& w, const Vector3d&) {
  const Vector3d square = s.semiAxes().cwiseProduct(s.semiAxes());
  return square.cwiseProduct(w) / std::sqrt(square.dot(w.cwiseProduct(w)));
}
Vector3d farthest(const SphereSurface& s, const Vector3d& w, const Vector3d&) {
  return s.radius() * w.normalized();
}
Vector3d farthest(const CylinderSurface& s, const Vector3d& w, const Vector3d& near) {
  const double across = std::hypot(w[0], w[1]);
  if (!(across > 0)) return {s.radius(), 0, near[2]};
  return {s.radius() * w[0] / across, s.radius() * w[1] / across, near[2]};
}

// The last point of the line m + λ w on a surface whose g is quadratic, if it meets it.
template <class S>
Vector3d leaving(const S& surface, const Vector3d& m, const Vector3d& w) {
  const double bend = w.dot(surface.hessianTimes(m, w));
  const double slope = w.dot(surface.gradient(m));
  const double root = slope * slope - 2 * bend * surface.value(m);
  if (!(bend > 0) || !(root > 0)) return farthest(surface, w, m);
  return m + w * ((-slope + std::sqrt(root)) / bend);
}
Vector3d leaving(const TorusSurface& surface, const Vector3d& m, const Vector3d&) {
  const double rho = std::hypot(m[0], m[1]);
  const double inner = surface.ringRadius() - surface.tubeRadius();
  if (!(rho > 0)) return {inner, 0, 0};
  return {inner * m[0] / rho, inner * m[1] / rho, 0};
}

Vector3d leavingAny(const Surface& surface, const Vector3d& m, const Vector3d& w) {
  return std::visit([&](const auto& s) { return leaving(s, m, w); }, surface);
}

}  // namespace

Vector3d hintTowards(const Surface& surface, const Vector3d& side, const Vector3d& P,
                     const Vector3d& Q) {
  if (!(side.norm() > 0)) {
    throw std::invalid_argument(fmt::format(
        "the side on which a path passes a surface is ({}, {}, {}), must be a direction", side[0],
        side[1], side[2]));
  }
  const Vector3d d = (Q - P).normalized();
  Vector3d across = side.normalized() - d * d.dot(side.normalized());
  if (across.norm() < 1e-6) across = anyAcross(d);
  return leavingAny(surface, lowestOnSegment(surface, P, Q).point, across.normalized());
}

Vector3d hintOfShortest(const Surface& surface, const Vector3d& P, const Vector3d& Q) {
  const Vector3d d = (Q - P).normalized();
  const Vector3d m = lowestOnSegment(surface, P, Q).point;
  Vector3d out = std::visit([&](const auto& s) { return s.gradient(m); }, surface);
  out -= d * d.dot(out);
  if (!(out.norm() >
        1e-9 * std::visit([&](const auto& s) { return s.gradient(P).norm(); }, surface))) {
    out = anyAcross(d);
  }
  out.normalize();
  const Vector3d aside = d.cross(out);
  Vector3d best = leavingAny(surface, m, out);
  double least = std::numeric_limits<double>::infinity();
  for (const Vector3d& w : {out, Vector3d(-out), aside, Vector3d(-aside)}) {
    ChainObject object{surface};
    object.hint = leavingAny(surface, m, w);
    ChainMemory memory;
    const ChainPath path = solveChain(P, Q, {&object, 1}, memory);
    if (path.event == ChainEvent::notFound || !path.isShortest) continue;
    if (path.length < least * (1 - 1e-12)) {
      least = path.length;
      best = object.hint;
    }
  }
  return best;
}

}  // namespace bio
