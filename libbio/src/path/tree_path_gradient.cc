#include "bio/path/path_gradient.h"
#include "path/radius_derivatives.h"
#include "path/tree_chain.h"

namespace bio {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// What a span of a tree hands on.
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
                        PathGradient<Eigen::Dynamic>::OfWrap::Zero(numWrapRows, columns));
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
  auto& of = out.points[point];
  of.col(0) += R_BG * c;
  for (std::size_t i = 0; i < span.supported; ++i) {
    of.col(static_cast<Eigen::Index>(1 + i)) += R_BG * span.work.slotMoves[slopes + i];
  }
  if (!chain) return;
  for (const SegmentChain::Step& step : chain->steps()) {
    const auto& S = span.motion.screw[static_cast<std::size_t>(step.mobility)];
    const Vector3d turn(S[0], S[1], S[2]);
    of.col(1 + step.slot) -= step.sign * (R_BG * turn.cross(c));
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

/// A touched object of a chain with the force and moment on it.
struct PathGradients::TreeObject {
  const PathSurface& surface;
  const SurfaceFrame& frame;
  Placement<double> X_GC;
  Matrix3d R_BG;    ///< into the axes of its body
  Screw wrench;     ///< about the ground's origin
  Vector3d moment;  ///< about its own origin
  int numNumbers;   ///< of its own
  std::array<NumberIntegral, maxSurfaceNumbers> numbers;
};

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
  const auto count = static_cast<std::size_t>(chain.taut.numContacts);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t j = static_cast<std::size_t>(chain.taut.contacts[i].object);
    const TreeObject object = treeObject(over, chain, chain.taut.contacts[i], gradient);
    addTreeObject(object, out);
    for (std::size_t k = 0; k < span.supported; ++k) {
      const ChainScrews motion = chainMotionOf(over, span.work, k);
      addTreeObjectChange(object, changes.shifts(motion)[i],
                          changes.gradientChange(motion).objects[j], motion.objects[j],
                          static_cast<Eigen::Index>(k) + 1, out);
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

PathGradients::TreeObject PathGradients::treeObject(const TreePath::OverChain& over,
                                                    const TautTreeChain& chain,
                                                    const ChainContact& contact,
                                                    const ChainScrews& gradient) const {
  const auto j = static_cast<std::size_t>(contact.object);
  const std::size_t index = path_->chains[over.chain].members[j].surface;
  const PathSurface& surface = path_->surfaces[index];
  const SurfaceFrame& frame = frames_[index];
  const Placement<double>& X_GC = chain.X_GC[j];
  const Screw& g = gradient.objects[j];
  return {surface,
          frame,
          X_GC,
          (X_GC.R * surface.X_SC.R.transpose() * frame.R_SB).transpose(),
          g,
          g.angular - X_GC.p.cross(g.linear),
          numNumbersOf(chain.placed.objects[j].surface),
          contactNumbers(chain.placed.objects[j], contact)};
}

void PathGradients::addTreeObject(const TreeObject& object,
                                  PathGradient<Eigen::Dynamic>& out) const {
  auto& wrap = out.wraps[object.surface.wrap];
  for (int n = 0; n < object.numNumbers; ++n) {
    wrap(wrapNumberRow(object.surface.general.has_value(), n), 0) +=
        object.numbers[static_cast<std::size_t>(n)].length;
  }
  wrap.block<3, 1>(1, 0) += object.R_BG * object.wrench.linear;
  wrap.block<3, 1>(4, 0) +=
      object.frame.turnAxes.transpose() * (object.X_GC.R.transpose() * object.moment);
}

// Force and moment in axes that move with the object.
void PathGradients::addTreeObjectChange(const TreeObject& object, const ContactShift& shift,
                                        const Screw& changed, const Screw& motion,
                                        Eigen::Index column,
                                        PathGradient<Eigen::Dynamic>& out) const {
  auto& wrap = out.wraps[object.surface.wrap];
  for (int n = 0; n < object.numNumbers; ++n) {
    wrap(wrapNumberRow(object.surface.general.has_value(), n), column) +=
        numberChange(object.numbers[static_cast<std::size_t>(n)], shift);
  }
  const Vector3d& origin = object.X_GC.p;
  const Vector3d originMoves = motion.linear + motion.angular.cross(origin);
  const Vector3d moment =
      changed.angular - origin.cross(changed.linear) - originMoves.cross(object.wrench.linear);
  wrap.block<3, 1>(1, column) +=
      object.R_BG * (changed.linear - motion.angular.cross(object.wrench.linear));
  wrap.block<3, 1>(4, column) +=
      object.frame.turnAxes.transpose() *
      (object.X_GC.R.transpose() * (moment - motion.angular.cross(object.moment)));
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
