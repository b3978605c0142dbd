#include "robot_description/model_maker.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace bio::robot {
namespace {

using Eigen::Vector3d;

/// The speed [rad/s] or [m/s] at which dry friction has three quarters of its full size; neither
/// format has one. That of discover's `coulomb` in models with muscles.
constexpr double restSpeed = 0.05;
/// So many names stand in a warning.
constexpr std::size_t mostNames = 8;

std::string newAmong(std::set<std::string>& used, const std::string& wanted,
                     const std::set<std::string>& reserved = {}) {
  std::string name = wanted;
  for (int i = 2; reserved.contains(name) || !used.insert(name).second; ++i)
    name = fmt::format("{}_{}", wanted, i);
  return name;
}

bool areParallel(const Vector3d& a, const Vector3d& b) {
  return a.cross(b).norm() < 1e-9;
}

/// Whether the motion fits into one joint with those before it: shifts along, then turns about
/// axes of the parent's frame through one point.
bool fits(const std::vector<Motion>& group, const Motion& next) {
  std::size_t alike = 0;
  for (const Motion& each : group) {
    if (each.turns && !next.turns) return false;
    if (each.turns != next.turns) continue;
    if (areParallel(each.axis, next.axis)) return false;
    if (each.turns && each.anchor != next.anchor) return false;
    ++alike;
  }
  return alike < 3;
}

/// Fills axes that no coordinate drives with such as are not parallel to the others, which OpenSim
/// asks for.
void fillAxes(std::array<TransformAxis, 6>& axes, std::size_t first, std::size_t used) {
  for (std::size_t i = first + used; i < first + 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      const Vector3d unit = Vector3d::Unit(k);
      const bool isNew =
          std::none_of(axes.begin() + static_cast<std::ptrdiff_t>(first),
                       axes.begin() + static_cast<std::ptrdiff_t>(i),
                       [&](const TransformAxis& axis) { return areParallel(axis.axis, unit); });
      if (isNew) axes[i].axis = unit;
      if (isNew) break;
    }
    axes[i].function = {1, ConstantFunction{0}};
  }
}

}  // namespace

Coordinate coordinateCalled(const std::string& name, bool isRotation) {
  Coordinate coordinate;
  coordinate.name = name;
  coordinate.isRotation = isRotation;
  coordinate.rangeMin = -10;
  coordinate.rangeMax = 10;
  return coordinate;
}

std::string ModelMaker::nameOf(const Element& element) {
  return nameFrom(element, textOf(element, "name"));
}

std::string ModelMaker::nameFrom(const Element& element, const std::string& name) {
  if (name.empty()) documents_.fail(element, "has no name, must have one");
  std::string fine = name;
  for (char& c : fine) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isspace(byte) || std::iscntrl(byte) || c == '/' || c == ',' || c == '"') c = '_';
  }
  if (fine == "ground") fine = fmt::format("ground_{}", element.Name());  // not the ground itself
  if (fine != name) {
    std::string remark = fmt::format("{} is called '{}'", label(element), fine);
    if (std::find(model_.remarks.begin(), model_.remarks.end(), remark) == model_.remarks.end())
      model_.remarks.push_back(std::move(remark));
  }
  return fine;
}

void ModelMaker::requireNew(const Element& element, const char* what, const std::string& name,
                            Named& named) {
  const auto [found, isNew] = named.elements.emplace(name, &element);
  if (!isNew || !named.names.insert(name).second) {
    documents_.fail(element, fmt::format("is a second {} called '{}' (the first is in line {}), "
                                         "names must be unique",
                                         what, name, found->second->GetLineNum()));
  }
}

void ModelMaker::requireNewBody(const Element& element, const std::string& name) {
  requireNew(element, "part", name, bodies_);
}

void ModelMaker::requireNewCoordinate(const Element& element, const std::string& name) {
  requireNew(element, "joint", name, coordinates_);
}

std::string ModelMaker::newBodyName(const std::string& wanted) {
  return newAmong(bodies_.names, wanted, reserved_);
}

std::string ModelMaker::newCoordinateName(const std::string& wanted) {
  return newAmong(coordinates_.names, wanted, reserved_);
}

std::string ModelMaker::newForceName(const std::string& wanted) {
  // a column of a trial that is called as a coordinate is its measurement
  std::string name = wanted;
  while (coordinates_.names.contains(name)) name += "_motor";
  return newAmong(forces_, name);
}

void ModelMaker::addBody(const std::string& name, const MassProperties& mass) {
  const Eigen::Matrix3d& I = mass.inertia;
  model_.bodies.push_back(
      {name, mass.mass, mass.center, {I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2)}, {}});
}

void ModelMaker::join(const std::string& parent, const Transform& X_PB, const std::string& body,
                      const std::vector<Motion>& motions, const std::string& name) {
  std::vector<std::vector<Motion>> groups(1);
  for (const Motion& motion : motions) {
    if (!fits(groups.back(), motion)) groups.emplace_back();
    groups.back().push_back(motion);
  }
  std::string at = parent;
  Transform X = X_PB;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    std::string next = body;
    if (i + 1 < groups.size()) {
      next = newBodyName(fmt::format("{}_{}", body, groups[i].back().coordinate.name));
      addBody(next, {});
    }
    joinGroup(at, X, next, groups[i], name);
    at = next;
    X = {};
  }
}

