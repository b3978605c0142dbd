#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "bio/path/tree_path.h"

namespace bio {

/// Lengths of some muscles' paths over a skeleton, whether code of fixed size or a tree evaluates
/// it.
class PathLengths {
 public:
  /// The skeleton must outlive this object.
  explicit PathLengths(const Skeleton& skeleton);

  /// The path must outlive this object.
  void add(const Muscle& muscle, const MusclePath& path);
  /// Places the skeleton; call after the last add().
  void moveTo(const Eigen::VectorXd& q);

  /// A length over the first coordinate.
  struct Along {
    double length;     ///< ℓ_MT [m]
    double slope;      ///< ∂ℓ/∂q [m/rad]
    double curvature;  ///< ∂²ℓ/∂q² [m/rad²]
    bool wrapped;      ///< a moving span touches a wrap object
  };
  /// Evaluates one path there. @throws std::domain_error if it has no taut string; names muscle and
  /// posture
  Along along(std::size_t path);

 private:
  const Skeleton* skeleton_;
  std::optional<TreePaths> onTree_;
  Along evaluate(std::size_t path);
  std::vector<const MusclePath*> paths_;
  std::vector<std::string> names_;
  Eigen::VectorXd at_;
  Eigen::Matrix<double, 1, 1> q_;
  std::vector<RigidMotion<double, 1>> moved_;
};

}  // namespace bio
