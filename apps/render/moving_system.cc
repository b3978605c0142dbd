#include "render/moving_system.h"

#include <limits>

namespace app {

namespace view = bio::view;

MovingSystem::MovingSystem(const bio::Model& model, const bio::SystemOptions& options,
                           view::SystemMotion motion)
    : modelName_(model.name),
      motion_(std::move(motion)),
      poser_(model, options.skeleton, options.wrapAsCylinder),
      bodies_(view::bodyShapes(model)) {}

bool MovingSystem::covers(double time) const {
  return time >= motion_.time[0] && time <= motion_.time[motion_.time.size() - 1];
}

view::SystemPoser::Posture MovingSystem::at(double time, const std::vector<double>& radii) const {
  const auto& coordinates = poser_.skeleton().coordinates();
  Eigen::VectorXd q(static_cast<Eigen::Index>(coordinates.size()));
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const auto found = motion_.coordinates.find(coordinates[i].name);
    q[static_cast<Eigen::Index>(i)] = found == motion_.coordinates.end()
                                          ? coordinates[i].defaultValue
                                          : view::valueAt(motion_.time, found->second, time);
  }
  return poser_.pose(q, radii);
}

std::vector<double> MovingSystem::activationsAt(double time) const {
  std::vector<double> values;
  for (const std::string& muscle : poser_.muscles()) {
    const auto found = motion_.activations.find(muscle);
    values.push_back(found == motion_.activations.end()
                         ? std::numeric_limits<double>::quiet_NaN()
                         : view::valueAt(motion_.time, found->second, time));
  }
  return values;
}

void MovingSystem::addOutline(const view::SystemPoser::Posture& posture,
                              std::vector<Eigen::Vector3d>& points) const {
  const auto addBall = [&](const Eigen::Vector3d& centre, double radius) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const double sign : {-1.0, 1.0}) {
        points.push_back(centre + sign * radius * Eigen::Vector3d::Unit(axis));
      }
    }
  };
  for (const view::BodyShape& body : bodies_) {
    const bio::Placement<double>& X = posture.bodies.at(body.name);
    for (const view::TaperedBone& bone : body.bones) {
      addBall(X.R * bone.from + X.p, 1.5 * bone.fromRadius);
      addBall(X.R * bone.to + X.p, 1.5 * bone.toRadius);
    }
  }
  for (const view::MuscleShape& muscle : posture.muscles) {
    for (const Eigen::Vector3d& point : muscle.points) addBall(point, muscle.radius);
  }
}

}  // namespace app
