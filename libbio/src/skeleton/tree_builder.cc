#include "skeleton/tree_builder.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <utility>

namespace bio {
namespace {

/// Axes of any joint as those of a custom joint: shifts first, then turns.
std::vector<std::pair<bool, TransformAxis>> axesOf(const Joint& joint) {
  std::vector<std::pair<bool, TransformAxis>> axes;
  const auto single = [&](bool turns, const Eigen::Vector3d& axis) {
    if (joint.coordinates.size() != 1) {
      throw std::invalid_argument(fmt::format("joint '{}': {} coordinates, must have one",
                                              joint.name, joint.coordinates.size()));
    }
    axes.push_back({turns, TransformAxis{joint.coordinates[0].name, axis, identityFunction()}});
  };
  switch (joint.kind) {
    case JointKind::weld:
      break;
    case JointKind::pin:
      single(true, Eigen::Vector3d::UnitZ());
      break;
    case JointKind::slider:
      single(false, Eigen::Vector3d::UnitX());
      break;
    case JointKind::custom:
      for (std::size_t i = 3; i < 6; ++i) axes.push_back({false, joint.axes[i]});
      for (std::size_t i = 0; i < 3; ++i) axes.push_back({true, joint.axes[i]});
      break;
  }
  return axes;
}

/// A turn that carries z to a unit axis; of noughts and ones for an axis along x, y or z.
Eigen::Matrix3d turnToAxis(const Eigen::Vector3d& axis) {
  int least = 0;
  for (int i = 1; i < 3; ++i) {
    if (std::abs(axis[i]) < std::abs(axis[least])) least = i;
  }
  Eigen::Matrix3d Q;
  Q.col(0) = Eigen::Vector3d::Unit(least).cross(axis).normalized();
  Q.col(1) = axis.cross(Q.col(0));
  Q.col(2) = axis;
  return Q;
}

}  // namespace

const CoordinateSource& sourceNamed(const std::map<std::string, CoordinateSource>& sources,
                                    const std::string& coordinate) {
  const auto source = sources.find(coordinate);
  if (source == sources.end()) {
    throw std::invalid_argument(fmt::format("the model has no coordinate called '{}'", coordinate));
  }
  return source->second;
}

void TreeBuilder::append(Pending& pending, const std::string& where, bool turns,
                         const TransformAxis& transform) const {
  CoordinateSource source;
  if (!transform.coordinate.empty()) source = sourceNamed(tree_.sources_, transform.coordinate);
  const FunctionEvaluator amount(transform.function);
  const bool isConstant = source.freeIndex < 0;
  const double value = isConstant ? amount.evaluate(source.value).value : 0;
  if (isConstant && value == 0) return;
  const double norm = transform.axis.norm();
  if (!(norm > 0)) {
    throw std::invalid_argument(fmt::format("{}: an axis has length {}, must be > 0", where, norm));
  }
  const Eigen::Vector3d axis = transform.axis / norm;
  if (isConstant) {
    Placement<double> fixed;
    if (turns) {
      fixed.R = Eigen::AngleAxisd(value, axis).toRotationMatrix();
    } else {
      fixed.p = axis * value;
    }
    pending.placement = pending.placement * fixed;
    return;
  }
  ElementaryMotion motion;
  motion.turns = turns;
  motion.coupling = source.coupling;
  motion.amount = amount;
  motion.isIdentity = source.coupling.isIdentity() && amount.isIdentity();
  if (source.coupling.isIdentity()) motion.line = amount.line();
  motion.before = pending.placement;
  pending.placement = Placement<double>{};
  if (turns) {
    // a turn is about z of its frame; what follows sees the old axes again
    const Eigen::Matrix3d Q = turnToAxis(axis);
    motion.before.R = (motion.before.R * Q).eval();
    pending.placement.R = Q.transpose();
  } else {
    motion.axis = axis;
  }
  motion.isPlacedStraight = motion.before.R.isIdentity(0);
  pending.motions.push_back(motion);
  pending.coordinates.push_back(source.freeIndex);
}

int TreeBuilder::addSegment(const std::string& name, std::size_t parent, const Pending& pending) {
  TreeSegment segment{name};
  segment.parent = static_cast<int>(parent);
  segment.firstMobility = static_cast<int>(tree_.mobilities_.size());
  const int index = static_cast<int>(tree_.segments_.size());
  int before = tree_.segmentMobility_[parent];
  for (std::size_t f = 0; f < pending.motions.size(); ++f) {
    if (f == 0 || pending.coordinates[f] != pending.coordinates[f - 1]) {
      Mobility mobility;
      mobility.coordinate = pending.coordinates[f];
      mobility.segment = index;
      mobility.parent = before;
      mobility.firstMotion = static_cast<int>(tree_.motions_.size());
      mobility.hasFixedScrew = pending.motions[f].line.has_value();
      before = static_cast<int>(tree_.mobilities_.size());
      tree_.mobilities_.push_back(mobility);
    }
    Mobility& mobility = tree_.mobilities_.back();
    mobility.hasFixedScrew = mobility.hasFixedScrew && mobility.numMotions == 0;
    ++mobility.numMotions;
    tree_.motions_.push_back(pending.motions[f]);
  }
  segment.lastMobility = before;
  tree_.segments_.push_back(segment);
  tree_.segmentMobility_.push_back(before);
  return index;
}

void TreeBuilder::add(const Joint& joint) {
  const BodyPlacement parent = tree_.placeOf(joint.parentBody);
  if (tree_.places_.count(joint.childBody)) {
    throw std::invalid_argument(fmt::format(
        "joint '{}': body '{}' has two joints towards the ground, the model must be a tree",
        joint.name, joint.childBody));
  }
  Pending pending;
  pending.placement = parent.X_SB * placementOf(joint.parentFrame);
  const std::string where = fmt::format("joint '{}'", joint.name);
  for (const auto& [turns, axis] : axesOf(joint)) append(pending, where, turns, axis);
  const Placement<double> X_SB = pending.placement * inverse(placementOf(joint.childFrame));
  if (pending.motions.empty()) {
    tree_.places_[joint.childBody] = BodyPlacement{parent.segment, X_SB};
  } else {
    const int segment = addSegment(joint.childBody, parent.segment, pending);
    tree_.places_[joint.childBody] = BodyPlacement{static_cast<std::size_t>(segment), X_SB};
  }
}

int TreeBuilder::addPoint(const BodyPlacement& body, const PointMotion& motion) {
  Pending pending;
  pending.placement = body.X_SB;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = Eigen::Vector3d::Unit(static_cast<Eigen::Index>(i));
    append(pending, "moving point", false,
           TransformAxis{motion.coordinate[i], axis, motion.location[i]});
  }
  if (pending.motions.empty()) {
    // nothing of it is free: a point that moves by nought keeps the rule "its own segment"
    throw std::invalid_argument("moving point: none of its coordinates is free");
  }
  // constants after the last free shift are part of where the point is
  pending.motions.back().before.p += pending.motions.back().before.R * pending.placement.p;
  return addSegment("moving point", body.segment, pending);
}

}  // namespace bio
