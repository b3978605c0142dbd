#include "view/system_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "bio/muscle/curves/curves.h"
#include "bio/path/posture_samples.h"

namespace bio::view {
namespace {

using Eigen::Vector3d;

constexpr double shortestBone = 0.02;  // [m]

TaperedBone boneTo(const Vector3d& end) {
  TaperedBone bone{Vector3d::Zero(), end};
  bone.shaftRadius = std::clamp(0.03 * end.norm(), 0.0035, 0.009);
  bone.fromRadius = 1.7 * bone.shaftRadius;
  bone.toRadius = 1.45 * bone.shaftRadius;
  return bone;
}

/// Where a child body is in its parent's frame, at the default values of the coordinates: a custom
/// joint may shift it far from the joint's own frame.
Vector3d childOf(const Model& model, const Joint& joint) {
  Vector3d shift = Vector3d::Zero();
  if (joint.kind == JointKind::custom) {
    for (std::size_t i = 3; i < joint.axes.size(); ++i) {
      const TransformAxis& axis = joint.axes[i];
      const double at =
          axis.coordinate.empty() ? 0.0 : findCoordinate(model, axis.coordinate).defaultValue;
      shift += FunctionEvaluator(axis.function).value(at) * axis.axis.normalized();
    }
  }
  return joint.parentFrame.translation + placementOf(joint.parentFrame).R * shift;
}

std::vector<TaperedBone> bonesOf(const Model& model, const Body& body) {
  std::vector<TaperedBone> bones;
  double longest = 0;
  for (const Joint& joint : model.joints) {
    if (joint.parentBody != body.name) continue;
    const Vector3d end = childOf(model, joint);
    longest = std::max(longest, end.norm());
    if (end.norm() >= shortestBone) bones.push_back(boneTo(end));
  }
  if (body.mass > 0 && body.massCenter.norm() > longest &&
      2 * body.massCenter.norm() >= shortestBone) {
    bones.push_back(boneTo(2 * body.massCenter));
  }
  return bones;
}

bool isRound(const WrapObject& wrap) {
  return wrap.shape == WrapShape::cylinder || wrap.shape == WrapShape::sphere;
}

}  // namespace

PlacedPaths placedPaths(const Skeleton& skeleton, const std::vector<std::string>& bodies,
                        const std::vector<const MusclePath*>& paths, const Eigen::VectorXd& q) {
  constexpr double step = 0.05;  // [rad] along an arc
  PlacedPaths placed;
  const auto place = [&](auto&& placementOf) {
    for (const std::string& body : bodies) {
      const BodyPlacement& in = skeleton.placeOf(body);
      placed.bodies.push_back(placementOf(in.segment) * in.X_SB);
    }
  };
  if (skeleton.tree()) {
    const bio::Posture posture = postureOf(skeleton, {q.begin(), q.end()});
    place([&](std::size_t segment) { return posture.placements[segment]; });
    for (const MusclePath* path : paths)
      placed.lines.push_back(path->isFunction() ? std::vector<Vector3d>()
                                                : path->pathPoints(posture, step));
    return placed;
  }
  const Eigen::Matrix<double, 1, 1> free = q;
  std::vector<RigidMotion<double, 1>> moved(skeleton.numSegments());
  skeleton.motions<double, 1>(free, moved.data());
  place([&](std::size_t segment) { return moved[segment].value; });
  for (const MusclePath* path : paths)
    placed.lines.push_back(path->isFunction() ? std::vector<Vector3d>()
                                              : path->pathPoints<1>(free, moved.data(), step));
  return placed;
}

std::vector<BodyShape> bodyShapes(const Model& model) {
  std::vector<BodyShape> shapes;
  BodyShape ground;
  ground.name = "ground";
  for (const WrapObject& wrap : model.wrapObjects) {
    if (wrap.body == "ground") ground.wraps.push_back(wrap);
  }
  shapes.push_back(ground);
  for (const Body& body : model.bodies) {
    BodyShape shape;
    shape.name = body.name;
    shape.geometry = body.geometry;
    shape.bones = bonesOf(model, body);
    for (const Joint& joint : model.joints) {
      if (joint.childBody != body.name || joint.kind == JointKind::weld || shape.bones.empty()) {
        continue;
      }
      double radius = 0;
      for (const TaperedBone& bone : shape.bones) radius = std::max(radius, bone.fromRadius);
      shape.joints.push_back({joint.childFrame.translation, 1.15 * radius});
    }
    for (const WrapObject& wrap : model.wrapObjects) {
      if (wrap.body == body.name) shape.wraps.push_back(wrap);
    }
    shapes.push_back(shape);
  }
  return shapes;
}

std::vector<double> shapeNumbers(const std::vector<BodyShape>& shapes) {
  std::vector<double> numbers;
  const auto add = [&](const Vector3d& v) { numbers.insert(numbers.end(), v.begin(), v.end()); };
  for (const BodyShape& body : shapes) {
    numbers.push_back(static_cast<double>(body.bones.size()));
    for (const TaperedBone& bone : body.bones) {
      add(bone.from);
      add(bone.to);
      numbers.insert(numbers.end(), {bone.fromRadius, bone.toRadius, bone.shaftRadius});
    }
    numbers.push_back(static_cast<double>(body.joints.size()));
    for (const auto& [centre, radius] : body.joints) {
      add(centre);
      numbers.push_back(radius);
    }
    numbers.push_back(static_cast<double>(body.wraps.size()));
    for (const WrapObject& wrap : body.wraps) {
      const Placement<double> X = placementOf(wrap.frame);
      numbers.push_back(static_cast<double>(wrap.shape));
      for (int i = 0; i < 3; ++i) add(X.R.row(i));
      add(X.p);
      numbers.insert(numbers.end(), {wrap.radius, wrap.length, wrap.outerRadius});
      add(wrap.semiAxes);
    }
  }
  return numbers;
}

double tubeRadius(double tendonForce) {
  constexpr double restingRadius = 0.0025;  // [m]
  constexpr double shownStress = 5e6;       // [N/m²]
  return std::sqrt(restingRadius * restingRadius +
                   std::max(tendonForce, 0.0) / (shownStress * std::numbers::pi));
}

SystemPoser::SystemPoser(const Model& model, const SkeletonOptions& options,
                         const std::vector<std::string>& wrapAsCylinder)
    : skeleton_(model, options) {
  PostureSamples postures(model, skeleton_);
  bodies_.push_back("ground");
  for (const Body& body : model.bodies) bodies_.push_back(body.name);
  for (const Muscle& muscle : model.muscles) {
    if (!muscle.enabled) continue;
    try {
      paths_.emplace_back(model, skeleton_, muscle, wrapAsCylinder, postures.of(muscle));
    } catch (const UnsupportedWrap& error) {
      warnings_.push_back(fmt::format("{}: the muscle is left out", error.what()));
      continue;
    }
    if (paths_.back().isFunction()) {
      paths_.pop_back();
      warnings_.push_back(fmt::format(
          "muscle '{}' is not drawn: its path is a function of coordinates, without points",
          muscle.name));
      continue;
    }
    const std::vector<std::string>& said = paths_.back().warnings();
    warnings_.insert(warnings_.end(), said.begin(), said.end());
    names_.push_back(muscle.name);
    wraps_.emplace_back();
    for (const PathWrap& wrap : muscle.path.wraps) {
      const WrapObject& object = findWrapObject(model, wrap.wrapObject);
      if (object.active && isRound(object)) wraps_.back().push_back(object);
    }
  }
}

SystemPoser::Posture SystemPoser::pose(const Eigen::VectorXd& q,
                                       const std::vector<double>& radii) const {
  if (q.size() != skeleton_.numCoordinates() || radii.size() != paths_.size()) {
    throw std::invalid_argument(fmt::format("{} coordinates and {} radii, must be {} and {}",
                                            q.size(), radii.size(), skeleton_.numCoordinates(),
                                            paths_.size()));
  }
  std::vector<const MusclePath*> paths;
  for (const MusclePath& path : paths_) paths.push_back(&path);
  PlacedPaths placed = placedPaths(skeleton_, bodies_, paths, q);
  Posture posture;
  for (std::size_t i = 0; i < bodies_.size(); ++i) posture.bodies[bodies_[i]] = placed.bodies[i];
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    MuscleShape& muscle = posture.muscles.emplace_back();
    muscle.points = std::move(placed.lines[i]);
    muscle.radius = radii[i];
    for (const WrapObject& wrap : wraps_[i]) {
      muscle.points = liftedOff(wrap, posture.bodies.at(wrap.body), muscle.points, radii[i]);
    }
  }
  return posture;
}

