#include "bio/skeleton/skeleton.h"
#include "bio/model/units.h"
#include "bio/skeleton/articulated_tree.h"
#include "bio/skeleton/skeleton_motion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <stdexcept>

namespace bio {
namespace {

/// Axes of any joint as those of a custom joint: shifts first, then turns.
std::vector<std::pair<bool, TransformAxis>> elementaryMotions(const Joint& joint) {
  std::vector<std::pair<bool, TransformAxis>> motions;
  const auto single = [&](bool turns, const Eigen::Vector3d& axis) {
    if (joint.coordinates.size() != 1) {
      throw std::invalid_argument(fmt::format("joint '{}': {} coordinates, must have one",
                                              joint.name, joint.coordinates.size()));
    }
    motions.push_back({turns, TransformAxis{joint.coordinates[0].name, axis, identityFunction()}});
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
      for (std::size_t i = 3; i < 6; ++i) motions.push_back({false, joint.axes[i]});
      for (std::size_t i = 0; i < 3; ++i) motions.push_back({true, joint.axes[i]});
      break;
  }
  return motions;
}

Placement<double> elementary(bool turns, const Eigen::Vector3d& axis, double amount) {
  Placement<double> X;
  if (turns) {
    X.R = Eigen::AngleAxisd(amount, axis).toRotationMatrix();
  } else {
    X.p = axis * amount;
  }
  return X;
}

bool isIdentity(const Function& function) {
  const auto* line = std::get_if<LinearFunction>(&function.shape);
  return line != nullptr && function.scale * line->slope == 1 && line->intercept == 0;
}

void addBody(Segment& segment, const Body& body, const Placement<double>& X_SB) {
  const auto& I = body.inertia;
  Eigen::Matrix3d inertia;
  inertia << I[0], I[3], I[4], I[3], I[1], I[5], I[4], I[5], I[2];
  const Eigen::Vector3d center = X_SB.R * body.massCenter + X_SB.p;
  // Σ m r rᵀ about the mass centre is ½ tr(I)·1 − I
  const Eigen::Matrix3d central = 0.5 * inertia.trace() * Eigen::Matrix3d::Identity() - inertia;
  segment.mass += body.mass;
  segment.massMoment += body.mass * center;
  segment.secondMoment +=
      X_SB.R * central * X_SB.R.transpose() + body.mass * center * center.transpose();
}

}  // namespace

std::string describePosture(const Skeleton& skeleton, const Eigen::VectorXd& q) {
  std::string text;
  for (Eigen::Index k = 0; k < q.size(); ++k) {
    const Coordinate& c = skeleton.coordinates()[static_cast<std::size_t>(k)];
    text += fmt::format("{}{} = {:.6g} {}", k > 0 ? ", " : "", c.name,
                        c.isRotation ? q[k] * degreesPerRadian : q[k], c.isRotation ? "deg" : "m");
  }
  return text;
}

std::vector<std::string> lockRemarks(const Model& model, const SkeletonOptions& options) {
  std::vector<std::string> remarks;
  for (const Joint& joint : model.joints) {
    for (const Coordinate& c : joint.coordinates) {
      const auto locked = options.lockedValues.find(c.name);
      if (locked == options.lockedValues.end()) continue;
      const ShownUnit unit = positionUnit(c.isRotation);
      const double margin = 1 / unit.factor;
      const double value = locked->second;
      if (value >= c.rangeMin - margin && value <= c.rangeMax + margin) continue;
      remarks.push_back(fmt::format(
          "{} is locked at {:.4g} {}, outside its range, {:.4g} to {:.4g}", c.name,
          value * unit.factor, unit.name, c.rangeMin * unit.factor, c.rangeMax * unit.factor));
    }
  }
  return remarks;
}

Placement<double> placementOf(const FramePlacement& frame) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  const Vector3d& o = frame.orientation;
  Placement<double> X;
  X.R = (AngleAxisd(o.x(), Vector3d::UnitX()) * AngleAxisd(o.y(), Vector3d::UnitY()) *
         AngleAxisd(o.z(), Vector3d::UnitZ()))
            .toRotationMatrix();
  X.p = frame.translation;
  return X;
}

