#pragma once

#include <Eigen/Dense>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bio/model/model.h"

namespace bio {

/// The whole skeleton of a model as Simbody simulates it: every body and every joint with all its
/// coordinates, couplers imposed by evaluating them. The independent second algorithm for
/// skeleton.h and articulated_tree.h. Simbody is used nowhere else.
class SimbodyTree {
 public:
  /// @throws std::invalid_argument a tree Simbody cannot build
  explicit SimbodyTree(const Model& model);
  ~SimbodyTree();
  SimbodyTree(SimbodyTree&&) noexcept;

  /// Simbody's results in a posture: coordinates named in `values`, the others at their defaults,
  /// dependent coordinates from their couplers.
  struct Dynamics {
    Eigen::MatrixXd massMatrix;    ///< all mobilities, order of mobilityNames()
    Eigen::VectorXd gravityForce;  ///< generalised force of gravity, +τ [N m]
  };
  Dynamics dynamicsAt(const std::map<std::string, double>& values) const;

  /// Coordinate name of each row of the mass matrix.
  std::vector<std::string> mobilityNames() const;

  /// A point fixed in a body, seen from ground [m].
  Eigen::Vector3d pointInGround(const std::map<std::string, double>& values,
                                const std::string& body, const Eigen::Vector3d& point) const;

  /// Mass matrix and gravity force of chosen coordinates, all others held or coupled: the full
  /// quantities projected with the couplers' slopes.
  Dynamics reducedTo(const std::vector<std::string>& coordinates,
                     const std::map<std::string, double>& values) const;

 private:
  struct Parts;  // keeps Simbody's headers out of this one
  std::unique_ptr<Parts> parts_;
};

}  // namespace bio
