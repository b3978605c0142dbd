#pragma once

#include <string>
#include <vector>

#include "view/system_motion.h"
#include "view/system_shape.h"

namespace app {

/// A motion and the model that carries it out.
class MovingSystem {
 public:
  /// @throws std::invalid_argument what SystemPoser throws
  MovingSystem(const bio::Model& model, const bio::SystemOptions& options,
               bio::view::SystemMotion motion);

  const std::string& modelName() const { return modelName_; }
  const bio::view::SystemMotion& motion() const { return motion_; }
  const bio::view::SystemPoser& poser() const { return poser_; }
  const std::vector<bio::view::BodyShape>& bodies() const { return bodies_; }

  /// @param time  [s]
  bool covers(double time) const;
  bio::view::SystemPoser::Posture at(double time, const std::vector<double>& radii) const;

  /// One per muscle of the poser; NaN: unknown.
  std::vector<double> activationsAt(double time) const;

  /// Appends points that a camera has to show of a posture: six points each on balls around the
  /// ends of bones and around the points of muscles [m].
  void addOutline(const bio::view::SystemPoser::Posture& posture,
                  std::vector<Eigen::Vector3d>& points) const;

 private:
  std::string modelName_;
  bio::view::SystemMotion motion_;
  bio::view::SystemPoser poser_;
  std::vector<bio::view::BodyShape> bodies_;
};

}  // namespace app