namespace {

using Couplers = std::map<std::string, const CoordinateCoupler*>;

Couplers couplersOf(const Model& model) {
  Couplers couplers;
  for (const CoordinateCoupler& coupler : model.couplers) couplers[coupler.dependent] = &coupler;
  return couplers;
}

/// Each coordinate has one role at most, and those that follow others have none.
void checkRoles(const Model& model, const SkeletonOptions& options, const Couplers& couplers) {
  const std::vector<std::string>& free = options.freeCoordinates;
  if (free.empty()) throw std::invalid_argument("0 free coordinates, must be 1 or more");
  for (const std::string& name : free) {
    findCoordinate(model, name);
    if (const auto coupler = couplers.find(name); coupler != couplers.end()) {
      throw std::invalid_argument(
          fmt::format("coordinate '{}' follows '{}' (coupler '{}') and cannot be free", name,
                      coupler->second->independent, coupler->second->name));
    }
    if (options.lockedValues.count(name)) {
      throw std::invalid_argument(fmt::format("coordinate '{}' is free and locked", name));
    }
    if (std::count(free.begin(), free.end(), name) > 1) {
      throw std::invalid_argument(fmt::format("coordinate '{}' is named free twice", name));
    }
  }
  for (const auto& [name, value] : options.lockedValues) {
    findCoordinate(model, name);
    if (!std::isfinite(value)) {
      throw std::invalid_argument(
          fmt::format("locked coordinate '{}' = {}, must be finite", name, value));
    }
    if (const auto coupler = couplers.find(name); coupler != couplers.end()) {
      throw std::invalid_argument(
          fmt::format("coordinate '{}' follows '{}' (coupler '{}'): lock that one instead", name,
                      coupler->second->independent, coupler->second->name));
    }
  }
  for (const CoordinateCoupler& coupler : model.couplers) {
    if (couplers.count(coupler.independent)) {
      throw std::invalid_argument(
          fmt::format("coupler '{}': its independent coordinate '{}' is itself coupled",
                      coupler.name, coupler.independent));
    }
  }
}

Skeleton::CoordinateSource uncoupled(const Coordinate& coordinate, const SkeletonOptions& options) {
  Skeleton::CoordinateSource source;
  const std::vector<std::string>& names = options.freeCoordinates;
  const auto free = std::find(names.begin(), names.end(), coordinate.name);
  const auto locked = options.lockedValues.find(coordinate.name);
  if (free != names.end()) {
    source.freeIndex = static_cast<int>(free - names.begin());
  } else {
    source.value = locked != options.lockedValues.end() ? locked->second : coordinate.defaultValue;
  }
  return source;
}

Eigen::Vector3d unitAxis(const Joint& joint, const Eigen::Vector3d& axis) {
  const double norm = axis.norm();
  if (!(norm > 0)) {
    throw std::invalid_argument(
        fmt::format("joint '{}': an axis has length {}, must be > 0", joint.name, norm));
  }
  return axis / norm;
}

/// The joints of a tree, those nearer the ground first.
std::vector<const Joint*> outwards(const Model& model) {
  std::vector<const Joint*> order, waiting;
  std::set<std::string> placed{"ground"};
  for (const Joint& joint : model.joints) waiting.push_back(&joint);
  while (!waiting.empty()) {
    std::vector<const Joint*> later;
    for (const Joint* joint : waiting) {
      if (!placed.count(joint->parentBody)) {
        later.push_back(joint);
        continue;
      }
      if (!placed.insert(joint->childBody).second) {
        throw std::invalid_argument(fmt::format(
            "joint '{}': body '{}' has two joints towards the ground, the model must be a tree",
            joint->name, joint->childBody));
      }
      order.push_back(joint);
    }
    if (later.size() == waiting.size()) {
      throw std::invalid_argument(
          fmt::format("joint '{}': body '{}' is not connected to the ground", later.front()->name,
                      later.front()->parentBody));
    }
    waiting = later;
  }
  return order;
}

}  // namespace

