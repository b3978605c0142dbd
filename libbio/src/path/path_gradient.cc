#include "bio/path/path_gradient.h"

#include "bio/path/path_length.h"
#include "path/radius_derivatives.h"
#include "path/touched_object.h"

namespace bio {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d times(const Matrix3d& R, const Vector3d& v) {
  return R.lazyProduct(v);
}
Vector3d back(const Matrix3d& R, const Vector3d& v) {
  return R.transpose().lazyProduct(v);
}

/// An end of a span with its first derivatives.
template <int N>
struct EndMotion {
  Vector3d value;
  std::array<Vector3d, N> first;
};

template <int N>
EndMotion<N> endInGround(const CompiledPath& path, const PathNode& node,
                         const Eigen::Matrix<double, N, 1>& q,
                         const RigidMotion<double, N>* moved) {
  if (node.motion >= 0) {
    const auto jet = detail::nodeJet<double, N>(path, node, node.p_S, q, moved);
    return {jet.value, jet.first};
  }
  EndMotion<N> end;
  const RigidMotion<double, N>& X = moved[node.segment];
  end.value = times(X.value.R, node.p_S) + X.value.p;
  for (std::size_t k = 0; k < N; ++k) {
    end.first[k] = times(X.first[k].R, node.p_S) + X.first[k].p;
  }
  return end;
}

/// How the end tangents of a wrapped span change as its ends move; of a cylinder by three dyads.
struct TouchedSpan {
  SpanToSecondOrder<double> whole;
  CylinderDyads<double> dyads;
  bool isSphere;

  TouchedSpan(const PathSurface& surface, const SpanSurface& way, const Vector3d& P,
              const Vector3d& Q)
      : isSphere(surface.isSphere) {
    if (isSphere) {
      whole = wrapSphereToSecondOrder(surface.radius, way.way, P, Q);
    } else {
      dyads = wrapCylinderDyads(surface.radius, way.side, P, Q);
    }
  }
  RadiusDerivatives inRadius(const PathSurface& surface, const SpanSurface& way, const Vector3d& P,
                             const Vector3d& Q) const {
    return isSphere ? bio::inRadius(surface, way, P, Q) : bio::inRadius(dyads, way.side);
  }
  const Span<double>& span() const { return isSphere ? whole.span : dyads.span; }
  void change(const Vector3d& dP, const Vector3d& dQ, Vector3d& gP, Vector3d& gQ) const {
    if (isSphere) {
      gP = times(whole.hessian.d2L_dPdP, dP) + times(whole.hessian.d2L_dPdQ, dQ);
      gQ = back(whole.hessian.d2L_dPdQ, dP) + times(whole.hessian.d2L_dQdQ, dQ);
      return;
    }
    const double m = (dyads.mP.dot(dP) + dyads.mQ.dot(dQ)) * dyads.perLength;
    gP = dyads.bendP * dyads.nP.dot(dP) * dyads.nP + m * dyads.mP;
    gQ = dyads.bendQ * dyads.nQ.dot(dQ) * dyads.nQ + m * dyads.mQ;
  }
};

/// Adds what a point's location does through covector c in ground with slopes c_k:
/// R_SBᵀXᵀc, and R_SBᵀ(X_kᵀc + Xᵀc_k).
template <int N, class Out>
void addPoint(const PathNode& node, const RigidMotion<double, N>* moved, const Vector3d& c,
              const std::array<Vector3d, N>& c_k, Out& out) {
  const Matrix3d& R_SB = node.X_SB.R;
  if (node.segment == 0) {
    out.col(0) += back(R_SB, c);
    for (std::size_t k = 0; k < N; ++k) {
      out.col(static_cast<Eigen::Index>(k) + 1) += back(R_SB, c_k[k]);
    }
    return;
  }
  const RigidMotion<double, N>& X = moved[node.segment];
  out.col(0) += back(R_SB, back(X.value.R, c));
  for (std::size_t k = 0; k < N; ++k) {
    const Vector3d inSegment = back(X.first[k].R, c) + back(X.value.R, c_k[k]);
    out.col(static_cast<Eigen::Index>(k) + 1) += back(R_SB, inSegment);
  }
}

}  // namespace

