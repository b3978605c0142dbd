#pragma once

// Forces of a system that are neither muscles' nor on single coordinates; not public.

#include "simulation/coordinate_sums.h"

namespace bio::stepping {

/// Brings segments to where a configuration has them: with ω_i× = ∂_iR Rᵀ and s_i = ∂_ip − ω_i × p
///     ∂_kω_i× = ∂_ikR Rᵀ − ω_i× ω_k×,   ∂_ks_i = ∂_ikp − ∂_kω_i × p − ω_i × ∂_kp
template <int N>
void moveSegments(const MusculoskeletalSystem&, const SystemConfiguration<N>& configuration,
                  std::vector<MovingSegment>& segments) {
  const auto axisOf = [](const Eigen::Matrix3d& cross) {
    return Eigen::Vector3d(cross(2, 1), cross(0, 2), cross(1, 0));
  };
  for (MovingSegment& segment : segments) {
    const RigidMotion<double, N>& m = configuration.motions()[segment.segment];
    segment.X = m.value;
    for (std::size_t i = 0; i < N; ++i) {
      const Eigen::Matrix3d cross = m.first[i].R * m.value.R.transpose();
      const Eigen::Vector3d w = axisOf(cross);
      segment.S[i] << w, m.first[i].p - w.cross(m.value.p);
      for (std::size_t k = 0; k < N; ++k) {
        const Placement<double>& second =
            m.second[static_cast<std::size_t>(pairIndex(static_cast<int>(i), static_cast<int>(k)))];
        const Eigen::Matrix3d cross_k = m.first[k].R * m.value.R.transpose();
        const Eigen::Vector3d w_k = axisOf(second.R * m.value.R.transpose() - cross * cross_k);
        segment.dS[i * N + k] << w_k, second.p - w_k.cross(m.value.p) - w.cross(m.first[k].p);
      }
    }
  }
}
void moveSegments(const MusculoskeletalSystem& system,
                  const SystemConfiguration<Eigen::Dynamic>& configuration,
                  std::vector<MovingSegment>& segments);

/// Loads, springs, bushings and elastic paths of a system, evaluated in one configuration after the
/// other; holds what that needs.
template <int N>
class OtherForces {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;

  explicit OtherForces(const MusculoskeletalSystem& system)
      : system_(&system),
        isAny_(!system.bodyForces().empty() || !system.elasticPaths().empty()),
        segments_(system.bodyForces().segments()),
        load_(Vector::Zero(countOf<N>(system))),
        load_t_(load_),
        along_(load_),
        load_q_(Matrix::Zero(countOf<N>(system), countOf<N>(system))) {}

  bool any() const { return isAny_; }

  /// Adds what is passive, with its derivatives over q and v; finds the loads.
  void add(double t, const SystemConfiguration<N>& configuration, const Vector& v, Vector& passive,
           Matrix& passive_q, Matrix& passive_v) {
    load_.setZero();
    load_t_.setZero();
    load_q_.setZero();
    if (!segments_.empty()) {
      moveSegments(*system_, configuration, segments_);
      speeds_ = v;
      BodyForceSums sums{passive, passive_q, passive_v, load_, load_q_, load_t_};
      system_->bodyForces().add(t, segments_, speeds_, sums);
    }
    for (std::size_t i = 0; i < system_->elasticPaths().size(); ++i) {
      const LengthJet<N>& path = configuration.length(system_->numMuscles() + i);
      const PathTension r = system_->elasticPaths()[i].law.tension(path.length, path.dL_dq.dot(v));
      addAlong<N>(passive, -r.force, path);
      along_ = r.dForce_dLength * path.dL_dq;
      addSecondTimes<N>(along_, r.dForce_dSpeed, path, v);
      passive_q.noalias() -= path.dL_dq * along_.transpose();
      addSecond<N>(passive_q, -r.force, path);
      addOuter<N>(passive_v, -r.dForce_dSpeed, path);
    }
  }

  const Vector& load() const { return load_; }      ///< of the last add()
  const Matrix& load_q() const { return load_q_; }  ///< ∂load/∂q
  const Vector& load_t() const { return load_t_; }  ///< ∂load/∂t

 private:
  const MusculoskeletalSystem* system_;
  bool isAny_;
  std::vector<MovingSegment> segments_;
  Eigen::VectorXd speeds_;
  Vector load_, load_t_, along_;
  Matrix load_q_;
};

}  // namespace bio::stepping
