#pragma once

#include <string>
#include <vector>

#include "view/arm_motion.h"
#include "view/arm_shape.h"

namespace app {

/// A motion and the model that carries it out.
class MovingArm {
 public:
  /// @throws std::invalid_argument what ArmPoser throws
  MovingArm(const bio::Model& model, const bio::ArmOptions& options, bio::view::ArmMotion motion);

  const std::string& modelName() const { return modelName_; }
  const bio::view::ArmMotion& motion() const { return motion_; }
  const bio::view::ArmPoser& poser() const { return poser_; }
  const std::vector<bio::view::BodyShape>& bodies() const { return bodies_; }

  /// @param time  [s]
  bool covers(double time) const;
  bio::view::ArmPoser::Posture at(double time, const std::vector<double>& radii) const;

  /// One per muscle of the poser; NaN: unknown.
  std::vector<double> activationsAt(double time) const;

  /// Appends points that a camera has to show of a posture: six points each on balls around the
  /// ends of bones and around the points of muscles [m].
  void addOutline(const bio::view::ArmPoser::Posture& posture,
                  std::vector<Eigen::Vector3d>& points) const;

 private:
  std::string modelName_;
  bio::view::ArmMotion motion_;
  bio::view::ArmPoser poser_;
  std::vector<bio::view::BodyShape> bodies_;
};

}  // namespace app
