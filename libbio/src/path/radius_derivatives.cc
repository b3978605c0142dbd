#include "path/radius_derivatives.h"

#include "info/autodiff/dual.h"

namespace bio {

RadiusDerivatives inRadius(const CylinderDyads<double>& span, Side side) {
  const double up = span.span.dL_dQ.z(), around = span.span.dL_dQ.head<2>().norm();
  const double sigma = side == Side::counterclockwise ? 1 : -1;
  const double stretch = span.angle * up * span.perLength;
  return {span.angle * around, stretch * span.mP + sigma * span.bendP * span.nP,
          stretch * span.mQ + sigma * span.bendQ * span.nQ};
}

RadiusDerivatives inRadius(const PathSurface& surface, const SpanSurface& way,
                           const Eigen::Vector3d& P, const Eigen::Vector3d& Q) {
  if (!surface.isSphere) {
    return inRadius(wrapCylinderDyads(surface.radius, way.side, P, Q), way.side);
  }
  using D = info::Dual<1>;
  const D radius(surface.radius, 1, 0);
  const auto constant = [](const Eigen::Vector3d& v) {
    return Vec3<D>(D(v.x()), D(v.y()), D(v.z()));
  };
  Vec3<D> from = constant(P), to = constant(Q);
  for (int i = 0; i < 3; ++i) {
    from[i].derivatives().setZero();
    to[i].derivatives().setZero();
  }
  const Span<D> span = wrapSphere<D>(radius, way.way, from, to);
  const auto slope = [](const Vec3<D>& v) {
    return Eigen::Vector3d(v.x().derivatives()[0], v.y().derivatives()[0], v.z().derivatives()[0]);
  };
  return {span.length.derivatives()[0], slope(span.dL_dP), slope(span.dL_dQ)};
}

}  // namespace bio
