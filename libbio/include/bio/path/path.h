#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "bio/model/model.h"
#include "bio/path/compiled_path.h"
#include "bio/path/path_table.h"
#include "bio/skeleton/rigid_motion.h"
#include "bio/skeleton/skeleton.h"

namespace bio {

/// A muscle–tendon length and its derivatives with respect to N free coordinates.
template <int N, class T = double>
struct LengthJet {
  T length = T(0.0);               ///< ℓ_MT [m]
  Eigen::Matrix<T, N, 1> dL_dq;    ///< [m/rad]; the moment arm is its negative
  Eigen::Matrix<T, N, N> d2L_dq2;  ///< [m/rad²]
  bool wrapped = false;            ///< a moving span touches a wrap object
};

/// The parameters of a path with respect to which derivatives are available.
template <class T>
struct PathParameters {
  std::vector<Vec3<T>>
      points;  ///< of Path::points, in their bodies' frames [m]; moving points keep their functions
  std::vector<T> radii;  ///< of Path::wraps [m]; unused for a wrap that is left out
};

/// A value of a free coordinate at which a path gains or loses conditional points: its length jumps
/// there, slightly if the model is well constructed.
struct PathSwitch {
  int freeIndex = 0;
  FunctionEvaluator coupling{identityFunction()};  ///< of the condition's coordinate from q_k
  double value = 0;                                ///< of the condition's coordinate [rad] or [m]

  /// Changes sign at the switch.
  double distance(double q_k) const { return coupling.evaluate(q_k).value - value; }
};

/// The path of one muscle, compiled for a skeleton: the constant length of the fixed spans, and the
/// moving spans. Evaluation is pure and does not allocate.
///
/// A span is straight, passes over one cylinder or sphere, or over a chain of wrap objects that are
/// solved together (path_chain.h): those that it touches at once, ellipsoids and tori. An object is
/// used by the first span that touches it. The side of an object on which a span passes is decided
/// once, at construction (wrap_rule.h), from the default posture and the coordinates' ranges.
/// Between switches of conditional points the length is C¹ as long as a chain keeps its way.
///
/// A path may also be a function of coordinates (length_function.h), in place of points and spans.
///
/// Departures from OpenSim: paths over wrap objects are exact geodesics; over spheres and cylinders
/// they never change sides, but slip off a cylinder where they would wrap the long way round
/// (wrap_rule.h); and an object that no span touches within the coordinates' ranges, and in whose
/// radius no span end lies, is ignored.
class MusclePath {
 public:
  /// @param wrapAsCylinder names of ellipsoids with two equal semi-axes to be treated as cylinders
  ///   about the third axis
  /// @throws UnsupportedWrap for a span over more than maxChain objects at once, or over objects
  ///   over which no taut string is found in any posture
  /// @throws std::invalid_argument for an ellipsoid in wrapAsCylinder without two equal semi-axes,
  ///   names that the model lacks, a path that has less than two points in some posture
  MusclePath(const Model& model, const Skeleton& skeleton, const Muscle& muscle,
             const std::vector<std::string>& wrapAsCylinder);
  /// The path of one of many muscles, with postures = PostureSamples(…).of(muscle).
  MusclePath(const Model& model, const Skeleton& skeleton, const Muscle& muscle,
             const std::vector<std::string>& wrapAsCylinder, const std::vector<Posture>& postures);

  /// False if no free coordinate changes the length.
  bool moves() const;
  /// One line each: wraps of fixed spans that are treated as straight, wraps out of reach.
  const std::vector<std::string>& notes() const { return compiled_.notes; }
  /// One line each: spans over which no taut string is found in some postures.
  const std::vector<std::string>& warnings() const { return compiled_.warnings; }
  /// Whether the length is a function of coordinates: then there is nothing to draw.
  bool isFunction() const { return compiled_.function.has_value(); }
  /// Coordinate values at which conditional points switch.
  std::vector<PathSwitch> switches() const;
  /// The data used for evaluation.
  const CompiledPath& compiled() const { return compiled_; }

  /// Lets length<1> use a table (path_table.h) over the range of the one free coordinate and a
  /// tenth of it on either side; copies share it. Does nothing if the skeleton has more
  /// coordinates, or the coordinate has no range.
  void tabulate(const Skeleton& skeleton);
  /// Null unless tabulated.
  const PathTable* table() const { return table_.get(); }

  /// `moved` is what Skeleton::motions(q, ·) returned.
  /// @param conditionsAt  the configuration whose conditional points are active; null: q
  template <int N>
  LengthJet<N> length(const Eigen::Matrix<double, N, 1>& q, const RigidMotion<double, N>* moved,
                      const Eigen::Matrix<double, N, 1>* conditionsAt = nullptr) const;

  /// The parameter values of the model.
  const PathParameters<double>& parameters() const { return parameters_; }

  /// length for other parameters, with all spans recomputed; T is double or an AD scalar.
  template <class T, int N>
  LengthJet<N, T> length(const PathParameters<T>& parameters, const Eigen::Matrix<T, N, 1>& q,
                         const RigidMotion<T, N>* moved) const;

  /// The path in ground as a polyline, for pictures: every active point, and on wrap objects points
  /// at most `step` [rad] apart along the arc. Empty for a function of coordinates.
  template <int N>
  std::vector<Eigen::Vector3d> pathPoints(const Eigen::Matrix<double, N, 1>& q,
                                          const RigidMotion<double, N>* moved,
                                          double step = 0.1) const;
  /// The polyline for any number of coordinates.
  std::vector<Eigen::Vector3d> pathPoints(const Posture& posture, double step = 0.1) const;
  /// Which of Path::wraps the path touches, moving spans or not, rising.
  std::vector<std::size_t> touchedWraps(const Posture& posture) const;

 private:
  std::vector<Eigen::Vector3d> trace(const Posture& posture, double step, unsigned& used) const;

  CompiledPath compiled_;
  PathParameters<double> parameters_;
  std::shared_ptr<const PathTable> table_;
};

// Compiled once; other sizes and scalars need bio/path/path_length.h.
extern template LengthJet<1> MusclePath::length<1>(const Eigen::Matrix<double, 1, 1>&,
                                                   const RigidMotion<double, 1>*,
                                                   const Eigen::Matrix<double, 1, 1>*) const;
extern template std::vector<Eigen::Vector3d> MusclePath::pathPoints<1>(
    const Eigen::Matrix<double, 1, 1>&, const RigidMotion<double, 1>*, double) const;

}  // namespace bio
