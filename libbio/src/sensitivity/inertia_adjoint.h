#pragma once

// A scalar's derivatives in masses and gravity, gathered along a motion; not public.

#include <algorithm>

#include "bio/skeleton/skeleton_motion.h"
#include "sensitivity/parameter_effects.h"
#include "simulation/integrators.h"

namespace bio::stepping {

/// Gathers a·∂_θ(M v) + b·∂_θ(½ vᵀ∂M v − ∂V) over any number of postures, for all masses at once.
///
/// Both are linear in the second moments P = Σ m (r, 1)(r, 1)ᵀ of a segment. With X = (R, p) its
/// placement, Ẋ = Σ v_l ∂_lX and Ẋ_k = Σ v_l ∂_klX they are tr(W P) with
///     W = (Σ a_k ∂_kX + b_k Ẋ_k)ᵀ Ẋ + (0, (Σ b_k ∂_kX)ᵀ g)
/// so that W is all that has to be kept of a segment. On a tree the fields come from screws:
/// ∂_kX = S_k^X, where (ω, s)^X = (ω×R, ω×p + s).
template <int N>
class InertiaAdjoint {
 public:
  using Index = Eigen::Index;
  using Vector = Eigen::Matrix<double, N, 1>;
  using Field = Eigen::Matrix<double, 3, 4>;

  InertiaAdjoint(const MusculoskeletalSystem& system, const ParameterEffects& effects,
                 const SystemConfiguration<N>& configuration)
      : system_(system), effects_(effects), configuration_(configuration) {
    for (const auto& effect : effects.segments) {
      const auto have = [&](const OfSegment& segment) { return segment.segment == effect.segment; };
      if (std::none_of(segments_.begin(), segments_.end(), have)) {
        segments_.push_back({effect.segment, wayTo(effect.segment)});
      }
    }
    if (effects.gravity.empty()) return;
    for (std::size_t s = 1; s < system.skeleton().numSegments(); ++s) {
      massive_.push_back({s, wayTo(s)});
    }
  }

  /// At the configuration's posture and a speed v.
  void add(const Vector& v, const Vector& a, const Vector& b) {
    Field A, B, dX;
    for (OfSegment& segment : segments_) {
      fields(segment, v, a, b, dX, A, B);
      segment.W.noalias() += A.transpose() * dX;
      segment.W.col(3).noalias() += B.transpose() * system_.skeleton().gravity();
    }
    for (const OfSegment& one : massive_) {
      fields(one, v, a, b, dX, A, B);
      const Segment& segment = system_.skeleton().segments()[one.segment];
      gravity_ += B.leftCols<3>() * segment.massMoment + B.col(3) * segment.mass;
    }
  }

  /// Adds what was gathered to the parameters' derivatives.
  void addTo(Eigen::VectorXd& gradient) const {
    for (const auto& effect : effects_.segments) {
      for (const OfSegment& segment : segments_) {
        if (segment.segment != effect.segment) continue;
        Eigen::Matrix4d P;
        P.topLeftCorner<3, 3>() = effect.change.secondMoment;
        P.topRightCorner<3, 1>() = effect.change.massMoment;
        P.bottomLeftCorner<1, 3>() = effect.change.massMoment.transpose();
        P(3, 3) = effect.change.mass;
        gradient[effect.column] += segment.W.cwiseProduct(P).sum();
      }
    }
    for (const QuantityEffect& effect : effects_.gravity) {
      gradient[effect.column] += effect.factor * gravity_[static_cast<Index>(effect.quantity)];
    }
  }

 private:
  struct OfSegment {
    std::size_t segment;
    std::vector<std::size_t> way;  ///< mobilities from the ground to it, of a tree
    Eigen::Matrix4d W = Eigen::Matrix4d::Zero();
  };

  std::vector<std::size_t> wayTo(std::size_t segment) const {
    std::vector<std::size_t> way;
    if constexpr (N == Eigen::Dynamic) {
      const ArticulatedTree& tree = *system_.tree();
      for (int m = tree.mobilityOf(configuration_.places().segmentOf(segment)); m >= 0;) {
        way.push_back(static_cast<std::size_t>(m));
        m = tree.mobilities()[static_cast<std::size_t>(m)].parent;
      }
      std::reverse(way.begin(), way.end());
    }
    return way;
  }

  /// Ẋ, Σ a_k ∂_kX + b_k Ẋ_k and Σ b_k ∂_kX
  void fields(const OfSegment& segment, const Vector& v, const Vector& a, const Vector& b,
              Field& dX, Field& A, Field& B) const {
    dX.setZero();
    A.setZero();
    B.setZero();
    if constexpr (N == Eigen::Dynamic) {
      const TreeMotion<double>& motion = configuration_.motion();
      SpatialVector<double> V = SpatialVector<double>::Zero(), inA = V, inB = V;
      for (const std::size_t m : segment.way) {
        const Index k = system_.tree()->mobilities()[m].coordinate;
        // how the screw is carried along, with the sign of addTreeInertia
        const SpatialVector<double> bent = crossMotion(motion.screw[m], V);
        for (int i = 0; i < 6; ++i) {
          inA[i] += a[k] * motion.screw[m][i] - b[k] * (bent[i] - motion.screw1[m][i] * v[k]);
          inB[i] += b[k] * motion.screw[m][i];
          V[i] += motion.screw[m][i] * v[k];
        }
      }
      const Placement<double> X = configuration_.placement(segment.segment);
      dX = fieldOf(V, X);
      A = fieldOf(inA, X);
      B = fieldOf(inB, X);
    } else {
      const RigidMotion<double, N>& X = configuration_.motions()[segment.segment];
      const auto enter = [](Field& field, double factor, const Placement<double>& change) {
        field.leftCols<3>() += factor * change.R;
        field.col(3) += factor * change.p;
      };
      for (int k = 0; k < N; ++k) {
        const Placement<double>& X_k = X.first[static_cast<std::size_t>(k)];
        enter(dX, v[k], X_k);
        enter(A, a[k], X_k);
        enter(B, b[k], X_k);
        for (int l = 0; l < N; ++l) {
          enter(A, b[k] * v[l], X.second[static_cast<std::size_t>(pairIndex(k, l))]);
        }
      }
    }
  }

  static Field fieldOf(const SpatialVector<double>& screw, const Placement<double>& X) {
    const Eigen::Vector3d turn(screw[0], screw[1], screw[2]), shift(screw[3], screw[4], screw[5]);
    Field field;
    for (int i = 0; i < 3; ++i) field.col(i) = turn.cross(X.R.col(i));
    field.col(3) = turn.cross(X.p) + shift;
    return field;
  }

  const MusculoskeletalSystem& system_;
  const ParameterEffects& effects_;
  const SystemConfiguration<N>& configuration_;
  std::vector<OfSegment> segments_;  ///< those with parameters
  std::vector<OfSegment> massive_;   ///< all, if gravity is a parameter
  Eigen::Vector3d gravity_ = Eigen::Vector3d::Zero();
};

}  // namespace bio::stepping
