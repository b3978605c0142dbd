#pragma once

// Template bodies of point_path.h, which includes it.
#include <algorithm>
#include <cmath>

#include "bio/path/point_path.h"

namespace bio {

template <class T>
SupportedLength<T> PointPath::newLength() const {
  SupportedLength<T> out;
  const auto k = static_cast<Eigen::Index>(support_.size());
  out.first.resize(k);
  out.second.resize(k, k);
  std::size_t steps = 0;
  for (const Piece& piece : pieces_) steps = std::max(steps, piece.chain.steps().size());
  out.moves.resize(2 * steps);
  out.slotMoves.resize(2 * support_.size());
  return out;
}

template <class T>
void PointPath::evaluate(const TreeMotion<T>& motion, SupportedLength<T>& out) const {
  using std::sqrt;
  out.length = T(constantLength_);
  out.first.setZero();
  out.second.setZero();
  const Vec3<T> zero = Vec3<T>::Zero();
  for (const Piece& piece : pieces_) {
    const Vec3<T> a = stationInGround(motion, piece.from);
    const Vec3<T> b = stationInGround(motion, piece.to);
    const Vec3<T> apart = b - a;
    const T length = sqrt(T(apart.squaredNorm()));
    const T perLength = 1.0 / length;
    const Vec3<T> t = apart * perLength;
    out.length += length;

    // movement of b by each coordinate of this piece, and t·u
    const SegmentChain& chain = piece.chain;
    const auto& steps = chain.steps();
    chainMoves(chain, motion, b, out.moves.data());
    Vec3<T>* u = out.slotMoves.data();
    for (const int slot : piece.slots) u[slot] = zero;
    for (std::size_t j = 0; j < steps.size(); ++j) u[steps[j].slot] += out.moves[j];
    for (const int i : piece.slots) {
      const T along = t.dot(u[i]);
      out.first[i] += along;
      u[i] -= t * along;  // what is left lies across the piece
    }
    for (const int i : piece.slots) {
      for (const int j : piece.slots) out.second(i, j) += u[i].dot(u[j]) * perLength;
    }
    addSecondsAlong(chain, motion, b, out.moves.data(), t, out.second);
  }
}

template <class T>
void addSpan(const SpanToSecondOrder<T>& span, const Placement<T>& X_GC, const SegmentChain& toP,
             const Vec3<T>& p_GP, const SegmentChain& toQ, const Vec3<T>& p_GQ,
             const TreeMotion<T>& motion, SupportedLength<T>& out) {
  const Mat3<T>& R = X_GC.R;
  const auto k = static_cast<std::size_t>(out.first.size());
  Vec3<T>* u = out.slotMoves.data();
  Vec3<T>* w = u + k;
  for (std::size_t i = 0; i < 2 * k; ++i) u[i].setZero();
  Vec3<T>* movesP = out.moves.data();
  Vec3<T>* movesQ = movesP + toP.steps().size();
  chainMoves(toP, motion, p_GP, movesP);
  chainMoves(toQ, motion, p_GQ, movesQ);
  for (std::size_t j = 0; j < toP.steps().size(); ++j) u[toP.steps()[j].slot] += movesP[j];
  for (std::size_t j = 0; j < toQ.steps().size(); ++j) w[toQ.steps()[j].slot] += movesQ[j];

  out.length += span.span.length;
  const Vec3<T> g_P = R * span.span.dL_dP, g_Q = R * span.span.dL_dQ;
  for (std::size_t i = 0; i < k; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    out.first[row] += g_P.dot(u[i]) + g_Q.dot(w[i]);
    // change of both gradients as coordinate i moves both ends, in C
    const Vec3<T> u_C = R.transpose() * u[i], w_C = R.transpose() * w[i];
    const Vec3<T> gP_i = R * Vec3<T>(span.hessian.d2L_dPdP * u_C + span.hessian.d2L_dPdQ * w_C);
    const Vec3<T> gQ_i =
        R * Vec3<T>(span.hessian.d2L_dPdQ.transpose() * u_C + span.hessian.d2L_dQdQ * w_C);
    for (std::size_t j = 0; j < k; ++j) {
      out.second(row, static_cast<Eigen::Index>(j)) += gP_i.dot(u[j]) + gQ_i.dot(w[j]);
    }
  }
  addSecondsAlong(toP, motion, p_GP, movesP, g_P, out.second);
  addSecondsAlong(toQ, motion, p_GQ, movesQ, g_Q, out.second);
}

}  // namespace bio