namespace {

/// From the axis or centre to the point, in the wrap's frame.
Vector3d spokeTo(const WrapObject& wrap, const Vector3d& p_C) {
  return wrap.shape == WrapShape::cylinder ? Vector3d(p_C.x(), p_C.y(), 0) : p_C;
}

}  // namespace

double distanceFromWrap(const WrapObject& wrap, const Placement<double>& body,
                        const Vector3d& point) {
  const Placement<double> X_CG = inverse(body * placementOf(wrap.frame));
  return spokeTo(wrap, X_CG.R * point + X_CG.p).norm();
}

std::vector<Vector3d> liftedOff(const WrapObject& wrap, const Placement<double>& body,
                                std::vector<Vector3d> points, double lift) {
  constexpr double chordSag = 0.002;    // of the radius: chords of an arc dip below it
  constexpr double finestPart = 0.002;  // [m]
  const Placement<double> X_GC = body * placementOf(wrap.frame), X_CG = inverse(X_GC);
  const double top = wrap.radius + lift;
  // Points in between, where the line is near the surface.
  std::vector<Vector3d> fine;
  bool near = false;
  Vector3d before = Vector3d::Zero();
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vector3d p_C = X_CG.R * points[k] + X_CG.p;
    if (k > 0) {
      const Vector3d part = p_C - before;
      const int count = static_cast<int>(std::ceil(part.norm() / finestPart));
      for (int i = 1; i < count; ++i) {
        const Vector3d between = before + part * (static_cast<double>(i) / count);
        const double distance = spokeTo(wrap, between).norm();
        if (distance < wrap.radius * (1 - chordSag)) return points;
        if (distance < top) {
          fine.push_back(between);
          near = true;
        }
      }
    }
    if (spokeTo(wrap, p_C).norm() < wrap.radius * (1 - chordSag)) return points;
    near = near || spokeTo(wrap, p_C).norm() < top;
    fine.push_back(p_C);
    before = p_C;
  }
  if (!near) return points;
  for (std::size_t k = 0; k < fine.size(); ++k) {
    const Vector3d spoke = spokeTo(wrap, fine[k]);
    const bool isEnd = k == 0 || k + 1 == fine.size();
    if (!isEnd && spoke.norm() < top) fine[k] += spoke * (top / spoke.norm() - 1);
    fine[k] = X_GC.R * fine[k] + X_GC.p;
  }
  return fine;
}

}  // namespace bio::view
