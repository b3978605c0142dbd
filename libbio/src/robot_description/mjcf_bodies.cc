#include <fmt/format.h>

#include <cmath>

#include "robot_description/mjcf.h"
#include "robot_description/read_mjcf.h"

namespace bio::robot {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

// Children of a body that neither move nor weigh anything.
bool isSeenOnly(std::string_view tag) {
  return tag == "site" || tag == "camera" || tag == "light";
}

}  // namespace

Model MjcfReading::run() {
  maker_.model().name = textOf(root_, "model");
  static const std::set<std::string, std::less<>> known{
      "compiler", "option",  "size",     "visual",    "statistic", "asset",
      "custom",   "default", "sensor",   "keyframe",  "worldbody", "contact",
      "equality", "tendon",  "actuator", "extension", "deformable"};
  for (const Element* child : documents_.childrenOf(root_)) {
    if (!known.contains(child->Name())) {
      documents_.fail(*child, "is no section of an MJCF that is known");
    }
  }
  readSettings();
  for (const Element* world : documents_.childrenOf(root_, "worldbody")) reserveNames(*world);
  maker_.model().gravity = settings_.has("gravity") ? settings_.gravity : Vector3d::Zero();
  for (const Element* world : documents_.childrenOf(root_, "worldbody")) readWorld(*world);
  if (maker_.model().bodies.empty()) {
    documents_.fail(root_, "has no body in its worldbody, must have one or more");
  }
  scaleMasses();
  readForces();
  warnOfContacts();
  return maker_.finished();
}

// A name that a part gets must not be that of a later one.
void MjcfReading::reserveNames(const Element& owner) {
  for (const Element* child : documents_.childrenOf(owner)) {
    if (isSeenOnly(child->Name())) continue;
    if (const char* name = child->Attribute("name")) maker_.reserve(name);
    reserveNames(*child);
  }
}

void MjcfReading::readWorld(const Element& world) {
  std::vector<MjcfChild> parts;
  const std::string childClass = textOf(world, "childclass");
  defaults_.requireClass(world, childClass);
  collect(world, {}, childClass, parts);
  for (const MjcfChild& part : parts) {
    const std::string_view tag = part.element->Name();
    if (tag == "body") readBody(part, "ground", false);
    if (tag == "geom") {
      const MjcfElement geom = with(part, {"geom"});
      if (geom.number("contype", Rule::finite, 1) != 0 ||
          geom.number("conaffinity", Rule::finite, 1) != 0)
        ++touching_;
    }
    if (tag == "joint" || tag == "freejoint" || tag == "inertial") {
      documents_.fail(*part.element, "stands in the worldbody, must stand in a body");
    }
  }
}

void MjcfReading::collect(const Element& owner, const Transform& X, const std::string& childClass,
                          std::vector<MjcfChild>& children) const {
  for (const Element* child : documents_.childrenOf(owner)) {
    const std::string_view tag = child->Name();
    if (isSeenOnly(tag)) continue;
    if (tag == "frame") {
      const std::string own = textOf(*child, "childclass");
      defaults_.requireClass(*child, own);
      const MjcfElement frame(documents_, defaults_, *child, childClass, {});
      collect(*child, X * frame.placement(settings_), own.empty() ? childClass : own, children);
      continue;
    }
    const bool isInFrame = std::string_view(owner.Name()) == "frame";
    const bool joins = tag == "joint" || tag == "freejoint" || tag == "inertial";
    if (!joins && tag != "body" && tag != "geom") {
      documents_.fail(*child, "is not supported inside a body");
    }
    if (joins && isInFrame) {
      documents_.fail(*child, "stands in a <frame>, must stand in the body itself");
    }
    children.push_back({child, X, childClass});
  }
}

