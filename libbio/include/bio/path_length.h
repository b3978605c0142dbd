#pragma once

// Template bodies of path.h.
#include "bio/path.h"
#include "bio/skeleton_motion.h"

namespace bio {
namespace detail {

/// A path point in ground with its derivatives.
template <class T, int N>
PointMotionJet<T, N> nodeJet(const CompiledPath& path, const PathNode& node, const Vec3<T>& p_S,
                             const Eigen::Matrix<T, N, 1>& q, const RigidMotion<T, N>* moved) {
  if (node.motion < 0) return movePoint(moved[node.segment], p_S);

  // location in the body: three functions of coordinates
  const CompiledPointMotion& motion = path.motions[static_cast<std::size_t>(node.motion)];
  PointMotionJet<T, N> local;
  for (auto& d : local.first) d.setZero();
  for (auto& d : local.second) d.setZero();
  for (std::size_t i = 0; i < 3; ++i) {
    const Skeleton::CoordinateSource& source = motion.source[i];
    const auto row = static_cast<Eigen::Index>(i);
    if (source.freeIndex < 0) {
      local.value[row] = T(motion.location[i].evaluate(source.value).value);
      continue;
    }
    const auto k = static_cast<std::size_t>(source.freeIndex);
    const auto inner = curveJet(source.coupling, q[source.freeIndex]);
    const auto outer = curveJet(motion.location[i], inner.value);
    local.value[row] = outer.value;
    local.first[k][row] = outer.slope * inner.slope;
    local.second[static_cast<std::size_t>(pairIndex(source.freeIndex, source.freeIndex))][row] =
        outer.curvature * inner.slope * inner.slope + outer.slope * inner.curvature;
  }
  // into the segment
  const Mat3<T> R_SB = node.X_SB.R.template cast<T>();
  const auto turn = [&](Vec3<T>& v) { v = (R_SB * v).eval(); };
  turn(local.value);
  local.value += node.X_SB.p.template cast<T>();
  for (auto& d : local.first) turn(d);
  for (auto& d : local.second) turn(d);
  // into the ground, by the product rule
  const RigidMotion<T, N>& X = moved[node.segment];
  PointMotionJet<T, N> jet = movePoint(X, local.value);
  for (int i = 0; i < N; ++i) {
    const auto si = static_cast<std::size_t>(i);
    jet.first[si] += X.value.R * local.first[si];
    for (int j = 0; j <= i; ++j) {
      const auto sj = static_cast<std::size_t>(j);
      const auto ij = static_cast<std::size_t>(pairIndex(i, j));
      jet.second[ij] += X.first[si].R * local.first[sj] + X.first[sj].R * local.first[si] +
                        X.value.R * local.second[ij];
    }
  }
  return jet;
}

/// A moving point seen from a moving frame: y = Rᵀ(x − p).
template <class T, int N>
PointMotionJet<T, N> seenFrom(const RigidMotion<T, N>& X, const PointMotionJet<T, N>& x) {
  const Vec3<T> d = x.value - X.value.p;
  std::array<Vec3<T>, N> d1;
  for (std::size_t i = 0; i < N; ++i) d1[i] = x.first[i] - X.first[i].p;
  PointMotionJet<T, N> y;
  y.value.noalias() = X.value.R.transpose() * d;
  for (int i = 0; i < N; ++i) {
    const auto si = static_cast<std::size_t>(i);
    y.first[si] = X.first[si].R.transpose() * d + X.value.R.transpose() * d1[si];
    for (int j = 0; j <= i; ++j) {
      const auto sj = static_cast<std::size_t>(j);
      const auto ij = static_cast<std::size_t>(pairIndex(i, j));
      y.second[ij] = X.second[ij].R.transpose() * d + X.first[si].R.transpose() * d1[sj] +
                     X.first[sj].R.transpose() * d1[si] +
                     X.value.R.transpose() * (x.second[ij] - X.second[ij].p);
    }
  }
  return y;
}

/// Adds a span between two moving points: the chain rule to second order.
template <class T, int N>
void addSpan(LengthJet<N, T>& jet, const SpanToSecondOrder<T>& s, const PointMotionJet<T, N>& P,
             const PointMotionJet<T, N>& Q) {
  jet.length += s.span.length;
  for (int i = 0; i < N; ++i) {
    const auto si = static_cast<std::size_t>(i);
    jet.dL_dq[i] += s.span.dL_dP.dot(P.first[si]) + s.span.dL_dQ.dot(Q.first[si]);
    // change of the gradient as q_i moves both ends
    const Vec3<T> gP = s.hessian.d2L_dPdP * P.first[si] + s.hessian.d2L_dPdQ * Q.first[si];
    const Vec3<T> gQ =
        s.hessian.d2L_dPdQ.transpose() * P.first[si] + s.hessian.d2L_dQdQ * Q.first[si];
    for (int j = 0; j <= i; ++j) {
      const auto sj = static_cast<std::size_t>(j);
      const auto ij = static_cast<std::size_t>(pairIndex(i, j));
      const T second = gP.dot(P.first[sj]) + gQ.dot(Q.first[sj]) + s.span.dL_dP.dot(P.second[ij]) +
                       s.span.dL_dQ.dot(Q.second[ij]);
      jet.d2L_dq2(i, j) += second;
      if (i != j) jet.d2L_dq2(j, i) += second;
    }
  }
}

/// Turns a moving point into the fixed frame X.
template <class T, int N>
PointMotionJet<T, N> intoFrame(const Placement<double>& X, const PointMotionJet<T, N>& x) {
  const Mat3<T> R = X.R.transpose().template cast<T>();
  PointMotionJet<T, N> y;
  const Vec3<T> d = x.value - X.p.template cast<T>();
  y.value.noalias() = R * d;
  for (std::size_t i = 0; i < N; ++i) y.first[i].noalias() = R * x.first[i];
  for (std::size_t ij = 0; ij < numPairs(N); ++ij) y.second[ij].noalias() = R * x.second[ij];
  return y;
}

/// Adds the span over the first surface that it touches and that is not in use, else straight.
template <class T, int N>
void addPathSpan(LengthJet<N, T>& jet, const CompiledPath& path, const PathSpan& span,
                 const PointMotionJet<T, N>& P, const PointMotionJet<T, N>& Q,
                 const RigidMotion<T, N>* moved, const T* radii, unsigned& used) {
  for (const SpanSurface& way : span.surfaces) {
    const unsigned bit = 1u << way.surface;
    if ((used & bit) != 0) continue;
    const PathSurface& surface = path.surfaces[way.surface];
    const T radius = radii ? radii[surface.wrap] : T(surface.radius);
    const bool inGround = surface.segment == 0;
    const PointMotionJet<T, N> p_CP =
        intoFrame(surface.X_SC, inGround ? P : seenFrom(moved[surface.segment], P));
    const PointMotionJet<T, N> p_CQ =
        intoFrame(surface.X_SC, inGround ? Q : seenFrom(moved[surface.segment], Q));
    if (surfaceIsOutOfPlay(surface, radius, way.side, p_CP.value, p_CQ.value)) continue;
    const SpanToSecondOrder<T> s =
        surface.isSphere ? wrapSphereToSecondOrder(radius, way.way, p_CP.value, p_CQ.value)
                         : wrapCylinderToSecondOrder(radius, way.side, p_CP.value, p_CQ.value);
    if (!s.span.touches) continue;
    used |= bit;
    jet.wrapped = jet.wrapped || span.moves;
    addSpan(jet, s, p_CP, p_CQ);
    return;
  }
  addSpan(jet, straightSpanToSecondOrder(P.value, Q.value), P, Q);
}

template <int N, class T>
LengthJet<N, T> noLength() {
  LengthJet<N, T> jet;
  jet.dL_dq.setZero();
  jet.d2L_dq2.setZero();
  return jet;
}

}  // namespace detail

template <int N>
LengthJet<N> MusclePath::length(const Eigen::Matrix<double, N, 1>& q,
                                const RigidMotion<double, N>* moved) const {
  const PathVariant& variant = activeVariant(compiled_, q);
  LengthJet<N> jet = detail::noLength<N, double>();
  jet.length = variant.fixedLength;
  unsigned used = 0;
  for (const PathSpan& span : variant.moving) {
    const PathNode& a = compiled_.nodes[span.a];
    const PathNode& b = compiled_.nodes[span.b];
    const auto P = detail::nodeJet<double, N>(compiled_, a, a.p_S, q, moved);
    const auto Q = detail::nodeJet<double, N>(compiled_, b, b.p_S, q, moved);
    detail::addPathSpan<double, N>(jet, compiled_, span, P, Q, moved, nullptr, used);
  }
  return jet;
}

template <class T, int N>
LengthJet<N, T> MusclePath::length(const PathParameters<T>& parameters,
                                   const Eigen::Matrix<T, N, 1>& q,
                                   const RigidMotion<T, N>* moved) const {
  const PathVariant& variant = activeVariant(compiled_, q);
  LengthJet<N, T> jet = detail::noLength<N, T>();
  const auto jetOf = [&](const PathNode& node) {
    const Mat3<T> R = node.X_SB.R.template cast<T>();
    const Vec3<T> p_S = R * parameters.points[node.point] + node.X_SB.p.template cast<T>();
    return detail::nodeJet<T, N>(compiled_, node, p_S, q, moved);
  };
  unsigned used = 0;
  for (const PathSpan& span : variant.all) {
    detail::addPathSpan<T, N>(jet, compiled_, span, jetOf(compiled_.nodes[span.a]),
                              jetOf(compiled_.nodes[span.b]), moved, parameters.radii.data(), used);
  }
  return jet;
}

template <int N>
std::vector<Eigen::Vector3d> MusclePath::pathPoints(const Eigen::Matrix<double, N, 1>& q,
                                                    const RigidMotion<double, N>* moved,
                                                    double step) const {
  std::size_t segments = 1;
  for (const PathNode& node : compiled_.nodes) segments = std::max(segments, node.segment + 1);
  for (const PathSurface& surface : compiled_.surfaces) {
    segments = std::max(segments, surface.segment + 1);
  }
  std::vector<Placement<double>> placements(segments);
  for (std::size_t s = 0; s < segments; ++s) placements[s] = moved[s].value;
  return polyline(std::vector<double>(q.data(), q.data() + q.size()), placements, step);
}

}  // namespace bio
