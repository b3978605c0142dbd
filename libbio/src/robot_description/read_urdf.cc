#include "robot_description/read_urdf.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <set>

namespace bio::robot {
namespace {

using Eigen::Vector3d;

struct UrdfJoint {
  const Element* element;
  std::string name, kind, parent, child;  ///< parent and child as in the file
};

class UrdfReading {
 public:
  UrdfReading(const Documents& documents, const Element& robot)
      : documents_(documents), robot_(robot), maker_(documents) {}

  Model run() {
    maker_.model().name = textOf(robot_, "name");
    maker_.model().gravity = {0, 0, -9.81};
    for (const Element* child : documents_.childrenOf(robot_)) {
      const std::string_view tag = child->Name();
      if (tag.starts_with("xacro:")) {
        documents_.fail(*child, "is of xacro: let xacro make a URDF of the file first");
      }
      if (tag == "link") addLink(*child);
      if (tag == "joint") addJoint(*child);
    }
    if (links_.empty()) documents_.fail(robot_, "has no link, must have one or more");
    const std::vector<UrdfJoint*> order = inOrder(rootLink());
    for (const UrdfJoint* joint : order) build(*joint);
    for (const UrdfJoint* joint : order) couple(*joint);
    return maker_.finished();
  }

 private:
  // Vectors of three numbers of a child element's attribute, 0 0 0 where absent.
  Vector3d vectorOf(const Element* element, const char* attribute, const Vector3d& fallback) const {
    const char* text = element ? element->Attribute(attribute) : nullptr;
    if (!text) return fallback;
    const auto v = documents_.numbers(*element, attribute, text, 3);
    return {v[0], v[1], v[2]};
  }
  Transform originOf(const Element& owner) const {
    const Element* origin = owner.FirstChildElement("origin");
    return {fromRollPitchYaw(vectorOf(origin, "rpy", Vector3d::Zero())),
            vectorOf(origin, "xyz", Vector3d::Zero())};
  }
  const Element& childOf(const Element& owner, const char* tag) const {
    const Element* child = owner.FirstChildElement(tag);
    if (!child) documents_.fail(owner, fmt::format("has no <{}>, must have one", tag));
    return *child;
  }

  void addLink(const Element& element) {
    const std::string name = textOf(element, "name");
    if (name.empty()) documents_.fail(element, "has no name, must have one");
    const auto [found, isNew] = links_.emplace(name, &element);
    if (!isNew) {
      documents_.fail(element, fmt::format("is a second link of this name (the first is in line "
                                           "{}), names must be unique",
                                           found->second->GetLineNum()));
    }
    linkOrder_.push_back(name);
  }

  void addJoint(const Element& element) {
    UrdfJoint joint{&element, textOf(element, "name"), textOf(element, "type"),
                    textOf(childOf(element, "parent"), "link"),
                    textOf(childOf(element, "child"), "link")};
    static const std::set<std::string> kinds{"fixed",     "revolute", "continuous",
                                             "prismatic", "floating", "planar"};
    if (!kinds.contains(joint.kind)) {
      documents_.fail(element, fmt::format("type = '{}', must be revolute, continuous, prismatic, "
                                           "fixed, floating or planar",
                                           joint.kind));
    }
    if (joint.name.empty()) documents_.fail(element, "has no name, must have one");
    const auto [found, isNew] = joints_.emplace(joint.name, joint);
    if (!isNew) {
      documents_.fail(element, fmt::format("is a second joint of this name (the first is in line "
                                           "{}), names must be unique",
                                           found->second.element->GetLineNum()));
    }
    jointOrder_.push_back(&found->second);
  }

  const std::string& rootLink() {
    // as Drake has it: a world need not be listed
    for (const UrdfJoint* joint : jointOrder_) {
      if (joint->parent == "world" && links_.emplace("world", joint->element).second)
        linkOrder_.insert(linkOrder_.begin(), "world");
    }
    std::map<std::string, const Element*> movedBy;
    for (const UrdfJoint* joint : jointOrder_) {
      for (const auto& [end, link] :
           {std::pair("parent", &joint->parent), std::pair("child", &joint->child)}) {
        if (links_.contains(*link)) continue;
        documents_.fail(*joint->element,
                        fmt::format("{} = '{}', must name a link of the robot", end, *link));
      }
      const auto [found, isNew] = movedBy.emplace(joint->child, joint->element);
      if (!isNew) {
        documents_.fail(*joint->element,
                        fmt::format("is a second joint that moves link '{}' (the first is in line "
                                    "{}), a closed loop is not supported",
                                    joint->child, found->second->GetLineNum()));
      }
    }
    const std::string* root = nullptr;
    for (const std::string& link : linkOrder_) {
      if (movedBy.contains(link)) continue;
      if (root) {
        documents_.fail(*links_.at(link), fmt::format("is a second root beside link '{}': no joint "
                                                      "moves either, a robot must be one tree",
                                                      *root));
      }
      root = &link;
    }
    if (!root) {
      documents_.fail(robot_,
                      "has no root: every link is moved by a joint, its links form a "
                      "closed loop");
    }
    return *root;
  }

