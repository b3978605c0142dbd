#include "second_ways/simbody_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "bio/muscle/curves/curves.h"
#include "second_ways/simbody_system.h"

namespace bio {
namespace {

simbody::Curve curveOf(const Function& function) {
  return [evaluator = FunctionEvaluator(function)](double x) -> std::array<double, 3> {
    const CurveValue y = evaluator.evaluate(x);
    return {y.value, y.slope, y.curvature};
  };
}

simbody::Frame frameOf(const FramePlacement& frame) {
  return {frame.translation, frame.orientation};
}

simbody::Link linkOf(const Model& model, const Joint& joint) {
  const Body& body = findBody(model, joint.childBody);
  simbody::Link link;
  link.parent = joint.parentBody;
  link.parentFrame = frameOf(joint.parentFrame);
  link.body = {body.name, body.mass, body.massCenter, body.inertia};
  link.bodyFrame = frameOf(joint.childFrame);
  for (const Coordinate& coordinate : joint.coordinates)
    link.coordinates.push_back(coordinate.name);
  switch (joint.kind) {
    case JointKind::weld:
      link.mobility = simbody::Mobility::weld;
      break;
    case JointKind::pin:
      link.mobility = simbody::Mobility::pin;
      break;
    case JointKind::slider:
      link.mobility = simbody::Mobility::slider;
      break;
    case JointKind::custom:
      link.mobility = simbody::Mobility::functions;
      break;
  }
  if (joint.kind == JointKind::custom) {
    if (joint.coordinates.empty()) {
      throw std::invalid_argument(
          fmt::format("joint '{}': a custom joint needs a coordinate", joint.name));
    }
    for (const TransformAxis& axis : joint.axes) {
      const auto at = std::find(link.coordinates.begin(), link.coordinates.end(), axis.coordinate);
      link.axes.push_back(
          {at == link.coordinates.end() ? -1 : static_cast<int>(at - link.coordinates.begin()),
           axis.axis, curveOf(axis.function)});
    }
  }
  return link;
}

}  // namespace

struct SimbodyTree::Parts {
  Model model;
  simbody::System system;

  explicit Parts(const Model& m) : model(m), system(m.gravity) {}

  std::map<std::string, double> allValues(const std::map<std::string, double>& values) const {
    std::map<std::string, double> all;
    for (const Joint& joint : model.joints) {
      for (const Coordinate& c : joint.coordinates) all[c.name] = c.defaultValue;
    }
    for (const auto& [name, value] : values) {
      findCoordinate(model, name);
      all[name] = value;
    }
    for (const CoordinateCoupler& coupler : model.couplers) {
      all[coupler.dependent] =
          FunctionEvaluator(coupler.function).evaluate(all.at(coupler.independent)).value;
    }
    return all;
  }
};

SimbodyTree::SimbodyTree(const Model& model) : parts_(std::make_unique<Parts>(model)) {
  std::vector<const Joint*> waiting;
  for (const Joint& joint : model.joints) waiting.push_back(&joint);
  while (!waiting.empty()) {
    std::vector<const Joint*> later;
    for (const Joint* joint : waiting) {
      if (parts_->system.hasBody(joint->parentBody)) {
        parts_->system.add(linkOf(model, *joint));
      } else {
        later.push_back(joint);
      }
    }
    if (later.size() == waiting.size()) {
      throw std::invalid_argument(
          fmt::format("joint '{}' is not connected to the ground", later.front()->name));
    }
    waiting = later;
  }
  parts_->system.finish();
}

SimbodyTree::~SimbodyTree() = default;
SimbodyTree::SimbodyTree(SimbodyTree&&) noexcept = default;

std::vector<std::string> SimbodyTree::mobilityNames() const {
  return parts_->system.mobilityNames();
}

SimbodyTree::Dynamics SimbodyTree::dynamicsAt(const std::map<std::string, double>& values) const {
  auto [mass, gravity] = parts_->system.dynamics(parts_->allValues(values));
  return {std::move(mass), std::move(gravity)};
}

Eigen::Vector3d SimbodyTree::pointInGround(const std::map<std::string, double>& values,
                                           const std::string& body,
                                           const Eigen::Vector3d& point) const {
  if (body != "ground") findBody(parts_->model, body);
  return parts_->system.pointInGround(parts_->allValues(values), body, point);
}

SimbodyTree::Dynamics SimbodyTree::reducedTo(const std::vector<std::string>& coordinates,
                                             const std::map<std::string, double>& values) const {
  const Dynamics full = dynamicsAt(values);
  const std::map<std::string, double> all = parts_->allValues(values);
  const std::vector<std::string> names = mobilityNames();
  const auto rows = static_cast<Eigen::Index>(names.size());
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(coordinates.size()));
  for (Eigen::Index k = 0; k < B.cols(); ++k) {
    const std::string& coordinate = coordinates[static_cast<std::size_t>(k)];
    for (Eigen::Index r = 0; r < rows; ++r) {
      const std::string& name = names[static_cast<std::size_t>(r)];
      if (name == coordinate) B(r, k) = 1;
      for (const CoordinateCoupler& coupler : parts_->model.couplers) {
        if (coupler.dependent == name && coupler.independent == coordinate) {
          B(r, k) = FunctionEvaluator(coupler.function).evaluate(all.at(coordinate)).slope;
        }
      }
    }
  }
  return {B.transpose() * full.massMatrix * B, B.transpose() * full.gravityForce};
}

}  // namespace bio
