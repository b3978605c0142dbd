#pragma once

#include <Eigen/Dense>
#include <map>
#include <string>
#include <vector>

#include "bio/model/model.h"
#include "bio/path/path.h"
#include "bio/skeleton/rigid_motion.h"
#include "bio/skeleton/skeleton.h"

namespace bio::view {

/// A bone drawn as a solid of revolution: wide at both ends, slender between.
struct TaperedBone {
  Eigen::Vector3d from;    ///< in the body frame [m]
  Eigen::Vector3d to;      ///< in the body frame [m]
  double fromRadius = 0;   ///< [m]
  double toRadius = 0;     ///< [m]
  double shaftRadius = 0;  ///< in the middle [m]
};

/// Shapes of one body in a picture.
struct BodyShape {
  std::string name;
  std::vector<BodyGeometry> geometry;
  std::vector<TaperedBone> bones;
  std::vector<std::pair<Eigen::Vector3d, double>> joints;  ///< centres [m, body frame], radii [m]
  std::vector<WrapObject> wraps;
};

/// Bones and joints from the model's frames alone: a bone from the body's own origin to each joint
/// with a child, and, when the mass centre lies beyond those, to twice as far as the mass centre.
/// Nothing shorter than 2 cm is drawn.
std::vector<BodyShape> bodyShapes(const Model& model);

/// Shapes as the scripts of pages read them. Of each body: number of bones, each from, to and three
/// radii; number of joints, each centre and radius; number of wrap objects, each kind, placement
/// (rotation row by row, then translation), radius, length, outer radius and semi-axes.
std::vector<double> shapeNumbers(const std::vector<BodyShape>& shapes);

/// One muscle at one moment.
struct MuscleShape {
  std::vector<Eigen::Vector3d> points;  ///< centre line in ground [m]
  double radius = 0;                    ///< [m]
};

/// Radius of the tube of a muscle [m]: its cross-section grows with the tendon force F,
///     π (r² − r_0²) = F/σ,   r_0 = 2.5 mm, σ = 5 N/mm²
/// @param tendonForce  F [N]; below 0 (a slack tendon that is extrapolated) as 0
double tubeRadius(double tendonForce);

/// Bodies and paths in one posture.
struct PlacedPaths {
  std::vector<Placement<double>> bodies;            ///< in ground
  std::vector<std::vector<Eigen::Vector3d>> lines;  ///< of the paths, in ground [m]; empty for a
                                                    ///< path that is a function of coordinates
};
/// @param bodies  by name, "ground" among them
/// @param q  in the skeleton's order [rad] or [m]
/// @throws std::domain_error if a path has no taut string there
PlacedPaths placedPaths(const Skeleton& skeleton, const std::vector<std::string>& bodies,
                        const std::vector<const MusclePath*>& paths, const Eigen::VectorXd& q);

/// A system that takes on postures.
class SystemPoser {
 public:
  /// @throws std::invalid_argument what Skeleton and MusclePath throw
  SystemPoser(const Model& model, const SkeletonOptions& options,
              const std::vector<std::string>& wrapAsCylinder);

  const Skeleton& skeleton() const { return skeleton_; }
  const std::vector<std::string>& muscles() const { return names_; }
  /// One line for each muscle that is left out since its wraps are not supported.
  const std::vector<std::string>& warnings() const { return warnings_; }

  /// Everything that a picture of one posture needs.
  struct Posture {
    std::map<std::string, Placement<double>> bodies;  ///< in ground
    std::vector<MuscleShape> muscles;                 ///< in the order of muscles()
  };

  /// Muscle paths become tubes of the given radii that rest on the wrap surfaces: where a path lies
  /// on a cylinder or sphere its centre line is lifted off it by the tube's radius.
  /// @param q  in the skeleton's order [rad] or [m]
  /// @param radii  of the tubes [m], in the order of muscles()
  Posture pose(const Eigen::VectorXd& q, const std::vector<double>& radii) const;

 private:
  Skeleton skeleton_;
  std::vector<std::string> bodies_;
  std::vector<std::string> names_;
  std::vector<std::string> warnings_;
  std::vector<MusclePath> paths_;
  std::vector<std::vector<WrapObject>> wraps_;  ///< cylinders and spheres of each path
};

/// Distance [m] of a point in ground from the axis of a cylinder or the centre of a sphere.
double distanceFromWrap(const WrapObject& wrap, const Placement<double>& body,
                        const Eigen::Vector3d& point);

/// Lifts the parts of a polyline that lie on a surface (within 0.2 % of its radius, and nowhere
/// deeper) by `lift` [m]; its first and last points stay.
std::vector<Eigen::Vector3d> liftedOff(const WrapObject& wrap, const Placement<double>& body,
                                       std::vector<Eigen::Vector3d> points, double lift);

}  // namespace bio::view
