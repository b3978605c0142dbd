#pragma once

#include <Eigen/Dense>
#include <vector>

#include "bio/sensitivity/coupled_sensitivity.h"
#include "bio/tables/observable.h"

namespace bio {

/// An observable at the times at which it is wanted.
struct ObservedSeries {
  Observable what;
  Eigen::VectorXd times;  ///< [s] rising
};

/// Observables of simulated motions at any times, with their sensitivities; series after series.
///
/// Coordinates, their speeds and markers follow from the cubic of Hermite between rows of the
/// motion, whose error falls with the fourth (speeds: third) power of the step; moments, fibre
/// lengths, pennation, tendon forces and activations are linear between rows, with an error that
/// falls with the square of the step like that of the integrator.
class ObservedMotion {
 public:
  /// @throws std::invalid_argument for a coordinate that is not free, a moment at a coordinate that
  ///   is not prescribed, a muscle that is not simulated, a marker that the model does not have
  ObservedMotion(const MusculoskeletalSystem& system, std::vector<ObservedSeries> series);

  const std::vector<ObservedSeries>& series() const { return series_; }
  Eigen::Index size() const { return size_; }
  /// Options that the sensitivities need of simulateWithSensitivities().
  bool needsMuscles() const { return needsMuscles_; }
  bool needsReactions() const { return needsReactions_; }

  /// In unitOf(); NaN at times that the motion has not reached.
  Eigen::VectorXd values(const Trajectory& motion) const;

  struct Linearised {
    Eigen::VectorXd values;
    Eigen::MatrixXd gamma;  ///< d(values)/dθ: size() × parameters
  };
  /// @param motion with what needsMuscles() and needsReactions() ask for
  Linearised linearised(const SensitivityTrajectory& motion) const;

  /// Transposed: with λ = ∂J/∂(values), sets ∂J/∂q and ∂J/∂q̇ at the rows of the motion, free
  /// coordinates × rows. Coordinates, speeds and markers only.
  /// @throws std::invalid_argument as requireAdjoint(); λ not of size()
  void pullBack(const Trajectory& motion, const Eigen::VectorXd& lambda, Eigen::MatrixXd& q,
                Eigen::MatrixXd& qDot) const;
  /// @throws std::invalid_argument names the first observable that pullBack() does not have
  void requireAdjoint() const;

 private:
  /// @param s  of the motion; null: values only
  Linearised evaluate(const Trajectory& motion, const SensitivityTrajectory* s) const;
  void addMarker(const ObservedSeries& series, const SystemMarker& marker, const Trajectory& motion,
                 const SensitivityTrajectory* s, Eigen::Index first, Linearised& all) const;
  void pullMarkerBack(const ObservedSeries& series, const SystemMarker& marker,
                      const Trajectory& motion, const Eigen::Ref<const Eigen::VectorXd>& lambda,
                      Eigen::MatrixXd& q, Eigen::MatrixXd& qDot) const;

  const MusculoskeletalSystem* system_;
  std::vector<ObservedSeries> series_;
  std::vector<int> sources_;  ///< index of the coordinate, muscle or marker of each series
  Eigen::Index size_ = 0;
  bool needsMuscles_ = false, needsReactions_ = false;
};

}  // namespace bio
