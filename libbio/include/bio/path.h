#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "bio/model.h"
#include "bio/rigid_motion.h"
#include "bio/skeleton.h"

namespace bio {

/// A muscle–tendon length and how it follows N free coordinates.
template <int N>
struct LengthJet {
  double length = 0;                      ///< ℓ_MT [m]
  Eigen::Matrix<double, N, 1> dL_dq;      ///< [m/rad]; the moment arm is its negative
  Eigen::Matrix<double, N, N> d2L_dq2;    ///< [m/rad²]
  bool wrapped = false;                   ///< a moving span touches a wrap object
};

/// The path of one muscle, compiled for a skeleton: the constant length of the spans that cannot
/// move, and the spans that do. Evaluation is pure and allocates nothing.
class MusclePath {
 public:
  MusclePath(const Model& model, const Skeleton& skeleton, const Muscle& muscle,
             const std::vector<std::string>& wrapAsCylinder);

  /// False if no free coordinate changes the length.
  bool moves() const;
  /// One line each: wraps of fixed spans taken as straight, wraps out of reach.
  const std::vector<std::string>& notes() const;

  /// `moved` is what Skeleton::motions(q, ·) returned.
  template <int N>
  LengthJet<N> length(const Eigen::Matrix<double, N, 1>& q,
                      const RigidMotion<double, N>* moved) const;
};

}  // namespace bio
