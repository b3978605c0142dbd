#pragma once

// Template bodies of path.h.
#include <stdexcept>
#include <type_traits>

#include "bio/path/span_end.h"
#include "bio/path/surface/chain_change.h"

namespace bio {
namespace detail {

/// first[i] and second[ij] times a vector, 0 for a fixed end.
template <class T, int N>
T alongFirst(const SpanEnd<T, N>& end, int i, const Vec3<T>& v) {
  if (end.fixed) return T(0.0);
  return v.dot(end.jet.first[static_cast<std::size_t>(i)]);
}
template <class T, int N>
T alongSecond(const SpanEnd<T, N>& end, int i, int j, const Vec3<T>& v) {
  if (end.fixed) return T(0.0);
  return v.dot(end.jet.second[static_cast<std::size_t>(pairIndex(i, j))]);
}

template <class T, int N>
void addSecond(LengthJet<N, T>& jet, int i, int j, const T& second) {
  jet.d2L_dq2(i, j) += second;
  if (i != j) jet.d2L_dq2(j, i) += second;
}

/// L = |Q − P|:  ∂_ijL = (∂_iD·∂_jD − ∂_iL ∂_jL)/L + t·∂_ijD,  D = Q − P, t = D/L
template <class T, int N>
void addStraight(LengthJet<N, T>& jet, const SpanEnd<T, N>& P, const SpanEnd<T, N>& Q) {
  const Span<T> span = straightSpan(P.jet.value, Q.jet.value);
  const Vec3<T>& t = span.dL_dQ;
  const T perLength = T(1.0) / span.length;
  jet.length += span.length;
  if (P.fixed && Q.fixed) return;
  std::array<Vec3<T>, N> D;
  std::array<T, N> dL;
  for (int i = 0; i < N; ++i) {
    const auto si = static_cast<std::size_t>(i);
    if (P.fixed) {
      D[si] = Q.jet.first[si];
    } else if (Q.fixed) {
      D[si] = -P.jet.first[si];
    } else {
      D[si] = Q.jet.first[si] - P.jet.first[si];
    }
    dL[si] = t.dot(D[si]);
    jet.dL_dq[i] += dL[si];
    for (int j = 0; j <= i; ++j) {
      const auto sj = static_cast<std::size_t>(j);
      const T across = D[si].dot(D[sj]) - dL[si] * dL[sj];
      const T bent = alongSecond(Q, i, j, t) - alongSecond(P, i, j, t);
      addSecond<T, N>(jet, i, j, T(across * perLength + bent));
    }
  }
}

/// A wrapped cylinder, whose Hessian is three dyads.
template <class T, int N>
void addCylinder(LengthJet<N, T>& jet, const CylinderDyads<T>& s, const SpanEnd<T, N>& P,
                 const SpanEnd<T, N>& Q) {
  jet.length += s.span.length;
  std::array<T, N> nP, nQ, m;
  for (int i = 0; i < N; ++i) {
    const auto si = static_cast<std::size_t>(i);
    jet.dL_dq[i] += alongFirst(P, i, s.span.dL_dP) + alongFirst(Q, i, s.span.dL_dQ);
    nP[si] = alongFirst(P, i, s.nP);
    nQ[si] = alongFirst(Q, i, s.nQ);
    m[si] = alongFirst(P, i, s.mP) + alongFirst(Q, i, s.mQ);
    for (int j = 0; j <= i; ++j) {
      const auto sj = static_cast<std::size_t>(j);
      const T bent = alongSecond(P, i, j, s.span.dL_dP) + alongSecond(Q, i, j, s.span.dL_dQ);
      const T curved =
          s.bendP * nP[si] * nP[sj] + s.bendQ * nQ[si] * nQ[sj] + s.perLength * m[si] * m[sj];
      addSecond<T, N>(jet, i, j, T(curved + bent));
    }
  }
}

/// Any span by its full Hessian: the chain rule to second order.
template <class T, int N>
void addSpan(LengthJet<N, T>& jet, const SpanToSecondOrder<T>& s, const SpanEnd<T, N>& P,
             const SpanEnd<T, N>& Q) {
  jet.length += s.span.length;
  for (int i = 0; i < N; ++i) {
    const auto si = static_cast<std::size_t>(i);
    jet.dL_dq[i] += alongFirst(P, i, s.span.dL_dP) + alongFirst(Q, i, s.span.dL_dQ);
    // change of the gradient as q_i moves both ends
    Vec3<T> gP = Vec3<T>::Zero(), gQ = Vec3<T>::Zero();
    if (!P.fixed) {
      gP += s.hessian.d2L_dPdP * P.jet.first[si];
      gQ += s.hessian.d2L_dPdQ.transpose() * P.jet.first[si];
    }
    if (!Q.fixed) {
      gP += s.hessian.d2L_dPdQ * Q.jet.first[si];
      gQ += s.hessian.d2L_dQdQ * Q.jet.first[si];
    }
    for (int j = 0; j <= i; ++j) {
      const T curved = alongFirst(P, j, gP) + alongFirst(Q, j, gQ);
      const T bent = alongSecond(P, i, j, s.span.dL_dP) + alongSecond(Q, i, j, s.span.dL_dQ);
      addSecond<T, N>(jet, i, j, T(curved + bent));
    }
  }
}

/// How a segment moves with q_i, as a screw about the ground's origin, and how the screw does with
/// q_j: x_i = v + ω×x, ∂_j(v + ω×x) = ∂_ijx for a point x of the segment.
template <int N>
Screw screwOf(const RigidMotion<double, N>& X, int i) {
  const Placement<double>& X_i = X.first[static_cast<std::size_t>(i)];
  const Mat3<double> W = X_i.R * X.value.R.transpose();
  Screw screw;
  screw.angular = {W(2, 1), W(0, 2), W(1, 0)};
  screw.linear = X_i.p - screw.angular.cross(X.value.p);
  return screw;
}
template <int N>
Screw screwChange(const RigidMotion<double, N>& X, int i, int j) {
  const Placement<double>& X_i = X.first[static_cast<std::size_t>(i)];
  const Placement<double>& X_j = X.first[static_cast<std::size_t>(j)];
  const Placement<double>& X_ij = X.second[static_cast<std::size_t>(pairIndex(i, j))];
  const Mat3<double> W = X_ij.R * X.value.R.transpose() + X_i.R * X_j.R.transpose();
  const Vec3<double> turning = screwOf(X, i).angular;
  Screw screw;
  screw.angular = {W(2, 1), W(0, 2), W(1, 0)};
  screw.linear = X_ij.p - screw.angular.cross(X.value.p) - turning.cross(X_j.p);
  return screw;
}

/// The placements of a chain's surfaces in the ground.
template <int N>
ChainPlacements chainInGround(const CompiledPath& path, const PathChain& chain,
                              const RigidMotion<double, N>* moved) {
  return placementsOf(path, chain, [&](std::size_t segment) -> const Placement<double>& {
    return moved[segment].value;
  });
}

/// How the ends of a chain in the ground and its objects move with q_i.
template <int N>
ChainScrews chainMotion(const CompiledPath& path, const PathChain& chain,
                        const SpanEnd<double, N>& P, const SpanEnd<double, N>& Q,
                        const RigidMotion<double, N>* moved, int i) {
  ChainScrews motion;
  if (!P.fixed) motion.P = P.jet.first[static_cast<std::size_t>(i)];
  if (!Q.fixed) motion.Q = Q.jet.first[static_cast<std::size_t>(i)];
  for (std::size_t j = 0; j < static_cast<std::size_t>(chain.count); ++j) {
    const std::size_t segment = path.surfaces[chain.members[j].surface].segment;
    if (segment != 0) motion.objects[j] = screwOf<N>(moved[segment], i);
  }
  return motion;
}

/// A chain whose objects belong to several segments, by the chain rule over ends and placements:
///     ∂_ijL = (∂_i∇L)·m_j + ∇L·∂_im_j,   m_i the motions of ends and objects with q_i
/// (which of the two moves matters: turns do not commute).
template <int N>
void addMovingChain(LengthJet<N>& jet, const CompiledPath& path, const PathChain& chain,
                    const ChainPath& taut, const SpanEnd<double, N>& P, const SpanEnd<double, N>& Q,
                    const RigidMotion<double, N>* moved) {
  const ChainScrews gradient = chainGradient(taut);
  const ChainChanges changes(taut);
  const auto count = static_cast<std::size_t>(chain.count);
  std::array<ChainScrews, N> motions;
  for (int i = 0; i < N; ++i) {
    const auto si = static_cast<std::size_t>(i);
    motions[si] = chainMotion<N>(path, chain, P, Q, moved, i);
    jet.dL_dq[i] += powerOf(gradient, motions[si], count);
    const ChainScrews changed = changes.gradientChange(motions[si]);
    for (int j = 0; j <= i; ++j) {
      double bent = alongSecond(P, i, j, gradient.P) + alongSecond(Q, i, j, gradient.Q);
      for (std::size_t k = 0; k < count; ++k) {
        const std::size_t segment = path.surfaces[chain.members[k].surface].segment;
        if (segment == 0) continue;
        const Screw turned = screwChange<N>(moved[segment], j, i);
        bent += gradient.objects[k].linear.dot(turned.linear) +
                gradient.objects[k].angular.dot(turned.angular);
      }
      addSecond<double, N>(jet, i, j,
                           powerOf(changed, motions[static_cast<std::size_t>(j)], count) + bent);
    }
  }
  jet.length += taut.length;
}

/// Adds a span over a chain; straight where it touches nothing.
template <int N>
void addChain(LengthJet<N>& jet, const CompiledPath& path, const PathSpan& span,
              const SpanEnd<double, N>& P, const SpanEnd<double, N>& Q,
              const RigidMotion<double, N>* moved, const double* radii, unsigned& used) {
  const PathChain& chain = path.chains[static_cast<std::size_t>(span.chain)];
  if (chain.inOneSegment) {
    PathSurface carrier;
    carrier.segment = path.surfaces[chain.members[0].surface].segment;
    const SpanEnd<double, N> p_SP = seenFromSurface(carrier, moved, P);
    const SpanEnd<double, N> p_SQ = seenFromSurface(carrier, moved, Q);
    const SpanToSecondOrder<double> s =
        spanOver(path, chain, p_SP.jet.value, p_SQ.jet.value, used, radii);
    if (!s.span.touches) return addStraight(jet, P, Q);
    addSpan(jet, s, p_SP, p_SQ);
  } else {
    const ChainPlacements X_GC = chainInGround<N>(path, chain, moved);
    const PlacedChain placed = placeChain(path, chain, X_GC, radii);
    const ChainPath taut = tautChain(path, chain, placed, X_GC, P.jet.value, Q.jet.value, used);
    if (taut.numContacts == 0) return addStraight(jet, P, Q);
    addMovingChain<N>(jet, path, chain, taut, P, Q, moved);
  }
  jet.wrapped = jet.wrapped || span.moves;
}

/// Adds the span over the first surface that it touches and that is not in use, else straight.
template <class T, int N>
void addPathSpan(LengthJet<N, T>& jet, const CompiledPath& path, const PathSpan& span,
                 const SpanEnd<T, N>& P, const SpanEnd<T, N>& Q, const RigidMotion<T, N>* moved,
                 const T* radii, unsigned& used) {
  if (span.chain >= 0) {
    if constexpr (std::is_same_v<T, double>) {
      return addChain<N>(jet, path, span, P, Q, moved, radii, used);
    } else {
      throw std::logic_error("a chain of wrap objects is computed for numbers of type double only");
    }
  }
  for (const SpanSurface& way : span.surfaces) {
    const unsigned bit = 1u << way.surface;
    if ((used & bit) != 0) continue;
    const PathSurface& surface = path.surfaces[way.surface];
    const T radius = radii ? radii[surface.wrap] : T(surface.radius);
    const SpanEnd<T, N> p_CP = seenFromSurface(surface, moved, P);
    const SpanEnd<T, N> p_CQ = seenFromSurface(surface, moved, Q);
    const Vec3<T>& from = p_CP.jet.value;
    const Vec3<T>& to = p_CQ.jet.value;
    if (surfaceIsOutOfPlay(surface, radius, way, from, to)) continue;
    if (surface.isSphere) {
      const SpanToSecondOrder<T> s = wrapSphereToSecondOrder(radius, way.way, from, to);
      if (!s.span.touches) continue;
      addSpan(jet, s, p_CP, p_CQ);
    } else {
      const CylinderDyads<T> s = wrapCylinderDyads(radius, way.side, from, to);
      if (!s.span.touches) continue;
      addCylinder(jet, s, p_CP, p_CQ);
    }
    used |= bit;
    jet.wrapped = jet.wrapped || span.moves;
    return;
  }
  addStraight(jet, P, Q);
}

template <int N>
LengthJet<N> functionLength(const LengthFunction& function, const Eigen::Matrix<double, N, 1>& q) {
  const LengthFunction::Value at = function.at(q.data());
  LengthJet<N> jet;
  jet.length = at.length;
  jet.dL_dq.setZero();
  jet.d2L_dq2.setZero();
  const std::vector<int>& support = function.support();
  for (std::size_t i = 0; i < support.size(); ++i) {
    jet.dL_dq[support[i]] = at.first[i];
    for (std::size_t j = 0; j < support.size(); ++j) {
      jet.d2L_dq2(support[i], support[j]) = at.second[i][j];
    }
  }
  return jet;
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
                                const RigidMotion<double, N>* moved,
                                const Eigen::Matrix<double, N, 1>* conditionsAt) const {
  if constexpr (N == 1) {
    PathTable::Value found;
    if (table_ && conditionsAt == nullptr && table_->find(q[0], found)) {
      LengthJet<1> jet;
      jet.length = found.length;
      jet.dL_dq[0] = found.slope;
      jet.d2L_dq2(0, 0) = found.curvature;
      jet.wrapped = found.wrapped;
      return jet;
    }
  }
  if (compiled_.function) return detail::functionLength<N>(*compiled_.function, q);
  const PathVariant& variant = activeVariant(compiled_, conditionsAt ? *conditionsAt : q);
  LengthJet<N> jet = detail::noLength<N, double>();
  jet.length = variant.fixedLength;
  unsigned used = 0;
  for (const PathSpan& span : variant.moving) {
    const PathNode& a = compiled_.nodes[span.a];
    const PathNode& b = compiled_.nodes[span.b];
    const auto P = detail::spanEnd<double, N>(compiled_, a, a.p_S, q, moved);
    const auto Q = detail::spanEnd<double, N>(compiled_, b, b.p_S, q, moved);
    detail::addPathSpan<double, N>(jet, compiled_, span, P, Q, moved, nullptr, used);
  }
  return jet;
}

template <class T, int N>
LengthJet<N, T> MusclePath::length(const PathParameters<T>& parameters,
                                   const Eigen::Matrix<T, N, 1>& q,
                                   const RigidMotion<T, N>* moved) const {
  if (compiled_.function) {
    if constexpr (std::is_same_v<T, double>)
      return detail::functionLength<N>(*compiled_.function, q);
    throw std::logic_error("a length function is evaluated for numbers of type double only");
  }
  const PathVariant& variant = activeVariant(compiled_, q);
  LengthJet<N, T> jet = detail::noLength<N, T>();
  const auto endOf = [&](const PathNode& node) {
    const Mat3<T> R = node.X_SB.R.template cast<T>();
    const Vec3<T> p_S = R * parameters.points[node.point] + node.X_SB.p.template cast<T>();
    return detail::spanEnd<T, N>(compiled_, node, p_S, q, moved);
  };
  unsigned used = 0;
  for (const PathSpan& span : variant.all) {
    detail::addPathSpan<T, N>(jet, compiled_, span, endOf(compiled_.nodes[span.a]),
                              endOf(compiled_.nodes[span.b]), moved, parameters.radii.data(), used);
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
  Posture posture{std::vector<double>(q.data(), q.data() + q.size()), {}};
  for (std::size_t s = 0; s < segments; ++s) posture.placements.push_back(moved[s].value);
  return pathPoints(posture, step);
}

}  // namespace bio