void MjcfReading::readBody(const MjcfChild& child, const std::string& parent, bool moves) {
  const Element& element = *child.element;
  const std::string name =
      element.Attribute("name") ? maker_.nameOf(element) : maker_.newBodyName(parent + "_body");
  if (element.Attribute("name")) maker_.requireNewBody(element, name);
  const std::string own = textOf(element, "childclass");
  defaults_.requireClass(element, own);
  const std::string childClass = own.empty() ? child.childClass : own;
  const Transform X = child.X * with({child.element, {}, {}}, {}).placement(settings_);
  if (textOf(element, "mocap") == "true") {
    maker_.isNotSimulated("motion of mocap bodies, which stand still", name);
  }
  if (documents_.number(element, "gravcomp", Rule::finite, 0.0) != 0) {
    maker_.isNotSimulated("compensation of gravity (gravcomp)", name);
  }
  std::vector<MjcfChild> parts, joints;
  collect(element, {}, childClass, parts);
  for (const MjcfChild& part : parts) {
    const std::string_view tag = part.element->Name();
    if (tag == "joint" || tag == "freejoint") joints.push_back(part);
  }
  const bool isMoving = moves || !joints.empty();
  maker_.addBody(name, massOf(element, parts, isMoving));
  const auto isFree = [&](const MjcfChild& joint) {
    return std::string_view(joint.element->Name()) == "freejoint" ||
           with(joint, {"joint"}).text("type", "hinge") == "free";
  };
  if (!joints.empty() && isFree(joints.front())) {
    const Element& joint = *joints.front().element;
    if (joints.size() > 1) documents_.fail(element, "has joints beside its free joint");
    if (parent != "ground") documents_.fail(joint, "is free, its body must stand in the worldbody");
    const std::string jointNamed = jointName(joint, name);
    maker_.joinFree("ground", {}, name, jointNamed, X);
    if (joint.Attribute("name")) joints_[textOf(joint, "name")] = {};
    if (std::string_view(joint.Name()) == "joint")
      warnOfUnscaled(with(joints.front(), {"joint"}), jointNamed);
  } else {
    maker_.join(parent, X, name, readJoints(element, name, joints));
  }
  for (const MjcfChild& part : parts) {
    if (std::string_view(part.element->Name()) == "body") readBody(part, name, isMoving);
  }
}

MassProperties MjcfReading::massOf(const Element& body, const std::vector<MjcfChild>& parts,
                                   bool moves) {
  const Element* inertial = nullptr;
  std::vector<MassProperties> solids;
  for (const MjcfChild& part : parts) {
    if (std::string_view(part.element->Name()) == "inertial") {
      if (inertial) documents_.fail(*part.element, "is a second inertial of its body");
      inertial = part.element;
    }
  }
  const bool fromGeoms =
      settings_.inertiaFromGeoms == "true" || (settings_.inertiaFromGeoms == "auto" && !inertial);
  for (const MjcfChild& part : parts) {
    if (std::string_view(part.element->Name()) != "geom") continue;
    const MjcfElement geom = with(part, {"geom"});
    // what stands still needs no mass, unless it counts for the total
    if (fromGeoms && (moves || settings_.totalMass > 0))
      solids.push_back(massOfGeom(geom, body, part.X));
    if (geom.number("contype", Rule::finite, 1) != 0 ||
        geom.number("conaffinity", Rule::finite, 1) != 0) {
      ++touching_;
      if (moves) ++touchingMoves_;
    }
  }
  if (fromGeoms || !inertial) return bounded(sum(solids));
  const MjcfElement given(documents_, defaults_, *inertial, {}, {});
  MassProperties mass;
  mass.mass = documents_.number(*inertial, "mass", Rule::notNegative);
  const auto full = given.numbers("fullinertia"), diagonal = given.numbers("diaginertia");
  if (!full.empty() && !diagonal.empty()) {
    documents_.fail(*inertial, "has fullinertia and diaginertia, must have one");
  }
  if (!full.empty()) {
    if (full.size() != 6) documents_.fail(*inertial, "fullinertia must have 6 numbers");
    mass.inertia << full[0], full[3], full[4], full[3], full[1], full[5], full[4], full[5], full[2];
  } else if (!diagonal.empty()) {
    if (diagonal.size() != 3) documents_.fail(*inertial, "diaginertia must have 3 numbers");
    mass.inertia.diagonal() = Vector3d(diagonal[0], diagonal[1], diagonal[2]);
  }
  for (int i = 0; i < 3; ++i) {
    documents_.ruled(*inertial, "inertia", mass.inertia(i, i), Rule::notNegative);
  }
  return bounded(mass.placed(given.placement(settings_)));
}

MassProperties MjcfReading::bounded(MassProperties mass) const {
  mass.mass = std::max(mass.mass, settings_.leastMass);
  if (settings_.leastInertia == 0 && !settings_.balancesInertia) return mass;
  const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(mass.inertia);
  Vector3d principal = axes.eigenvalues().cwiseMax(settings_.leastInertia);
  if (settings_.balancesInertia && principal[0] + principal[1] < principal[2]) {
    principal.setConstant(principal.mean());
  }
  mass.inertia = axes.eigenvectors() * principal.asDiagonal() * axes.eigenvectors().transpose();
  return mass;
}

void MjcfReading::scaleMasses() {
  if (!(settings_.totalMass > 0)) return;
  double total = 0;
  for (const Body& body : maker_.model().bodies) total += body.mass;
  if (!(total > 0)) return;
  const double factor = settings_.totalMass / total;
  for (Body& body : maker_.model().bodies) {
    body.mass *= factor;
    for (double& each : body.inertia) each *= factor;
  }
}

Model readMjcf(const Documents& documents, const Element& root) {
  return MjcfReading(documents, root).run();
}

}  // namespace bio::robot
