#pragma once

// Template bodies of tree_energy.h.
#include <algorithm>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "bio/skeleton/tree_energy.h"

namespace bio {

namespace detail {

/// Whether all rates are 0; of dual numbers the derivatives need not be.
template <class T>
bool areAtRest(const T* v, int n) {
  if constexpr (std::is_same_v<T, double>) {
    return std::all_of(v, v + n, [](double rate) { return rate == 0; });
  } else {
    return false;
  }
}

/// TreeEnergy at rest: momenta and b are 0, and with them all derivatives of T but M.
/// @param inertia     one per segment with mass, overwritten
/// @param count       mobilities that move mass
/// @param out         0
template <int N, class T>
void energyAtRest(const ArticulatedTree& tree, const TreeMotion<T>& motion,
                  std::vector<SpatialInertia<T>>& inertia, std::size_t count,
                  EnergyDerivatives<N, T>& out) {
  const Eigen::Vector3d& g = tree.gravity();
  const Mobility* mobilities = tree.mobilities().data();
  T potential(0.0);
  for (std::size_t s = 1; s < inertia.size(); ++s) {
    const TreeSegment& segment = tree.segments()[s];
    inertia[s] =
        inertiaInGround(motion.segments[s], segment.mass, segment.massCenter, segment.inertia);
    const auto& massMoment = inertia[s].massMoment;
    potential -= g[0] * massMoment[0] + g[1] * massMoment[1] + g[2] * massMoment[2];
  }
  out.potential = potential;
  for (std::size_t s = inertia.size(); s-- > 1;) {
    const auto parent = static_cast<std::size_t>(tree.segments()[s].parent);
    if (parent != 0) inertia[parent] += inertia[s];
  }
  for (std::size_t j = 0; j < count; ++j) {
    const Mobility& mobility = mobilities[j];
    const int c = mobility.coordinate;
    const SpatialInertia<T>& I = inertia[static_cast<std::size_t>(mobility.segment)];
    const SpatialVector<T> F = I * motion.screw[j];
    const T d[3] = {F[3], F[4], F[5]};
    const T gd[3] = {g[1] * d[2] - g[2] * d[1], g[2] * d[0] - g[0] * d[2],
                     g[0] * d[1] - g[1] * d[0]};
    out.V_q[c] -= g[0] * d[0] + g[1] * d[1] + g[2] * d[2];
    if (!mobility.hasFixedScrew) {
      const SpatialVector<T> moved = I * motion.screw1[j];
      out.V_qq(c, c) -= g[0] * moved[3] + g[1] * moved[4] + g[2] * moved[5];
    }
    for (int k = static_cast<int>(j); k >= 0; k = mobilities[k].parent) {
      const SpatialVector<T>& S = motion.screw[static_cast<std::size_t>(k)];
      const T SF = dot(S, F), V_qq = S[0] * gd[0] + S[1] * gd[1] + S[2] * gd[2];
      const int e = mobilities[k].coordinate;
      out.T_vv(e, c) += SF;
      out.V_qq(e, c) += V_qq;
      if (k == static_cast<int>(j)) continue;
      out.T_vv(c, e) += SF;
      out.V_qq(c, e) += V_qq;
    }
  }
}

}  // namespace detail

template <int N, class T>
TreeEnergy<N, T>::TreeEnergy(const ArticulatedTree& tree) : tree_(&tree) {
  const int n = tree.numCoordinates();
  if (N != Eigen::Dynamic && N != n) {
    throw std::invalid_argument("number of coordinates is " + std::to_string(n) + ", must be " +
                                std::to_string(N));
  }
  std::size_t mobilities = 0;
  for (const Mobility& m : tree.mobilities()) mobilities += m.segment < tree.numMassSegments();
  const auto segments = static_cast<std::size_t>(tree.numMassSegments());
  const SpatialVector<T> zero = SpatialVector<T>::Zero();
  inner_.assign(mobilities, {zero, zero});
  before_.assign(mobilities, zero);
  velocity_.assign(segments, zero);
  momentum_.assign(segments, zero);
  inertia_.resize(segments);
  for (auto* x : {&out_.T_v, &out_.T_q, &out_.V_q}) x->resize(n);
  for (auto* X : {&out_.T_vv, &out_.T_vq, &out_.T_qq, &out_.V_qq}) X->resize(n, n);
}

template <int N, class T>
void TreeEnergy<N, T>::setZero() {
  out_.kinetic = T(0.0);
  out_.potential = T(0.0);
  for (auto* x : {&out_.T_v, &out_.T_q, &out_.V_q}) x->setZero();
  for (auto* X : {&out_.T_vv, &out_.T_vq, &out_.T_qq, &out_.V_qq}) X->setZero();
}

template <int N, class T>
const EnergyDerivatives<N, T>& TreeEnergy<N, T>::evaluate(const TreeMotion<T>& motion, const T* v) {
  setZero();
  if (tree_->hasConstantInertia()) {
    constantInertia(motion, v);
  } else if (detail::areAtRest(v, tree_->numCoordinates())) {
    detail::energyAtRest(*tree_, motion, inertia_, inner_.size(), out_);
  } else {
    outward(motion, v);
    inward();
    pairs(motion, v);
  }
  return out_;
}

// One turn or shift by q itself: T = ½M v² with M of this posture, the same in all.
template <int N, class T>
void TreeEnergy<N, T>::constantInertia(const TreeMotion<T>& motion, const T* v) {
  const TreeSegment& s = tree_->segments()[1];
  const SpatialVector<T>& S = motion.screw.front();
  const SpatialInertia<T> I = inertiaInGround(motion.segments[1], s.mass, s.massCenter, s.inertia);
  const SpatialVector<T> F = I * S;
  const T M = dot(S, F);
  out_.T_vv(0, 0) = M;
  out_.T_v[0] = M * v[0];
  out_.kinetic = 0.5 * (out_.T_v[0] * v[0]);
  // the linear part of F is Σ m ∂r
  const Eigen::Vector3d& g = tree_->gravity();
  T turned[3];
  detail::crossInto(S.data(), F.data() + 3, turned);
  for (int i = 0; i < 3; ++i) {
    out_.potential -= g[i] * I.massMoment[i];
    out_.V_q[0] -= g[i] * F[i + 3];
    out_.V_qq(0, 0) -= g[i] * turned[i];
  }
}

// From the ground outwards: velocities, b, and each segment's own inertia and momentum.
template <int N, class T>
void TreeEnergy<N, T>::outward(const TreeMotion<T>& motion, const T* v) {
  const Eigen::Vector3d& g = tree_->gravity();
  const auto& mobilities = tree_->mobilities();
  T kinetic(0.0), potential(0.0);
  for (std::size_t s = 1; s < velocity_.size(); ++s) {
    const TreeSegment& segment = tree_->segments()[s];
    SpatialVector<T> V = velocity_[static_cast<std::size_t>(segment.parent)];
    for (int m = segment.firstMobility; m <= segment.lastMobility; ++m) {
      const auto at = static_cast<std::size_t>(m);
      const SpatialVector<T>& S = motion.screw[at];
      const T& v_k = v[mobilities[at].coordinate];
      Inner& inner = inner_[at];
      inner.S = S;
      inner.b = crossMotion(S, V);
      if (!mobilities[at].hasFixedScrew) {
        for (int i = 0; i < 6; ++i) inner.b[i] -= motion.screw1[at][i] * v_k;
        before_[at] = V;
      }
      for (int i = 0; i < 6; ++i) V[i] += S[i] * v_k;
    }
    velocity_[s] = V;
    inertia_[s] =
        inertiaInGround(motion.segments[s], segment.mass, segment.massCenter, segment.inertia);
    momentum_[s] = inertia_[s] * V;
    const auto& massMoment = inertia_[s].massMoment;
    kinetic += 0.5 * dot(V, momentum_[s]);
    potential -= g[0] * massMoment[0] + g[1] * massMoment[1] + g[2] * massMoment[2];
  }
  out_.kinetic = kinetic;
  out_.potential = potential;
}

// From the ends inwards: inertia and momentum of everything beyond.
template <int N, class T>
void TreeEnergy<N, T>::inward() {
  for (std::size_t s = velocity_.size(); s-- > 1;) {
    const auto parent = static_cast<std::size_t>(tree_->segments()[s].parent);
    if (parent == 0) continue;
    inertia_[parent] += inertia_[s];
    momentum_[parent] += momentum_[s];
  }
}

template <int N, class T>
void TreeEnergy<N, T>::pairs(const TreeMotion<T>& motion, const T* v) {
  const Eigen::Vector3d& g = tree_->gravity();
  const Mobility* mobilities = tree_->mobilities().data();
  for (std::size_t j = 0; j < inner_.size(); ++j) {
    const Mobility& mobility = mobilities[j];
    const int c = mobility.coordinate;
    const auto segment = static_cast<std::size_t>(mobility.segment);
    const SpatialInertia<T>& I = inertia_[segment];
    const SpatialVector<T>& H = momentum_[segment];
    const SpatialVector<T>& S = inner_[j].S;
    const SpatialVector<T>& b = inner_[j].b;
    const SpatialVector<T> F = I * S;
    const SpatialVector<T> G = crossForce(S, H);
    const SpatialVector<T> B = I * b;
    SpatialVector<T> W;
    for (int i = 0; i < 6; ++i) W[i] = B[i] - G[i];
    out_.T_v[c] += dot(S, H);
    out_.T_q[c] -= dot(b, H);
    // d is the linear part of F; −g·(ω_k × d) = ω_k·(g × d)
    const T d[3] = {F[3], F[4], F[5]};
    const T gd[3] = {g[1] * d[2] - g[2] * d[1], g[2] * d[0] - g[0] * d[2],
                     g[0] * d[1] - g[1] * d[0]};
    out_.V_q[c] -= g[0] * d[0] + g[1] * d[1] + g[2] * d[2];
    if (!mobility.hasFixedScrew) bentScrew(motion, j, v[c], c);
    for (int k = static_cast<int>(j); k >= 0; k = mobilities[k].parent) {
      const Inner& inner = inner_[static_cast<std::size_t>(k)];
      const T SF = dot(inner.S, F), SW = dot(inner.S, W);
      const T bF = dot(inner.b, F), bW = dot(inner.b, W);
      const T V_qq = inner.S[0] * gd[0] + inner.S[1] * gd[1] + inner.S[2] * gd[2];
      const int e = mobilities[k].coordinate;
      out_.T_vv(e, c) += SF;
      out_.T_vq(c, e) -= bF;
      out_.T_qq(e, c) += bW;
      out_.V_qq(e, c) += V_qq;
      if (k == static_cast<int>(j)) continue;
      out_.T_vv(c, e) += SF;
      out_.T_vq(e, c) -= SW;
      out_.T_qq(c, e) += bW;
      out_.V_qq(c, e) += V_qq;
    }
  }
}

// What the change of a mobility's own screw adds to its diagonal.
template <int N, class T>
void TreeEnergy<N, T>::bentScrew(const TreeMotion<T>& motion, std::size_t j, const T& v, int c) {
  const auto segment = static_cast<std::size_t>(tree_->mobilities()[j].segment);
  const SpatialVector<T>& H = momentum_[segment];
  const SpatialVector<T>& D = motion.screw1[j];
  const SpatialVector<T> carried = crossMotion(D, before_[j]);
  const SpatialVector<T> moved = inertia_[segment] * D;
  const Eigen::Vector3d& g = tree_->gravity();
  out_.T_vq(c, c) += dot(D, H);
  out_.T_qq(c, c) += dot(motion.screw2[j], H) * v - dot(carried, H);
  out_.V_qq(c, c) -= g[0] * moved[3] + g[1] * moved[4] + g[2] * moved[5];
}

}  // namespace bio
