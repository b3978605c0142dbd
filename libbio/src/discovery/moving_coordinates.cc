// What the coordinates of an EncompassingModel move, and what moves them.

#include <algorithm>
#include <cctype>

#include "bio/discovery/encompassing_model.h"
#include "simulation/integrators.h"

namespace bio::discover {

using Eigen::Index;
using Eigen::Vector3d;
using Eigen::VectorXd;

std::vector<std::string> EncompassingModel::coordinateNames() const {
  std::vector<std::string> names;
  for (const MovingCoordinate& at : coordinates_) names.push_back(at.coordinate.name);
  return names;
}

namespace {

/// A segment's placement in ground, and its first derivative in one coordinate.
struct Movement {
  Placement<double> at, derivative;
};

Movement movement(const MusculoskeletalSystem& system, std::size_t segment, int freeIndex,
                  double q) {
  return stepping::withCoordinates(system.skeleton(), [&](auto N) {
    Eigen::Matrix<double, decltype(N)::value, 1> at = system.skeleton().defaultValues();
    at[freeIndex] = q;
    SystemConfiguration<decltype(N)::value> configuration(system);
    configuration.moveTo(at);
    if constexpr (decltype(N)::value == Eigen::Dynamic) {
      return Movement{configuration.placement(segment), configuration.change(segment, freeIndex)};
    } else {
      const auto& motion = configuration.motions()[segment];
      return Movement{Placement<double>(motion.value),
                      Placement<double>(motion.first[static_cast<std::size_t>(freeIndex)])};
    }
  });
}

}  // namespace

Vector3d EncompassingModel::positionOf(const std::string& body, const Vector3d& point,
                                       double q) const {
  const BodyPlacement& place = system_->skeleton().placeOf(body);
  const Vector3d inSegment = place.X_SB.R * point + place.X_SB.p;
  if (place.segment == 0) return inSegment;
  const Placement<double> X = movement(*system_, place.segment, coordinates_.front().index, q).at;
  return X.R * inSegment + X.p;
}

namespace {

/// ∂(mass centre of a body in ground)/∂q
Vector3d centreIn(const Model& model, const BodyPlacement& place, const std::string& body,
                  const Placement<double>& derivative) {
  const Vector3d center = place.X_SB.R * findBody(model, body).massCenter + place.X_SB.p;
  return derivative.R * center + derivative.p;
}

}  // namespace

Vector3d EncompassingModel::velocityOf(const std::string& body, double q) const {
  const BodyPlacement& place = system_->skeleton().placeOf(body);
  if (place.segment == 0) return Vector3d::Zero();
  return centreIn(base_, place, body,
                  movement(*system_, place.segment, coordinates_.front().index, q).derivative);
}

void EncompassingModel::findBodies(MovingCoordinate& at) const {
  for (const Body& body : base_.bodies) {
    const BodyPlacement& place = system_->skeleton().placeOf(body.name);
    if (place.segment == 0 || !(body.mass > 0)) continue;
    const Movement moved = movement(*system_, place.segment, at.index, at.middle());
    const Eigen::Matrix3d turn = moved.derivative.R * moved.at.R.transpose();  // ω×
    const Vector3d omega(turn(2, 1), turn(0, 2), turn(1, 0));
    const Vector3d centre = centreIn(base_, place, body.name, moved.derivative);
    if (omega.norm() < 1e-9 && centre.norm() < 1e-9) continue;
    at.movedBodies.push_back(body.name);
    at.massMoment += body.mass * centre.norm();
    if (omega.norm() > 0.5) at.axis = omega.normalized();
  }
}

Eigen::MatrixXd EncompassingModel::momentArms(const MusculoskeletalSystem& system) const {
  const auto n = static_cast<Index>(system.numMuscles());
  Eigen::MatrixXd result(n, static_cast<Index>(coordinates_.size()));
  for (std::size_t k = 0; k < coordinates_.size(); ++k) {
    VectorXd q = system.skeleton().defaultValues();
    q[coordinates_[k].index] = coordinates_[k].middle();
    Trajectory still;
    still.time = {0};
    still.q = q;
    still.qDot = VectorXd::Zero(q.size());
    still.fibreLength = VectorXd::Ones(n);
    still.activation = VectorXd::Zero(n);
    result.col(static_cast<Index>(k)) =
        reportMuscles(system, still, coordinates_[k].index).momentArm;
  }
  return result;
}

void EncompassingModel::findGroups() {
  const Eigen::MatrixXd all = momentArms(*system_);
  for (std::size_t i = 0; i < system_->numMuscles(); ++i) {
    const std::string& muscle = system_->muscles()[i].name;
    std::size_t length = 0;
    while (length < muscle.size() && std::isupper(static_cast<unsigned char>(muscle[length]))) {
      ++length;
    }
    const std::string name = length > 0 ? muscle.substr(0, length) : muscle;
    auto at = std::find_if(groups_.begin(), groups_.end(),
                           [&](const MuscleGroup& group) { return group.name == name; });
    if (at == groups_.end())
      at = groups_.insert(groups_.end(), MuscleGroup{name, {}, VectorXd::Zero(all.cols())});
    at->muscles.push_back(i);
    at->momentArms += all.row(static_cast<Index>(i)).transpose();
  }
  for (MuscleGroup& group : groups_) group.momentArms /= static_cast<double>(group.muscles.size());
}

}  // namespace bio::discover
