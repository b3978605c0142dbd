#pragma once

// The ends of a path's spans in motion; for path_length.h.
#include "bio/path/path.h"
#include "bio/skeleton/skeleton_motion.h"

namespace bio::detail {

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

/// An end of a span; where it is fixed only its value is set.
template <class T, int N>
struct SpanEnd {
  PointMotionJet<T, N> jet;
  bool fixed = false;
};

template <class T, int N>
SpanEnd<T, N> spanEnd(const CompiledPath& path, const PathNode& node, const Vec3<T>& p_S,
                      const Eigen::Matrix<T, N, 1>& q, const RigidMotion<T, N>* moved) {
  SpanEnd<T, N> end;
  end.fixed = node.segment == 0 && node.motion < 0;
  if (end.fixed) {
    end.jet.value = p_S;
  } else {
    end.jet = nodeJet<T, N>(path, node, p_S, q, moved);
  }
  return end;
}

/// An end seen from the fixed frame X.
template <class T, int N>
SpanEnd<T, N> intoFrame(const Placement<double>& X, const SpanEnd<T, N>& x) {
  const Mat3<T> R = X.R.transpose().template cast<T>();
  SpanEnd<T, N> y;
  y.fixed = x.fixed;
  const Vec3<T> d = x.jet.value - X.p.template cast<T>();
  y.jet.value.noalias() = R.lazyProduct(d);
  if (x.fixed) return y;
  for (std::size_t i = 0; i < N; ++i) y.jet.first[i].noalias() = R.lazyProduct(x.jet.first[i]);
  for (std::size_t ij = 0; ij < numPairs(N); ++ij) {
    y.jet.second[ij].noalias() = R.lazyProduct(x.jet.second[ij]);
  }
  return y;
}

/// An end seen from a surface; where the surface moves, no end is fixed.
template <class T, int N>
SpanEnd<T, N> seenFromSurface(const PathSurface& surface, const RigidMotion<T, N>* moved,
                              const SpanEnd<T, N>& end) {
  if (surface.segment == 0) return intoFrame(surface.X_SC, end);
  SpanEnd<T, N> x = end;
  if (end.fixed) {
    for (auto& d : x.jet.first) d.setZero();
    for (auto& d : x.jet.second) d.setZero();
  }
  x.fixed = false;
  x.jet = seenFrom(moved[surface.segment], x.jet);
  return intoFrame(surface.X_SC, x);
}

}  // namespace bio::detail