Skeleton::Skeleton(const Model& model, const SkeletonOptions& options) : gravity_(model.gravity) {
  // which coordinates are free, coupled or constant
  const Couplers couplers = couplersOf(model);
  checkRoles(model, options, couplers);
  for (const std::string& name : options.freeCoordinates) {
    coordinates_.push_back(findCoordinate(model, name));
  }
  for (const Joint& joint : model.joints) {
    for (const Coordinate& coordinate : joint.coordinates) {
      sources_[coordinate.name] = uncoupled(coordinate, options);
    }
  }
  for (const CoordinateCoupler& coupler : model.couplers) {
    const CoordinateSource& independent = sourceOf(coupler.independent);
    sourceOf(coupler.dependent);
    CoordinateSource source;
    source.freeIndex = independent.freeIndex;
    source.coupling = FunctionEvaluator(coupler.function);
    if (source.freeIndex < 0) source.value = source.coupling.evaluate(independent.value).value;
    sources_[coupler.dependent] = source;
  }

  // walk the tree outwards; bodies that do not move against their parent join its segment
  segments_.push_back(Segment{"ground"});
  segmentMotions_.emplace_back();
  places_["ground"] = BodyPlacement{};
  for (const Joint* joint : outwards(model)) {
    const BodyPlacement parent = places_.at(joint->parentBody);
    SegmentMotion motion;
    motion.parent = parent.segment;
    Placement<double> pending = parent.X_SB * placementOf(joint->parentFrame);
    for (const auto& [turns, transform] : elementaryMotions(*joint)) {
      CoordinateSource source;
      if (!transform.coordinate.empty()) source = sourceOf(transform.coordinate);
      FunctionEvaluator amount(transform.function);
      if (source.freeIndex < 0) {
        const double value = amount.evaluate(source.value).value;
        if (value == 0) continue;
        pending = pending * elementary(turns, unitAxis(*joint, transform.axis), value);
        continue;
      }
      Factor factor;
      factor.before = pending;
      factor.turns = turns;
      factor.axis = unitAxis(*joint, transform.axis);
      factor.freeIndex = source.freeIndex;
      factor.coupling = source.coupling;
      factor.amount = amount;
      factor.isIdentity = isIdentity(transform.function) && !couplers.count(transform.coordinate);
      motion.factors.push_back(factor);
      pending = Placement<double>{};
    }
    const Placement<double> X_SC = pending * inverse(placementOf(joint->childFrame));
    if (motion.factors.empty()) {
      places_[joint->childBody] = BodyPlacement{motion.parent, X_SC};
    } else {
      places_[joint->childBody] = BodyPlacement{segments_.size(), X_SC};
      segments_.push_back(Segment{joint->childBody});
      segmentMotions_.push_back(motion);
    }
  }
  for (const Body& body : model.bodies) {
    const auto place = places_.find(body.name);
    if (place == places_.end()) {
      throw std::invalid_argument(fmt::format("body '{}' has no joint", body.name));
    }
    addBody(segments_[place->second.segment], body, place->second.X_SB);
  }

  // a coordinate that moves nothing leaves the mass matrix singular
  for (int i = 0; i < numCoordinates(); ++i) {
    double moved = 0;
    for (std::size_t s = 1; s < segments_.size(); ++s) {
      for (const Factor& factor : segmentMotions_[s].factors) {
        if (factor.freeIndex == i) moved += 1;
      }
    }
    if (moved == 0) {
      throw std::invalid_argument(fmt::format("coordinate '{}' moves no body",
                                              coordinates_[static_cast<std::size_t>(i)].name));
    }
  }

  if (options.asTree || numCoordinates() > maxFixedCoordinates ||
      segments_.size() > maxFixedSegments) {
    tree_ = std::make_shared<const ArticulatedTree>(model, options);
  }

  // one segment that turns about, or shifts along, one axis: M is a constant
  if (segments_.size() == 2 && segmentMotions_[1].factors.size() == 1 &&
      segmentMotions_[1].factors[0].isIdentity) {
    std::array<RigidMotion<double, 1>, 2> moved;
    motions<double, 1>(Eigen::Matrix<double, 1, 1>::Zero(), moved.data());
    constantMass_ = detail::momentProduct(segments_[1], moved[1].first[0], moved[1].first[0]);
    constantInertia_ = true;
  }
}

void Skeleton::placements(const double* q, Placement<double>* out) const {
  out[0] = Placement<double>{};
  for (std::size_t s = 1; s < segments_.size(); ++s) {
    const SegmentMotion& motion = segmentMotions_[s];
    Placement<double> X = out[motion.parent];
    for (const Factor& factor : motion.factors) {
      const double amount = amountOf<double>(factor, q[factor.freeIndex]).value;
      X = X * factor.before * elementary(factor.turns, factor.axis, amount);
    }
    out[s] = X;
  }
}

const BodyPlacement& Skeleton::placeOf(const std::string& body) const {
  const auto place = places_.find(body);
  if (place == places_.end()) {
    throw std::invalid_argument(fmt::format("the model has no body called '{}'", body));
  }
  return place->second;
}

Eigen::VectorXd Skeleton::defaultValues() const {
  Eigen::VectorXd q(numCoordinates());
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    q[i] = coordinates_[static_cast<std::size_t>(i)].defaultValue;
  }
  return q;
}

int Skeleton::indexOf(const std::string& coordinate) const {
  for (std::size_t i = 0; i < coordinates_.size(); ++i) {
    if (coordinates_[i].name == coordinate) return static_cast<int>(i);
  }
  return -1;
}

const Skeleton::CoordinateSource& Skeleton::sourceOf(const std::string& coordinate) const {
  const auto source = sources_.find(coordinate);
  if (source == sources_.end()) {
    throw std::invalid_argument(fmt::format("the model has no coordinate called '{}'", coordinate));
  }
  return source->second;
}

}  // namespace bio