PathGradients::PathGradients(const Model& model, const Skeleton& skeleton, const Muscle& muscle,
                             const MusclePath& path)
    : path_(&path.compiled()),
      numPoints_(muscle.path.points.size()),
      numWraps_(muscle.path.wraps.size()),
      mayTouch_(numWraps_, false),
      used_(numPoints_, false) {
  for (const PathNode& node : path_->nodes) used_[node.point] = true;
  for (const PathPoint& point : muscle.path.points) bodies_.push_back(point.body);
  for (const PathSurface& surface : path_->surfaces) {
    const WrapObject& object = findWrapObject(model, muscle.path.wraps[surface.wrap].wrapObject);
    SurfaceFrame frame;
    frame.R_SB = skeleton.placeOf(object.body).X_SB.R;
    // R_BC = Rx Ry Rz turns about: e_z for the last angle, then Rzᵀe_y, then (Ry Rz)ᵀe_x
    const Vector3d& o = object.frame.orientation;
    const Matrix3d Rx = Eigen::AngleAxisd(o.x(), Vector3d::UnitX()).toRotationMatrix();
    const Matrix3d Ry = Eigen::AngleAxisd(o.y(), Vector3d::UnitY()).toRotationMatrix();
    const Matrix3d Rz = Eigen::AngleAxisd(o.z(), Vector3d::UnitZ()).toRotationMatrix();
    // an ellipsoid taken as a cylinder has its axes renamed: surface frame = R_BC·renamed
    const Matrix3d renamed = (Rx * Ry * Rz).transpose() * frame.R_SB.transpose() * surface.X_SC.R;
    frame.turnAxes.col(0) = renamed.transpose() * ((Ry * Rz).transpose() * Vector3d::UnitX());
    frame.turnAxes.col(1) = renamed.transpose() * (Rz.transpose() * Vector3d::UnitY());
    frame.turnAxes.col(2) = renamed.transpose() * Vector3d::UnitZ();
    frames_.push_back(frame);
  }
  for (const PathVariant& variant : path_->variants) {
    for (const PathSpan& span : variant.all) {
      for (const SpanSurface& way : span.surfaces) {
        mayTouch_[path_->surfaces[way.surface].wrap] = true;
      }
    }
  }
  // fixed spans have both ends and their surface in one segment: its placement does not matter
  std::vector<RigidMotion<double, 1>> still(skeleton.numSegments(), identityMotion<double, 1>());
  const Eigen::Matrix<double, 1, 1> anywhere(0.0);
  for (const PathVariant& variant : path_->variants) {
    PathGradient<1> sum = workspace<1>();
    for (const PathSpan& span : variant.all) {
      unsigned none = 0;
      if (!span.moves) addSpan<1>(span, anywhere, still.data(), none, true, sum);
    }
    PathGradient<0> constant = workspace<0>();
    for (std::size_t i = 0; i < numPoints_; ++i) constant.points[i] = sum.points[i].col(0);
    for (std::size_t i = 0; i < numWraps_; ++i) constant.wraps[i] = sum.wraps[i].col(0);
    constant_.push_back(std::move(constant));
  }
}

template <int N>
PathGradient<N> PathGradients::workspace() const {
  PathGradient<N> gradient;
  gradient.points.assign(numPoints_, PathGradient<N>::OfPoint::Zero());
  gradient.wraps.assign(numWraps_, PathGradient<N>::OfWrap::Zero());
  return gradient;
}