void ModelMaker::joinGroup(const std::string& parent, const Transform& X_PB,
                           const std::string& body, const std::vector<Motion>& group,
                           const std::string& name) {
  Joint joint;
  joint.parentBody = parent;
  joint.childBody = body;
  joint.parentFrame = placementOf(X_PB);
  joint.name = newAmong(joints_, !name.empty()       ? name
                                 : group.size() == 1 ? group.front().coordinate.name
                                                     : fmt::format("{}_to_{}", parent, body));
  if (group.empty()) {
    model_.joints.push_back(std::move(joint));
    return;
  }
  for (const Motion& motion : group) {
    joint.coordinates.push_back(motion.coordinate);
    if (!motion.turns || motion.anchor.isZero(0)) continue;
    joint.parentFrame.translation = X_PB.R * motion.anchor + X_PB.p;
    joint.childFrame.translation = motion.anchor;
  }
  const Motion& only = group.front();
  const Vector3d plain = only.turns ? Vector3d::UnitZ() : Vector3d::UnitX();
  if (group.size() == 1 && only.zero == 0 && only.axis == plain) {
    joint.kind = only.turns ? JointKind::pin : JointKind::slider;
    model_.joints.push_back(std::move(joint));
    return;
  }
  joint.kind = JointKind::custom;
  std::size_t turns = 0, shifts = 0;
  for (const Motion& motion : group) {
    joint.axes[motion.turns ? turns++ : 3 + shifts++] = {
        motion.coordinate.name, motion.axis, Function{1, LinearFunction{1, 0.0 - motion.zero}}};
  }
  fillAxes(joint.axes, 0, turns);
  fillAxes(joint.axes, 3, shifts);
  model_.joints.push_back(std::move(joint));
}

void ModelMaker::joinFree(const std::string& parent, const Transform& X_PF, const std::string& body,
                          const std::string& name, const Transform& start) {
  Joint joint;
  joint.name = newAmong(joints_, name);
  joint.kind = JointKind::custom;
  joint.parentBody = parent;
  joint.childBody = body;
  joint.parentFrame = placementOf(X_PF);
  const FramePlacement at = placementOf(start);
  for (int i = 0; i < 6; ++i) {
    const bool turns = i < 3;
    Coordinate coordinate = coordinateCalled(
        newCoordinateName(fmt::format("{}_{}{}", name, turns ? 'r' : 't', "xyz"[i % 3])), turns);
    coordinate.defaultValue = turns ? at.orientation[i] : at.translation[i - 3];
    // a range around the start: free bodies may stand anywhere
    const double most = std::max(10.0, 2 * std::abs(coordinate.defaultValue));
    coordinate.rangeMin = -most;
    coordinate.rangeMax = most;
    joint.axes[static_cast<std::size_t>(i)] = {coordinate.name, Vector3d::Unit(i % 3),
                                               Function{1, LinearFunction{1, 0}}};
    joint.coordinates.push_back(std::move(coordinate));
  }
  model_.joints.push_back(std::move(joint));
}

void ModelMaker::addForces(const std::string& coordinate, const JointForces& forces) {
  if (forces.stiffness != 0) {
    model_.springForces.push_back({newForceName(coordinate + "_spring"), coordinate,
                                   forces.stiffness, forces.rest, forces.damping});
  } else if (forces.damping != 0) {
    model_.springForces.push_back(
        {newForceName(coordinate + "_damping"), coordinate, 0, 0, forces.damping});
  }
  if (forces.friction != 0) {
    model_.expressionForces.push_back(
        {newForceName(coordinate + "_friction"), coordinate,
         fmt::format("-{}*tanh(qdot/{})", forces.friction, restSpeed)});
  }
}

void ModelMaker::addMotor(const Element& element, const std::string& wanted,
                          const std::string& coordinate, double optimalForce) {
  const std::string name = newForceName(wanted);
  if (name != wanted) {
    model_.remarks.push_back(
        fmt::format("{} at joint '{}' is called '{}'", label(element), coordinate, name));
  }
  model_.actuators.push_back({name, coordinate, optimalForce});
}

void ModelMaker::addCoupler(const Element& element, const std::string& dependent,
                            const std::string& independent, const Function& function) {
  if (!coupled_.insert(dependent).second) {
    documents_.fail(element, fmt::format("joint '{}' follows another joint already", dependent));
  }
  model_.couplers.push_back(
      {fmt::format("{}_follows_{}", dependent, independent), independent, dependent, function});
}

void ModelMaker::isNotSimulated(const std::string& what, const std::string& name) {
  const auto found = std::find_if(notSimulated_.begin(), notSimulated_.end(),
                                  [&](const auto& each) { return each.first == what; });
  if (found == notSimulated_.end()) {
    notSimulated_.push_back({what, {name}});
  } else {
    found->second.push_back(name);
  }
}

Model ModelMaker::finished() {
  for (auto& [what, names] : notSimulated_) {
    const std::size_t more = names.size() > mostNames ? names.size() - mostNames : 0;
    names.resize(names.size() - more);
    model_.warnings.push_back(fmt::format("not simulated: {} ({}{})", what, fmt::join(names, ", "),
                                          more ? fmt::format(" and {} more", more) : ""));
  }
  return std::move(model_);
}

}  // namespace bio::robot