  // Parents before children; the root link stands on the ground.
  std::vector<UrdfJoint*> inOrder(const std::string& root) {
    std::map<std::string, std::vector<UrdfJoint*>> below;
    for (UrdfJoint* joint : jointOrder_) below[joint->parent].push_back(joint);
    if (root == "ground" || root == "world") {
      // the ground itself, unless it has a mass that a user may ask for
      bodyOf_[root] = "ground";
    } else {
      bodyOf_[root] = addLinkBody(root);
      maker_.join("ground", {}, bodyOf_[root], {});
    }
    std::vector<UrdfJoint*> order;
    std::deque<std::string> waiting{root};
    std::set<const UrdfJoint*> placed;
    while (!waiting.empty()) {
      for (UrdfJoint* joint : below[waiting.front()]) {
        order.push_back(joint);
        placed.insert(joint);
        waiting.push_back(joint->child);
      }
      waiting.pop_front();
    }
    for (const UrdfJoint* joint : jointOrder_) {
      if (placed.contains(joint)) continue;
      documents_.fail(*joint->element, fmt::format("is not connected with the root link '{}', its "
                                                   "links form a closed loop",
                                                   root));
    }
    return order;
  }

  std::string addLinkBody(const std::string& link) {
    const Element& element = *links_.at(link);
    const std::string name = maker_.nameOf(element);
    maker_.requireNewBody(element, name);
    maker_.addBody(name, massOf(element));
    return name;
  }

  MassProperties massOf(const Element& link) const {
    const Element* inertial = link.FirstChildElement("inertial");
    if (!inertial) return {};
    MassProperties mass;
    const Element& number = childOf(*inertial, "mass");
    mass.mass = numberOf(link, number, "value", Rule::notNegative);
    const Element* inertia = inertial->FirstChildElement("inertia");
    if (!inertia && mass.mass > 0) documents_.fail(link, "its inertial has no <inertia>");
    if (inertia) {
      const auto moment = [&](const char* name) {
        const double value = numberOf(link, *inertia, name, Rule::finite);
        // what rounding leaves of nothing
        if (value < 0 && value > -1e-15) return 0.0;
        return documents_.ruled(link, name, value, Rule::notNegative);
      };
      const auto product = [&](const char* name) {
        return inertia->Attribute(name) ? numberOf(link, *inertia, name, Rule::finite) : 0.0;
      };
      const double xx = moment("ixx"), yy = moment("iyy"), zz = moment("izz");
      const double xy = product("ixy"), xz = product("ixz"), yz = product("iyz");
      mass.inertia << xx, xy, xz, xy, yy, yz, xz, yz, zz;
      if (mass.inertia.cwiseAbs().maxCoeff() < 1e-15) mass.inertia.setZero();
    }
    return mass.placed(originOf(*inertial));
  }
  // The message names the owner, which has a name.
  double numberOf(const Element& owner, const Element& element, const char* attribute,
                  Rule rule) const {
    const char* text = element.Attribute(attribute);
    if (!text) documents_.fail(owner, fmt::format("its <{}> has no {}", element.Name(), attribute));
    const std::string quantity =
        std::string_view(attribute) == "value" ? element.Name() : attribute;
    const double value = documents_.numbers(owner, quantity.c_str(), text, 1).front();
    return documents_.ruled(owner, quantity.c_str(), value, rule);
  }

