#pragma once

#include <Eigen/Dense>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "bio/model/model.h"
#include "bio/muscle/curves/curves.h"
#include "bio/skeleton/skeleton.h"

namespace bio {

/// A screw, its derivative, or a moment and force, about the ground's origin: (ω, s) or (n, f), as
/// SpatialVector orders them.
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// How a segment moves in a posture: what forces on it need.
struct MovingSegment {
  std::size_t segment = 0;  ///< of the skeleton
  Placement<double> X;      ///< in the ground
  std::vector<Vector6> S;   ///< ∂_j as a screw, one per free coordinate
  std::vector<Vector6> dS;  ///< ∂_kS_j at j·n + k

  /// ∂_j of a point of the segment that is at x.
  Eigen::Vector3d moves(std::size_t j, const Eigen::Vector3d& x) const {
    return S[j].tail<3>() + S[j].head<3>().cross(x);
  }
};

/// Where body forces are summed.
struct BodyForceSums {
  Eigen::Ref<Eigen::VectorXd> passive;  ///< += springs, bushings
  Eigen::Ref<Eigen::MatrixXd> passive_q;
  Eigen::Ref<Eigen::MatrixXd> passive_v;
  Eigen::Ref<Eigen::VectorXd> load;  ///< += loads
  Eigen::Ref<Eigen::MatrixXd> load_q;
  Eigen::Ref<Eigen::VectorXd> load_t;  ///< += ∂/∂t of the loads
};

/// Nine numbers of time: force, point and torque of a BodyLoad.
class LoadCourse {
 public:
  /// @throws std::invalid_argument times that do not rise, rows that do not fit, a number that is
  ///   not finite
  explicit LoadCourse(const BodyLoad& load);

  struct At {
    std::array<double, 9> value{}, slope{};  ///< per second
  };
  /// 0 outside the table.
  At at(double t) const;
  double begin() const { return begin_; }  ///< [s]
  double end() const { return end_; }      ///< [s]

 private:
  std::vector<FunctionEvaluator> functions_;
  std::vector<PiecewiseCubic> splines_;
  double begin_, end_;
};

/// Forces on bodies that are neither muscles nor forces on coordinates: loads that a table or
/// functions of time prescribe, springs between points, bushings.
///
/// A moment and force W on a segment with screws S_j give Σ W·S_j; over the coordinates
///     ∂_k(W·S_j) = ∂_kW·S_j + W·∂_kS_j
/// where ∂_kW follows the frames in which W and its point are given. Exact.
class BodyForces {
 public:
  /// Forces between bodies that do not move against each other are left out.
  /// @throws std::invalid_argument an unknown body; what LoadCourse throws
  BodyForces(const Model& model, const Skeleton& skeleton);

  bool empty() const { return loads_.empty() && springs_.empty() && bushings_.empty(); }
  /// The segments whose motion add() needs, in its order; a copy to be kept up to date.
  std::vector<MovingSegment> segments() const { return segments_; }

  /// Adds all forces with their derivatives. `v`: the coordinates' speeds.
  void add(double t, const std::vector<MovingSegment>& segments, const Eigen::VectorXd& v,
           BodyForceSums& sums) const;

  /// Whether a spring or a bushing of the model, by its place in its list, is among them.
  bool hasSpring(std::size_t index) const;
  bool hasBushing(std::size_t index) const;
  /// ∂τ/∂θ, one row per free coordinate: in stiffness and rest length of a spring; in rotational
  /// and translational stiffness, rotational and translational damping (x, y, z each) of a bushing.
  void springInNumbers(std::size_t index, const std::vector<MovingSegment>& segments,
                       Eigen::MatrixXd& tau) const;
  void bushingInNumbers(std::size_t index, const std::vector<MovingSegment>& segments,
                        const Eigen::VectorXd& v, Eigen::MatrixXd& tau) const;

 private:
  struct Load {
    std::size_t on, forceFrame, pointFrame;  ///< places in segments_
    Placement<double> X_force, X_point;      ///< body in its segment
    LoadCourse course;
  };
  struct Spring {
    std::size_t index;  ///< in the model's list
    std::array<std::size_t, 2> segment;
    std::array<Eigen::Vector3d, 2> point;  ///< in the segment
    double stiffness, restLength;
  };
  struct Bushing {
    std::size_t index;  ///< in the model's list
    std::array<std::size_t, 2> segment;
    std::array<Placement<double>, 2> frame;  ///< in the segment
    Vector6 stiffness, damping;
  };
  std::size_t placeOf(std::size_t segment, int numCoordinates);
  void addLoad(const Load& load, double t, const std::vector<MovingSegment>& segments,
               BodyForceSums& sums) const;
  void addSpring(const Spring& spring, const std::vector<MovingSegment>& segments,
                 BodyForceSums& sums) const;
  void addBushing(const Bushing& bushing, const std::vector<MovingSegment>& segments,
                  const Eigen::VectorXd& v, BodyForceSums& sums) const;

  std::vector<MovingSegment> segments_;
  std::vector<Load> loads_;
  std::vector<Spring> springs_;
  std::vector<Bushing> bushings_;
};

/// The tension of an elastic path with derivatives.
struct PathTension {
  double force = 0;           ///< F [N] ≥ 0
  double dForce_dLength = 0;  ///< [N/m]
  double dForce_dSpeed = 0;   ///< [N s/m]
};

/// A compiled ElasticPath's law; C⁰ at its rest length.
class ElasticPathLaw {
 public:
  /// @throws std::invalid_argument a rest length or transition strain that is not > 0
  explicit ElasticPathLaw(const ElasticPath& path);
  /// @param length L [m]
  /// @param speed  L̇ [m/s]
  PathTension tension(double length, double speed) const;
  /// ∂F/∂θ there, in this order: rest length, scale, damping, transition strain.
  std::array<double, 4> inNumbers(double length, double speed) const;

 private:
  ElasticPathKind kind_;
  double restLength_, scale_, damping_, transition_;
  FunctionEvaluator curve_;
};

}  // namespace bio
