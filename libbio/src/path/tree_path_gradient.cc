#include "bio/path/path_gradient.h"
#include "path/radius_derivatives.h"
#include "path/touched_object.h"
#include "path/tree_chain.h"

namespace bio {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A span of a tree, with what its gradients need.
struct PathGradients::TreeSpan {
  const TreePath::Piece& piece;
  const ArticulatedTree& tree;
  const TreeMotion<double>& motion;
  SupportedLength<double>& work;  ///< slotMoves: k movements, or slopes, of P, then k of Q
  std::size_t supported;          ///< k
};

PathGradient<Eigen::Dynamic> PathGradients::workspace(const TreePath& path) const {
  const auto columns = static_cast<Eigen::Index>(1 + path.support().size());
  PathGradient<Eigen::Dynamic> gradient;
  gradient.points.assign(numPoints_, PathGradient<Eigen::Dynamic>::OfPoint::Zero(3, columns));
  gradient.wraps.assign(numWraps_,
                        PathGradient<Eigen::Dynamic>::OfWrap::Zero(wrap_rows::count, columns));
  return gradient;
}

namespace {

/// Movements of a point by each coordinate of the support, as seen from where the chain begins.
void slotMovesOf(const SegmentChain& chain, const TreeMotion<double>& motion, const Vector3d& x,
                 SupportedLength<double>& work, Vector3d* moves, std::size_t supported) {
  for (std::size_t i = 0; i < supported; ++i) moves[i].setZero();
  chainMoves(chain, motion, x, work.moves.data());
  for (std::size_t j = 0; j < chain.steps().size(); ++j) {
    moves[chain.steps()[j].slot] += work.moves[j];
  }
}

}  // namespace

// What a point's location does through covector c at it, all in the ground: R_GBᵀc, and with Ω_i
// the turn of its body by coordinate i, as seen from where c is, R_GBᵀ(c_i − Ω_i × c).
void PathGradients::addTreePoint(const TreeSpan& span, std::size_t node, const SegmentChain* chain,
                                 const Vector3d& c, std::size_t slopes,
                                 PathGradient<Eigen::Dynamic>& out) const {
  const std::size_t point = path_->nodes[node].point;
  const BodyPlacement& place = span.tree.placeOf(bodies_[point]);
  const Matrix3d R_BG = (span.motion.segments[place.segment].R * place.X_SB.R).transpose();
  auto& gradient = out.points[point];
  gradient.col(0) += R_BG * c;
  for (std::size_t i = 0; i < span.supported; ++i) {
    gradient.col(static_cast<Eigen::Index>(1 + i)) += R_BG * span.work.slotMoves[slopes + i];
  }
  if (!chain) return;
  for (const SegmentChain::Step& step : chain->steps()) {
    const auto& S = span.motion.screw[static_cast<std::size_t>(step.mobility)];
    const Vector3d turn(S[0], S[1], S[2]);
    gradient.col(1 + step.slot) -= step.sign * (R_BG * turn.cross(c));
  }
}

// As PathGradients::addSpan for a fixed number of coordinates; slotMoves, the movements of the ends
// in the ground as the surface sees them, become the slopes of the covectors there.
void PathGradients::addSurface(const TreeSpan& span, const detail::SpanOverSurface& s,
                               PathGradient<Eigen::Dynamic>& out) const {
  const std::size_t index = s.over->way.surface;
  const PathSurface& surface = path_->surfaces[index];
  const SurfaceFrame& frame = frames_[index];
  const Vector3d& cP = s.span.span.dL_dP;
  const Vector3d& cQ = s.span.span.dL_dQ;
  const RadiusDerivatives r = inRadius(surface, s.over->way, s.p_CP, s.p_CQ);
  auto& wrap = out.wraps[surface.wrap];
  const Matrix3d intoBody = frame.R_SB.transpose() * surface.X_SC.R;
  const Matrix3d& R = s.X_GC.R;
  wrap(0, 0) += r.length;
  wrap.block<3, 1>(1, 0) -= intoBody * (cP + cQ);
  const Vector3d moment = s.p_CP.cross(cP) + s.p_CQ.cross(cQ);
  wrap.block<3, 1>(4, 0) -= frame.turnAxes.transpose() * moment;
  Vector3d* u = span.work.slotMoves.data();
  Vector3d* w = u + span.supported;
  for (std::size_t i = 0; i < span.supported; ++i) {
    const auto column = static_cast<Eigen::Index>(i) + 1;
    const Vector3d P_i = R.transpose() * u[i], Q_i = R.transpose() * w[i];
    const Vector3d gP = s.span.hessian.d2L_dPdP * P_i + s.span.hessian.d2L_dPdQ * Q_i;
    const Vector3d gQ = s.span.hessian.d2L_dPdQ.transpose() * P_i + s.span.hessian.d2L_dQdQ * Q_i;
    wrap(0, column) += r.dL_dP.dot(P_i) + r.dL_dQ.dot(Q_i);
    wrap.block<3, 1>(1, column) -= intoBody * (gP + gQ);
    const Vector3d moment_i = s.p_CP.cross(gP) + P_i.cross(cP) + s.p_CQ.cross(gQ) + Q_i.cross(cQ);
    wrap.block<3, 1>(4, column) -= frame.turnAxes.transpose() * moment_i;
    u[i] = R * gP;
    w[i] = R * gQ;
  }
}

// As PathGradients::addChain for a fixed number of coordinates. The motions of the ends, once used,
// become the slopes of the covectors there.
bool PathGradients::addTreeChain(const TreeSpan& span, const Vector3d& P, const Vector3d& Q,
                                 unsigned& used, PathGradient<Eigen::Dynamic>& out) const {
  const TreePath::OverChain& over = *span.piece.overChain;
  const TautTreeChain chain = tautTreeChain(*path_, over, span.motion, P, Q, used);
  if (chain.taut.numContacts == 0) return false;
  const ChainScrews gradient = chainGradient(chain.taut);
  const ChainChanges changes(chain.taut);
  fillChainMotions(over, span.motion, P, Q, span.work);
  for (std::size_t i = 0; i < static_cast<std::size_t>(chain.taut.numContacts); ++i) {
    const ChainContact& contact = chain.taut.contacts[i];
    const auto j = static_cast<std::size_t>(contact.object);
    const std::size_t index = path_->chains[over.chain].members[j].surface;
    const PathSurface& surface = path_->surfaces[index];
    const Placement<double>& X_GC = chain.X_GC[j];
    const Matrix3d R_GB = X_GC.R * surface.X_SC.R.transpose() * frames_[index].R_SB;
    const TouchedObject object(surface, X_GC, R_GB, frames_[index].turnAxes,
                               chain.placed.objects[j], contact, gradient.objects[j]);
    auto& wrap = out.wraps[surface.wrap];
    object.addTo(wrap);
    for (std::size_t k = 0; k < span.supported; ++k) {
      const ChainScrews motion = chainMotionOf(over, span.work, k);
      object.addChangeTo(wrap, static_cast<Eigen::Index>(k) + 1, changes.shifts(motion)[i],
                         changes.gradientChange(motion).objects[j], motion.objects[j]);
    }
  }
  for (std::size_t k = 0; k < span.supported; ++k) {
    const ChainScrews changed = changes.gradientChange(chainMotionOf(over, span.work, k));
    span.work.slotMoves[k] = changed.P;
    span.work.slotMoves[span.supported + k] = changed.Q;
  }
  addTreePoint(span, span.piece.a, &over.toP, gradient.P, 0, out);
  addTreePoint(span, span.piece.b, &over.toQ, gradient.Q, span.supported, out);
  return true;
}

void PathGradients::evaluate(const Eigen::VectorXd& q, const TreePath& path,
                             const ArticulatedTree& tree, const TreeMotion<double>& motion,
                             SupportedLength<double>& work,
                             PathGradient<Eigen::Dynamic>& out) const {
  const PathVariant& variant = activeVariant(*path_, q);
  const auto index = static_cast<std::size_t>(&variant - path_->variants.data());
  for (std::size_t i = 0; i < numPoints_; ++i) {
    out.points[i].setZero();
    out.points[i].col(0) = constant_[index].points[i];
  }
  for (std::size_t i = 0; i < numWraps_; ++i) {
    out.wraps[i].setZero();
    out.wraps[i].col(0) = constant_[index].wraps[i];
  }
  const std::size_t k = path.support().size();
  Vector3d* u = work.slotMoves.data();
  Vector3d* w = u + k;
  unsigned used = 0;
  for (const TreePath::Piece& piece : path.pieces(index)) {
    const TreeSpan span{piece, tree, motion, work, k};
    const Vector3d P = stationInGround(motion, piece.from);
    const Vector3d Q = stationInGround(motion, piece.to);
    if (piece.overChain && addTreeChain(span, P, Q, used, out)) continue;
    const detail::SpanOverSurface s = detail::spanOverSurface(*path_, piece, motion, P, Q, used);
    if (s.over) {
      slotMovesOf(s.over->toP, motion, P, work, u, k);
      slotMovesOf(s.over->toQ, motion, Q, work, w, k);
      addSurface(span, s, out);
      addTreePoint(span, piece.a, &s.over->toP, s.X_GC.R * s.span.span.dL_dP, 0, out);
      addTreePoint(span, piece.b, &s.over->toQ, s.X_GC.R * s.span.span.dL_dQ, k, out);
      continue;
    }
    // straight, seen from P's segment: ∂_i t = (∂_iQ − t (t·∂_iQ))/L
    const Vector3d D = Q - P;
    const double perLength = 1 / D.norm();
    const Vector3d t = D * perLength;
    slotMovesOf(piece.chain, motion, Q, work, w, k);
    for (std::size_t i = 0; i < k; ++i) {
      w[i] = (w[i] - t * t.dot(w[i])) * perLength;
      u[i] = -w[i];
    }
    addTreePoint(span, piece.a, nullptr, -t, 0, out);
    addTreePoint(span, piece.b, &piece.chain, t, k, out);
  }
}

}  // namespace bio