  void build(const UrdfJoint& joint) {
    const Element& element = *joint.element;
    const std::string parent = bodyOf_.at(joint.parent);
    const std::string body = bodyOf_[joint.child] = addLinkBody(joint.child);
    const Transform X = originOf(element);
    const std::string name = maker_.nameOf(element);
    if (joint.kind == "fixed") {
      maker_.join(parent, X, body, {}, name);
      return;
    }
    maker_.requireNewCoordinate(element, name);
    if (joint.kind == "floating") {
      maker_.joinFree(parent, X, body, name, {});
      return;
    }
    const Vector3d axis = vectorOf(element.FirstChildElement("axis"), "xyz", Vector3d::UnitX());
    if (!(axis.norm() > 0)) documents_.fail(element, "axis = 0 0 0, must have a length > 0");
    if (joint.kind == "planar") {
      buildPlanar(element, name, parent, X, body, axis);
      return;
    }
    Motion motion;
    motion.turns = joint.kind != "prismatic";
    motion.axis = axis.stableNormalized();
    motion.coordinate = coordinateCalled(name, motion.turns);
    if (joint.kind != "continuous") readLimit(element, motion.coordinate);
    maker_.join(parent, X, body, {motion});
    coordinateOf_[joint.name] = name;
    const Element* dynamics = element.FirstChildElement("dynamics");
    if (!dynamics) return;
    JointForces forces;
    forces.damping = documents_.number(*dynamics, "damping", Rule::notNegative, 0.0);
    forces.friction = documents_.number(*dynamics, "friction", Rule::notNegative, 0.0);
    maker_.addForces(name, forces);
  }

  // URDF says no directions in the plane: they are the joint's x and y where z is the normal.
  void buildPlanar(const Element& element, const std::string& name, const std::string& parent,
                   const Transform& X, const std::string& body, const Vector3d& axis) {
    if (axis.stableNormalized() != Vector3d::UnitZ()) {
      documents_.fail(element,
                      "a planar joint must have the axis 0 0 1: for another, URDF does not "
                      "say along which directions its coordinates run");
    }
    std::vector<Motion> motions(3);
    const char* endings[] = {"_x", "_y", "_yaw"};
    for (int i = 0; i < 3; ++i) {
      Motion& motion = motions[static_cast<std::size_t>(i)];
      motion.turns = i == 2;
      motion.axis = Vector3d::Unit(i);
      motion.coordinate = coordinateCalled(maker_.newCoordinateName(name + endings[i]), i == 2);
    }
    maker_.join(parent, X, body, motions, name);
  }

  void readLimit(const Element& element, Coordinate& coordinate) {
    const Element* limit = element.FirstChildElement("limit");
    if (!limit) {
      maker_.model().remarks.push_back(
          fmt::format("{} has no <limit> and is read without", label(element)));
      return;
    }
    if (!limit->Attribute("lower") && !limit->Attribute("upper")) return;
    const double lower = documents_.number(*limit, "lower", Rule::finite, 0.0),
                 upper = documents_.number(*limit, "upper", Rule::finite, 0.0);
    if (!(lower <= upper)) {
      documents_.fail(element, fmt::format("limit from {} to {}, must not fall", lower, upper));
    }
    coordinate.rangeMin = lower;
    coordinate.rangeMax = upper;
  }

  // q = multiplier·q_other + offset; through joints that follow themselves.
  void couple(const UrdfJoint& joint) {
    if (!mimicOf(joint) || joint.kind == "fixed") return;
    if (!coordinateOf_.contains(joint.name)) {
      documents_.fail(*joint.element, "has a <mimic>, but is no joint of one coordinate");
    }
    LinearFunction line{1, 0};
    const UrdfJoint* at = &joint;
    std::set<const UrdfJoint*> passed;
    while (const Element* mimic = mimicOf(*at)) {
      if (!passed.insert(at).second) {
        documents_.fail(*joint.element, "follows itself by its <mimic>");
      }
      line.intercept += line.slope * documents_.number(*mimic, "offset", Rule::finite, 0.0);
      line.slope *= documents_.number(*mimic, "multiplier", Rule::finite, 1.0);
      const auto found = joints_.find(textOf(*mimic, "joint"));
      if (found == joints_.end() || !coordinateOf_.contains(found->first)) {
        documents_.fail(*at->element,
                        fmt::format("mimic of joint '{}', must name a joint of one coordinate",
                                    textOf(*mimic, "joint")));
      }
      at = &found->second;
    }
    maker_.addCoupler(*joint.element, coordinateOf_.at(joint.name), coordinateOf_.at(at->name),
                      {1, line});
  }
  static const Element* mimicOf(const UrdfJoint& joint) {
    return joint.element->FirstChildElement("mimic");
  }

  const Documents& documents_;
  const Element& robot_;
  ModelMaker maker_;
  std::map<std::string, const Element*> links_;
  std::vector<std::string> linkOrder_;
  std::map<std::string, UrdfJoint> joints_;
  std::vector<UrdfJoint*> jointOrder_;
  std::map<std::string, std::string> bodyOf_, coordinateOf_;  ///< by names of the file
};

}  // namespace

Model readUrdf(const Documents& documents, const Element& robot) {
  return UrdfReading(documents, robot).run();
}

}  // namespace bio::robot
