#include <fmt/format.h>

#include "robot_description/mjcf.h"

namespace bio::robot {

using Eigen::Vector3d;

std::string MjcfReading::jointName(const Element& joint, const std::string& bodyName) {
  if (!joint.Attribute("name")) return maker_.newCoordinateName(bodyName + "_joint");
  const std::string name = maker_.nameOf(joint);
  maker_.requireNewCoordinate(joint, name);
  return name;
}

std::vector<Motion> MjcfReading::readJoints(const Element& body, const std::string& bodyName,
                                            const std::vector<MjcfChild>& joints) {
  std::vector<Motion> motions;
  for (const MjcfChild& child : joints) {
    const MjcfElement joint = with(child, {"joint"});
    const bool isFree = std::string_view(child.element->Name()) == "freejoint";
    const std::string type = isFree ? "free" : joint.text("type", "hinge");
    const std::string name = jointName(*child.element, bodyName);
    if (type == "hinge" || type == "slide") {
      readHinge(joint, name, type == "hinge", motions);
      if (child.element->Attribute("name")) {
        joints_[textOf(*child.element, "name")] = {name, motions.back().zero};
      }
    } else if (type == "ball") {
      readBall(joint, name, motions);
      if (child.element->Attribute("name")) joints_[textOf(*child.element, "name")] = {};
    } else if (type == "free") {
      documents_.fail(body, "has joints beside its free joint");
    } else {
      documents_.fail(*child.element,
                      fmt::format("type = '{}', must be hinge, slide, ball or free", type));
    }
  }
  return motions;
}

void MjcfReading::readHinge(const MjcfElement& joint, const std::string& name, bool turns,
                            std::vector<Motion>& motions) {
  const Element& element = joint.element();
  const double unit = turns ? settings_.angle : 1.0;
  Motion motion;
  motion.turns = turns;
  const Vector3d axis = joint.vector("axis", Vector3d::UnitZ());
  if (!(axis.norm() > 0)) documents_.fail(element, "axis = 0 0 0, must have a length > 0");
  motion.axis = axis.stableNormalized();
  motion.anchor = joint.vector("pos", Vector3d::Zero());
  motion.zero = joint.number("ref", Rule::finite, 0) * unit;
  motion.coordinate = coordinateCalled(name, turns);
  motion.coordinate.defaultValue = motion.zero;
  const auto range = joint.numbers("range");
  const std::string limited = joint.text("limited", "auto");
  const bool isLimited =
      limited == "true" || (limited == "auto" && settings_.limitsFromRanges && !range.empty());
  if (isLimited && settings_.has("limit")) {
    if (range.size() != 2) documents_.fail(element, "range must have 2 numbers");
    if (!(range[0] <= range[1])) {
      documents_.fail(element, fmt::format("range = {} to {}, must not fall", range[0], range[1]));
    }
    motion.coordinate.rangeMin = range[0] * unit;
    motion.coordinate.rangeMax = range[1] * unit;
  }
  motions.push_back(motion);

  if (joint.has("springdamper")) {
    const auto pair = joint.numbers("springdamper");
    if (pair.size() != 2 || (pair[0] > 0 && pair[1] > 0)) {
      documents_.fail(element, "has a springdamper, must have stiffness and damping instead");
    }
  }
  JointForces forces;
  if (settings_.has("damper")) forces.damping = joint.number("damping", Rule::notNegative, 0);
  if (settings_.has("spring")) {
    forces.stiffness = joint.number("stiffness", Rule::notNegative, 0);
    forces.rest = joint.number("springref", Rule::finite, 0) * unit;
  }
  if (settings_.has("frictionloss"))
    forces.friction = joint.number("frictionloss", Rule::notNegative, 0);
  maker_.addForces(name, forces);
  if (joint.number("armature", Rule::notNegative, 0) > 0)
    maker_.isNotSimulated("the rotors' inertia (armature)", name);
}

// The same turns in space, by three angles in place of a quaternion.
void MjcfReading::readBall(const MjcfElement& joint, const std::string& name,
                           std::vector<Motion>& motions) {
  for (int i = 0; i < 3; ++i) {
    Motion motion;
    motion.axis = Vector3d::Unit(i);
    motion.anchor = joint.vector("pos", Vector3d::Zero());
    motion.coordinate =
        coordinateCalled(maker_.newCoordinateName(fmt::format("{}_r{}", name, "xyz"[i])), true);
    motions.push_back(motion);
  }
  maker_.model().remarks.push_back(
      fmt::format("ball joint '{0}' has the body-fixed angles {0}_rx, {0}_ry and {0}_rz about x, y "
                  "and z in place of a quaternion: {0}_ry must stay within a right angle",
                  name));
  warnOfUnscaled(joint, name);
}

// Forces on the speed of a turn in space are none on the rates of its angles.
void MjcfReading::warnOfUnscaled(const MjcfElement& joint, const std::string& name) {
  for (const char* attribute : {"damping", "stiffness", "frictionloss", "armature"}) {
    if (joint.number(attribute, Rule::notNegative, 0) > 0) {
      maker_.isNotSimulated(fmt::format("{} of ball and free joints", attribute), name);
    }
  }
  if (!joint.numbers("range").empty() && joint.text("limited", "auto") != "false")
    maker_.isNotSimulated("the range of ball joints", name);
}

}  // namespace bio::robot
