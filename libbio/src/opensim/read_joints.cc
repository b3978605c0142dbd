#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>

#include "opensim/reading.h"

namespace bio::osim {
namespace {

const std::array<const char*, 6> axisNames = {"rotation1",    "rotation2",    "rotation3",
                                              "translation1", "translation2", "translation3"};

// Joints that are a custom joint with fixed axes: which axis each coordinate drives, in OpenSim's
// order of coordinates (0–2 turn about x, y, z; 3–5 shift along x, y, z).
const std::map<std::string_view, std::vector<std::size_t>> fixedJoints = {
    {"PinJoint", {2}},          {"SliderJoint", {3}},       {"UniversalJoint", {0, 1}},
    {"PlanarJoint", {2, 3, 4}}, {"GimbalJoint", {0, 1, 2}}, {"FreeJoint", {0, 1, 2, 3, 4, 5}},
};

std::array<TransformAxis, 6> plainAxes() {
  std::array<TransformAxis, 6> axes;
  for (std::size_t i = 0; i < 6; ++i) {
    axes[i].axis = Eigen::Vector3d::Unit(static_cast<Eigen::Index>(i % 3));
    axes[i].function = {1, ConstantFunction{0}};
  }
  return axes;
}

// As in OpenSim, a coordinate without a function is free.
void readPrescribed(Reading& reading, const Element& element, Coordinate& coordinate) {
  if (!readFlag(reading.source, element, "prescribed", false)) return;
  const Element* function = findFunction(element, "prescribed_function");
  if (!function) {
    reading.model.warnings.push_back(fmt::format(
        "{}: is prescribed, but has no prescribed_function: it is not prescribed", label(element)));
    return;
  }
  coordinate.prescribed = true;
  if (isReadableFunction(*function)) {
    coordinate.prescribedFunction = readFunction(reading, *function);
    return;
  }
  if (coordinate.locked) return;  // which comes first
  reading.model.warnings.push_back(
      fmt::format("{}: its prescribed_function is a {}, which is not known: simulations need "
                  "--prescribe, --lock or --coordinate for it",
                  label(element), function->Name()));
}

Coordinate readCoordinate(Reading& reading, const Element& element) {
  const Source& source = reading.source;
  Coordinate coordinate;
  coordinate.name = nameOf(source, element);
  coordinate.defaultValue = readNumber(source, element, "default_value", "", Rule::finite, 0.0);
  const auto range = readNumbers(source, element, "range", "", 2, std::vector<double>{-10, 10});
  if (!(range[0] <= range[1])) {
    fail(source, element, fmt::format("range = {} to {}, must not fall", range[0], range[1]),
         element.FirstChildElement("range"));
  }
  coordinate.rangeMin = range[0];
  coordinate.rangeMax = range[1];
  coordinate.locked = readFlag(source, element, "locked", false);
  coordinate.clamped = readFlag(source, element, "clamped", false);
  readPrescribed(reading, element, coordinate);
  return coordinate;
}

void readTransform(Reading& reading, const Element& element, Joint& joint) {
  const Source& source = reading.source;
  joint.axes = plainAxes();
  const Element* transform = element.FirstChildElement("SpatialTransform");
  if (!transform) fail(source, element, "SpatialTransform is missing, must be given");
  for (const Element* child : childrenOf(transform)) {
    const std::string name = nameOf(source, *child);
    const auto at = std::find(axisNames.begin(), axisNames.end(), name);
    if (at == axisNames.end()) {
      fail(source, *child, "must be called rotation1–3 or translation1–3");
    }
    TransformAxis& axis = joint.axes[static_cast<std::size_t>(at - axisNames.begin())];
    axis.coordinate = readText(source, *child, "coordinates", "");
    const auto a = readNumbers(source, *child, "axis", "", 3,
                               std::vector<double>{axis.axis.x(), axis.axis.y(), axis.axis.z()});
    axis.axis = {a[0], a[1], a[2]};
    if (!(axis.axis.norm() > 0)) {
      fail(source, *child, "axis = 0 0 0, must have a length > 0",
           child->FirstChildElement("axis"));
    }
    if (const Element* function = findFunction(*child, "function")) {
      axis.function = readFunction(reading, *function);
    }
    if (axis.coordinate.empty() && !std::holds_alternative<ConstantFunction>(axis.function.shape)) {
      fail(source, *child, "function depends on a coordinate, but coordinates is empty",
           child->FirstChildElement("coordinates"));
    }
    const bool known = std::any_of(joint.coordinates.begin(), joint.coordinates.end(),
                                   [&](const Coordinate& c) { return c.name == axis.coordinate; });
    if (!axis.coordinate.empty() && !known) {
      fail(
          source, *child,
          fmt::format("coordinates = '{}', must name one coordinate of the joint", axis.coordinate),
          child->FirstChildElement("coordinates"));
    }
  }
}

// A coordinate is an angle if it drives a rotation.
void classifyCoordinates(Reading& reading, const Element& element, Joint& joint) {
  std::erase_if(joint.coordinates, [&](const Coordinate& coordinate) {
    const bool drives = std::any_of(joint.axes.begin(), joint.axes.end(), [&](const auto& axis) {
      return axis.coordinate == coordinate.name;
    });
    if (!drives) {
      reading.model.warnings.push_back(
          fmt::format("{}: coordinate '{}' drives none of the joint's axes and was left out",
                      label(element), coordinate.name));
    }
    return !drives;
  });
  for (Coordinate& coordinate : joint.coordinates) {
    bool turns = false;
    for (std::size_t i = 0; i < 6; ++i) {
      if (i < 3 && joint.axes[i].coordinate == coordinate.name) turns = true;
    }
    coordinate.isRotation = turns;
  }
}

void readKind(Reading& reading, const Element& element, Joint& joint) {
  const Source& source = reading.source;
  const std::string_view kind = element.Name();
  joint.axes = plainAxes();
  if (kind == "WeldJoint") {
    joint.kind = JointKind::weld;
    joint.coordinates.clear();
    return;
  }
  if (kind == "CustomJoint") {
    joint.kind = JointKind::custom;
    readTransform(reading, element, joint);
    classifyCoordinates(reading, element, joint);
    return;
  }
  const auto fixed = fixedJoints.find(kind);
  if (fixed == fixedJoints.end()) {
    fail(source, element,
         fmt::format("joint of class {}, must be one of WeldJoint, PinJoint, SliderJoint, "
                     "CustomJoint, UniversalJoint, PlanarJoint, GimbalJoint, FreeJoint",
                     kind));
  }
  const auto& axes = fixed->second;
  if (joint.coordinates.size() != axes.size()) {
    fail(source, element,
         fmt::format("has {} coordinates, must have {}", joint.coordinates.size(), axes.size()));
  }
  for (std::size_t i = 0; i < axes.size(); ++i) {
    joint.axes[axes[i]].coordinate = joint.coordinates[i].name;
    joint.axes[axes[i]].function = {1, LinearFunction{1, 0}};
  }
  classifyCoordinates(reading, element, joint);
  joint.kind = kind == "PinJoint"      ? JointKind::pin
               : kind == "SliderJoint" ? JointKind::slider
                                       : JointKind::custom;
}

FramePlacement readPlacement(const Source& source, const Element& element, const char* location,
                             const char* orientation) {
  const std::vector<double> zero(3, 0.0);
  const auto p = readNumbers(source, element, location, "m", 3, zero);
  const auto o = readNumbers(source, element, orientation, "rad", 3, zero);
  return {{p[0], p[1], p[2]}, {o[0], o[1], o[2]}};
}

void requireBody(const Reading& reading, const Element& element, const char* property,
                 const std::string& name) {
  if (name == "ground" || reading.frames.contains("/bodyset/" + name)) return;
  fail(reading.source, element,
       fmt::format("{} = '{}', must name a body of the model", property, name),
       element.FirstChildElement(property));
}

struct FoundJoint {
  const Element* element;
  std::string childBody;  ///< OpenSim 3 only: the body that the joint stands in
};

std::vector<FoundJoint> findJoints(const Source& source, const Element& model) {
  std::vector<FoundJoint> found;
  for (const Element* element : objectsOf(model, "JointSet")) found.push_back({element, ""});
  for (const Element* body : objectsOf(model, "BodySet")) {
    for (const Element* joint : childrenOf(body->FirstChildElement("Joint"))) {
      found.push_back({joint, nameOf(source, *body)});
    }
  }
  return found;
}

Joint readJoint(Reading& reading, const FoundJoint& found) {
  const Element& element = *found.element;
  const Source& source = reading.source;
  Joint joint;
  joint.name = nameOf(source, element);
  if (found.childBody.empty()) {
    const std::string path = "/jointset/" + joint.name;
    const BodyFrame parent = resolveFrame(reading, element, path, "socket_parent_frame");
    const BodyFrame child = resolveFrame(reading, element, path, "socket_child_frame");
    joint.parentBody = parent.body;
    joint.parentFrame = parent.placement;
    joint.childBody = child.body;
    joint.childFrame = child.placement;
  } else {
    joint.parentBody = readText(source, element, "parent_body");
    requireBody(reading, element, "parent_body", joint.parentBody);
    joint.parentFrame =
        readPlacement(source, element, "location_in_parent", "orientation_in_parent");
    joint.childBody = found.childBody;
    joint.childFrame = readPlacement(source, element, "location", "orientation");
    if (readFlag(source, element, "reverse", false)) {
      fail(source, element, "reverse = true, must be false: a reversed joint is not supported",
           element.FirstChildElement("reverse"));
    }
  }
  for (const Element* c : childrenOf(element.FirstChildElement("coordinates"))) {
    joint.coordinates.push_back(readCoordinate(reading, *c));
  }
  for (const Element* c : objectsOf(element, "CoordinateSet")) {
    joint.coordinates.push_back(readCoordinate(reading, *c));
  }
  readKind(reading, element, joint);
  return joint;
}

}  // namespace

void readJoints(Reading& reading, const Element& model) {
  const Source& source = reading.source;
  std::map<std::string, int> jointNames, coordinateNames;
  std::map<std::string, const Element*> jointOf;  // by child body
  std::vector<Joint> waiting;
  for (const FoundJoint& found : findJoints(source, model)) {
    requireNewName(reading, *found.element, "joint", jointNames);
    Joint joint = readJoint(reading, found);
    for (const Element* c : childrenOf(found.element->FirstChildElement("coordinates"))) {
      requireNewName(reading, *c, "coordinate", coordinateNames);
    }
    for (const Element* c : objectsOf(*found.element, "CoordinateSet")) {
      requireNewName(reading, *c, "coordinate", coordinateNames);
    }
    if (joint.childBody == "ground") {
      fail(source, *found.element, "moves the ground, the child must be a body");
    }
    if (!jointOf.emplace(joint.childBody, found.element).second) {
      fail(source, *found.element,
           fmt::format("is a second joint that moves body '{}', a closed loop is not supported",
                       joint.childBody));
    }
    waiting.push_back(std::move(joint));
  }
  for (const Element* body : objectsOf(model, "BodySet")) {
    const std::string name = nameOf(source, *body);
    if (name != "ground" && !jointOf.contains(name)) {
      fail(source, *body, "no joint moves this body, every body must be the child of one joint");
    }
  }

  // Parents before children, otherwise in the order of the file.
  std::set<std::string> placed = {"ground"};
  while (!waiting.empty()) {
    std::vector<Joint> left;
    for (Joint& joint : waiting) {
      if (placed.contains(joint.parentBody)) {
        placed.insert(joint.childBody);
        reading.model.joints.push_back(std::move(joint));
      } else {
        left.push_back(std::move(joint));
      }
    }
    if (left.size() == waiting.size()) {
      fail(source, *jointOf.at(left.front().childBody),
           "is not connected to the ground, its parents form a closed loop");
    }
    waiting = std::move(left);
  }
}

}  // namespace bio::osim
