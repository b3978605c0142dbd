#pragma once

// Template bodies of articulated_tree.h.
#include <cmath>
#include <type_traits>

#include "bio/skeleton/articulated_tree.h"
#include "info/autodiff/dual.h"

namespace bio {
namespace detail {

/// φ(q) of an elementary motion with three derivatives.
template <class T>
struct AmountJet {
  T value, slope, curvature, third;
};

template <class T>
AmountJet<T> amountJet(const FunctionEvaluator& function, const T& x) {
  if constexpr (std::is_same_v<T, double>) {
    const CurveValue y = function.evaluate(x);
    return {y.value, y.slope, y.curvature, y.third};
  } else {
    const AmountJet<std::decay_t<decltype(x.value())>> y = amountJet(function, x.value());
    return {T(y.value, y.slope * x.derivatives()), T(y.slope, y.curvature * x.derivatives()),
            T(y.curvature, y.third * x.derivatives()), T(y.third)};
  }
}

/// φ(q) that is a line.
template <class T>
AmountJet<T> amountAlong(const FunctionEvaluator::Line& line, const T& q) {
  return {T(line.scale) * (T(line.value) + q * T(line.slope)), T(line.scale * line.slope), T(0.0),
          T(0.0)};
}

/// φ = amount(coupling(q)) by the chain rule to third order.
template <class T>
AmountJet<T> amountOf(const ElementaryMotion& motion, const T& q) {
  if (motion.coupling.isIdentity()) return amountJet(motion.amount, q);
  const AmountJet<T> i = amountJet(motion.coupling, q);
  const AmountJet<T> o = amountJet(motion.amount, i.value);
  const T square = i.slope * i.slope;
  return {o.value, o.slope * i.slope, o.curvature * square + o.slope * i.curvature,
          o.third * square * i.slope + 3.0 * (o.curvature * (i.slope * i.curvature)) +
              o.slope * i.third};
}

/// X ← X·before: the frame in which the turn or shift happens.
template <class T>
inline void placeBefore(const ElementaryMotion& motion, Placement<T>& X) {
  const auto& b = motion.before.p;
  for (int i = 0; i < 3; ++i) {
    X.p[i] += X.R(i, 0) * b[0] + X.R(i, 1) * b[1] + X.R(i, 2) * b[2];
  }
  if (motion.isPlacedStraight) return;
  const auto& B = motion.before.R;
  for (int i = 0; i < 3; ++i) {
    const T r0 = X.R(i, 0), r1 = X.R(i, 1), r2 = X.R(i, 2);
    for (int j = 0; j < 3; ++j) X.R(i, j) = r0 * B(0, j) + r1 * B(1, j) + r2 * B(2, j);
  }
}

/// X ← X·(turn or shift), and its screw per unit of amount.
template <class T>
inline SpatialVector<T> applyMotion(const ElementaryMotion& motion, const T& amount,
                                    Placement<T>& X) {
  using std::cos;
  using std::sin;
  SpatialVector<T> S;
  if (motion.turns) {
    for (int i = 0; i < 3; ++i) S[i] = X.R(i, 2);
    detail::crossInto(X.p.data(), S.data(), S.data() + 3);
    const T c = cos(amount), s = sin(amount);
    for (int i = 0; i < 3; ++i) {
      const T x = X.R(i, 0), y = X.R(i, 1);
      X.R(i, 0) = c * x + s * y;
      X.R(i, 1) = c * y - s * x;
    }
  } else {
    const auto& a = motion.axis;
    for (int i = 0; i < 3; ++i) {
      S[i] = T(0.0);
      S[i + 3] = X.R(i, 0) * a[0] + X.R(i, 1) * a[1] + X.R(i, 2) * a[2];
      X.p[i] += S[i + 3] * amount;
    }
  }
  return S;
}

}  // namespace detail

template <class T>
TreeMotion<T> ArticulatedTree::newMotion() const {
  TreeMotion<T> motion;
  motion.segments.resize(segments_.size());
  const SpatialVector<T> zero = SpatialVector<T>::Zero();
  motion.screw.assign(mobilities_.size(), zero);
  motion.screw1.assign(mobilities_.size(), zero);
  motion.screw2.assign(mobilities_.size(), zero);
  return motion;
}

template <class T>
void ArticulatedTree::place(const T* q, TreeMotion<T>& out) const {
  const ElementaryMotion* motion = motions_.data();
  const Mobility* mobility = mobilities_.data();
  for (std::size_t s = 1; s < segments_.size(); ++s) {
    const TreeSegment& segment = segments_[s];
    Placement<T> X = out.segments[static_cast<std::size_t>(segment.parent)];
    for (int m = segment.firstMobility; m <= segment.lastMobility; ++m, ++mobility) {
      const auto at = static_cast<std::size_t>(m);
      const T& q_k = q[mobility->coordinate];
      if (mobility->hasFixedScrew) {
        detail::placeBefore(*motion, X);
        if (motion->isIdentity) {
          out.screw[at] = detail::applyMotion(*motion, q_k, X);
        } else {
          const detail::AmountJet<T> phi = detail::amountAlong(*motion->line, q_k);
          const SpatialVector<T> S = detail::applyMotion(*motion, phi.value, X);
          for (int i = 0; i < 6; ++i) out.screw[at][i] = phi.slope * S[i];
        }
        ++motion;
        continue;
      }
      SpatialVector<T> S = SpatialVector<T>::Zero(), D = S, D1 = S;
      bool hasTurned = false;
      for (int f = 0; f < mobility->numMotions; ++f, ++motion) {
        detail::placeBefore(*motion, X);
        const detail::AmountJet<T> phi = motion->isIdentity
                                             ? detail::AmountJet<T>{q_k, T(1.0), T(0.0), T(0.0)}
                                         : motion->line ? detail::amountAlong(*motion->line, q_k)
                                                        : detail::amountOf(*motion, q_k);
        const SpatialVector<T> S_f = detail::applyMotion(*motion, phi.value, X);
        // what comes first, and shifts after shifts, nothing turns
        if (!(motion->turns ? f > 0 : hasTurned)) {
          hasTurned = motion->turns;
          for (int i = motion->turns ? 0 : 3; i < 6; ++i) {
            D1[i] += phi.third * S_f[i];
            D[i] += phi.curvature * S_f[i];
            S[i] += phi.slope * S_f[i];
          }
          continue;
        }
        hasTurned = hasTurned || motion->turns;
        // S_f is carried by the motions before it: S_f′ = S × S_f, S_f″ = D × S_f + S × (S × S_f)
        const SpatialVector<T> first = crossMotion(S, S_f);
        const SpatialVector<T> second = crossMotion(D, S_f) + crossMotion(S, first);
        for (int i = 0; i < 6; ++i) {
          D1[i] += phi.third * S_f[i] + 2.0 * (phi.curvature * first[i]) + phi.slope * second[i];
          D[i] += phi.curvature * S_f[i] + phi.slope * first[i];
          S[i] += phi.slope * S_f[i];
        }
      }
      out.screw[at] = S;
      out.screw1[at] = D;
      out.screw2[at] = D1;
    }
    out.segments[s] = X;
  }
}

}  // namespace bio