template <int N>
void PathGradients::addSpan(const PathSpan& span, const Eigen::Matrix<double, N, 1>& q,
                            const RigidMotion<double, N>* moved, unsigned& usedSurfaces,
                            bool isFixed, PathGradient<N>& out) const {
  if (span.chain >= 0) return addChain<N>(span, q, moved, usedSurfaces, out);
  const PathNode& a = path_->nodes[span.a];
  const PathNode& b = path_->nodes[span.b];
  const EndMotion<N> P_G = endInGround<N>(*path_, a, q, moved);
  const EndMotion<N> Q_G = endInGround<N>(*path_, b, q, moved);
  std::array<Vector3d, N> atP, atQ;  // slopes of the end covectors in ground

  for (const SpanSurface& way : span.surfaces) {
    const unsigned bit = 1u << way.surface;
    if ((usedSurfaces & bit) != 0) continue;
    const PathSurface& surface = path_->surfaces[way.surface];
    const RigidMotion<double, N>& X = moved[surface.segment];
    const Matrix3d R_GC = X.value.R.lazyProduct(surface.X_SC.R);
    const Vector3d p_SC = back(surface.X_SC.R, surface.X_SC.p);
    const Vector3d dP = P_G.value - X.value.p, dQ = Q_G.value - X.value.p;
    const Vector3d P = back(R_GC, dP) - p_SC, Q = back(R_GC, dQ) - p_SC;
    if (surfaceIsOutOfPlay(surface, surface.radius, way, P, Q)) {
      if (isFixed) break;  // the first object has it
      continue;
    }
    const TouchedSpan s(surface, way, P, Q);
    if (!s.span().touches) {
      if (isFixed) break;
      continue;
    }
    usedSurfaces |= bit;
    const Vector3d& cP = s.span().dL_dP;
    const Vector3d& cQ = s.span().dL_dQ;
    const RadiusDerivatives r = s.inRadius(surface, way, P, Q);
    const SurfaceFrame& frame = frames_[way.surface];
    auto& wrap = out.wraps[surface.wrap];
    const Matrix3d intoBody = frame.R_SB.transpose().lazyProduct(surface.X_SC.R);
    wrap(0, 0) += r.length;
    wrap.template block<3, 1>(1, 0) -= times(intoBody, cP + cQ);
    const Vector3d moment = P.cross(cP) + Q.cross(cQ);
    wrap.template block<3, 1>(4, 0) -= back(frame.turnAxes, moment);
    for (std::size_t k = 0; k < N; ++k) {
      const auto column = static_cast<Eigen::Index>(k) + 1;
      Matrix3d turned;  // ∂_kR_GC
      Vector3d P_k = back(R_GC, P_G.first[k] - X.first[k].p);
      Vector3d Q_k = back(R_GC, Q_G.first[k] - X.first[k].p);
      if (surface.segment != 0) {
        turned = X.first[k].R.lazyProduct(surface.X_SC.R);
        P_k += back(turned, dP);
        Q_k += back(turned, dQ);
      }
      Vector3d gP, gQ;
      s.change(P_k, Q_k, gP, gQ);
      wrap(0, column) += r.dL_dP.dot(P_k) + r.dL_dQ.dot(Q_k);
      wrap.template block<3, 1>(1, column) -= times(intoBody, gP + gQ);
      const Vector3d moment_k = P.cross(gP) + P_k.cross(cP) + Q.cross(gQ) + Q_k.cross(cQ);
      wrap.template block<3, 1>(4, column) -= back(frame.turnAxes, moment_k);
      atP[k] = times(R_GC, gP);
      atQ[k] = times(R_GC, gQ);
      if (surface.segment != 0) {
        atP[k] += times(turned, cP);
        atQ[k] += times(turned, cQ);
      }
    }
    addPoint<N>(a, moved, times(R_GC, cP), atP, out.points[a.point]);
    addPoint<N>(b, moved, times(R_GC, cQ), atQ, out.points[b.point]);
    return;
  }

  // straight: t = D/L, ∂_k t = (∂_kD − t (t·∂_kD))/L
  const Vector3d D = Q_G.value - P_G.value;
  const double perLength = 1 / D.norm();
  const Vector3d t = D * perLength;
  for (std::size_t k = 0; k < N; ++k) {
    const Vector3d D_k = Q_G.first[k] - P_G.first[k];
    atQ[k] = (D_k - t * t.dot(D_k)) * perLength;
    atP[k] = -atQ[k];
  }
  addPoint<N>(a, moved, -t, atP, out.points[a.point]);
  addPoint<N>(b, moved, t, atQ, out.points[b.point]);
}

