#pragma once

#include <string>
#include <vector>

#include "view/arm_motion.h"
#include "view/arm_shape.h"

namespace app {

/// A motion with the arm that can follow it.
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

  /// One per muscle of the poser; NaN: the motion does not say.
  std::vector<double> activationsAt(double time) const;

  /// Appends what a camera has to see of a posture: balls round the ends of bones and round the
  /// points of muscles, six points each [m].
  void addOutline(const bio::view::ArmPoser::Posture& posture,
                  std::vector<Eigen::Vector3d>& points) const;

 private:
  std::string modelName_;
  bio::view::ArmMotion motion_;
  bio::view::ArmPoser poser_;
  std::vector<bio::view::BodyShape> bodies_;
};

}  // namespace app