// ∇L of the ends and of each object's screw about the ground's origin, and how they change with
// q_k.
template <int N>
void PathGradients::addChain(const PathSpan& span, const Eigen::Matrix<double, N, 1>& q,
                             const RigidMotion<double, N>* moved, unsigned& usedSurfaces,
                             PathGradient<N>& out) const {
  const PathChain& chain = path_->chains[static_cast<std::size_t>(span.chain)];
  const PathNode& a = path_->nodes[span.a];
  const PathNode& b = path_->nodes[span.b];
  detail::SpanEnd<double, N> P, Q;
  P.jet = detail::nodeJet<double, N>(*path_, a, a.p_S, q, moved);
  Q.jet = detail::nodeJet<double, N>(*path_, b, b.p_S, q, moved);
  const ChainPlacements X_GC = detail::chainInGround<N>(*path_, chain, moved);
  const PlacedChain placed = placeChain(*path_, chain, X_GC);
  const ChainPath taut =
      tautChain(*path_, chain, placed, X_GC, P.jet.value, Q.jet.value, usedSurfaces);
  const ChainScrews gradient = chainGradient(taut);
  const ChainChanges changes(taut);
  std::array<ChainScrews, N> motions, changed;
  std::array<Vector3d, N> atP, atQ;
  for (std::size_t k = 0; k < N; ++k) {
    motions[k] = detail::chainMotion<N>(*path_, chain, P, Q, moved, static_cast<int>(k));
    changed[k] = changes.gradientChange(motions[k]);
    atP[k] = changed[k].P;
    atQ[k] = changed[k].Q;
  }
  addPoint<N>(a, moved, gradient.P, atP, out.points[a.point]);
  addPoint<N>(b, moved, gradient.Q, atQ, out.points[b.point]);
  for (std::size_t i = 0; i < static_cast<std::size_t>(taut.numContacts); ++i) {
    const ChainContact& contact = taut.contacts[i];
    const auto j = static_cast<std::size_t>(contact.object);
    const std::size_t index = chain.members[j].surface;
    const PathSurface& surface = path_->surfaces[index];
    const Matrix3d R_GB = moved[surface.segment].value.R * frames_[index].R_SB;
    const TouchedObject object(surface, X_GC[j], R_GB, frames_[index].turnAxes, placed.objects[j],
                               contact, gradient.objects[j]);
    auto& wrap = out.wraps[surface.wrap];
    object.addTo(wrap);
    for (std::size_t k = 0; k < N; ++k) {
      object.addChangeTo(wrap, static_cast<Eigen::Index>(k) + 1, changes.shifts(motions[k])[i],
                         changed[k].objects[j], motions[k].objects[j]);
    }
  }
}

template <int N>
void PathGradients::evaluate(const Eigen::Matrix<double, N, 1>& q,
                             const RigidMotion<double, N>* moved, PathGradient<N>& out) const {
  const PathVariant& variant = activeVariant(*path_, q);
  const auto index = static_cast<std::size_t>(&variant - path_->variants.data());
  const PathGradient<0>& fixed = constant_[index];
  for (std::size_t i = 0; i < numPoints_; ++i) {
    out.points[i].col(0) = fixed.points[i];
    out.points[i].template rightCols<N>().setZero();
  }
  for (std::size_t i = 0; i < numWraps_; ++i) {
    out.wraps[i].col(0) = fixed.wraps[i];
    out.wraps[i].template rightCols<N>().setZero();
  }
  unsigned used = 0;
  for (const PathSpan& span : variant.moving) {
    addSpan<N>(span, q, moved, used, false, out);
  }
}

template PathGradient<1> PathGradients::workspace<1>() const;
template PathGradient<2> PathGradients::workspace<2>() const;
template PathGradient<3> PathGradients::workspace<3>() const;
template PathGradient<4> PathGradients::workspace<4>() const;
template void PathGradients::evaluate<1>(const Eigen::Matrix<double, 1, 1>&,
                                         const RigidMotion<double, 1>*, PathGradient<1>&) const;
template void PathGradients::evaluate<2>(const Eigen::Matrix<double, 2, 1>&,
                                         const RigidMotion<double, 2>*, PathGradient<2>&) const;
template void PathGradients::evaluate<3>(const Eigen::Matrix<double, 3, 1>&,
                                         const RigidMotion<double, 3>*, PathGradient<3>&) const;
template void PathGradients::evaluate<4>(const Eigen::Matrix<double, 4, 1>&,
                                         const RigidMotion<double, 4>*, PathGradient<4>&) const;

}  // namespace bio
