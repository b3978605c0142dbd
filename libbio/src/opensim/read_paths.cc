#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "opensim/reading.h"

namespace bio::osim {
namespace {

const std::map<std::string_view, WrapShape> wrapShapes = {
    {"WrapCylinder", WrapShape::cylinder},
    {"WrapSphere", WrapShape::sphere},
    {"WrapEllipsoid", WrapShape::ellipsoid},
    {"WrapTorus", WrapShape::torus},
};

std::string readQuadrant(const Source& source, const Element& element) {
  const std::string quadrant = readText(source, element, "quadrant", "all");
  if (quadrant == "Unassigned" || quadrant.empty()) return "all";
  static const std::vector<std::string> known = {"all", "x",  "+x", "-x", "y",
                                                 "+y",  "-y", "z",  "+z", "-z"};
  if (std::find(known.begin(), known.end(), quadrant) == known.end()) {
    fail(source, element,
         fmt::format("quadrant = '{}', must be all, x, +x, -x, y, +y, -y, z, +z or -z", quadrant),
         element.FirstChildElement("quadrant"));
  }
  return quadrant;
}

void readSize(const Source& source, const Element& element, WrapObject& wrap) {
  const auto positive = [&](const char* property) {
    return readNumber(source, element, property, "m", Rule::positive);
  };
  switch (wrap.shape) {
    case WrapShape::cylinder:
      wrap.radius = positive("radius");
      wrap.length = positive("length");
      break;
    case WrapShape::sphere:
      wrap.radius = positive("radius");
      break;
    case WrapShape::torus:
      wrap.radius = positive("inner_radius");
      wrap.outerRadius = positive("outer_radius");
      break;
    case WrapShape::ellipsoid: {
      const auto d = readNumbers(source, element, "dimensions", "m", 3);
      wrap.semiAxes = {d[0], d[1], d[2]};
      if (!(wrap.semiAxes.minCoeff() > 0)) {
        fail(source, element, fmt::format("dimensions = {} {} {} m, must be > 0", d[0], d[1], d[2]),
             element.FirstChildElement("dimensions"));
      }
      break;
    }
  }
}

void readWrapsOf(Reading& reading, const Element& owner, const BodyFrame& frame,
                 std::map<std::string, int>& names) {
  const Source& source = reading.source;
  for (const Element* element : objectsOf(owner, "WrapObjectSet")) {
    const auto shape = wrapShapes.find(element->Name());
    if (shape == wrapShapes.end()) {
      fail(
          source, *element,
          fmt::format("wrap object of class {}, must be WrapCylinder, WrapSphere, WrapEllipsoid or "
                      "WrapTorus",
                      element->Name()));
    }
    requireNewName(reading, *element, "wrap object", names);
    WrapObject wrap;
    wrap.name = nameOf(source, *element);
    wrap.body = frame.body;
    wrap.shape = shape->second;
    const std::vector<double> zero(3, 0.0);
    const auto p = readNumbers(source, *element, "translation", "m", 3, zero);
    const auto o = readNumbers(source, *element, "xyz_body_rotation", "rad", 3, zero);
    wrap.frame = compose(frame.placement, {{p[0], p[1], p[2]}, {o[0], o[1], o[2]}});
    wrap.quadrant = readQuadrant(source, *element);
    wrap.active = readFlag(source, *element, "active", true);
    readSize(source, *element, wrap);
    reading.model.wrapObjects.push_back(std::move(wrap));
  }
}

// Body and location of a point; on an offset frame both are those of the body under it.
void placePoint(const Reading& reading, const Element& element, PathPoint& point) {
  const Source& source = reading.source;
  const bool moves = std::string_view(element.Name()) == "MovingPathPoint";
  if (!moves) {
    const auto l = readNumbers(source, element, "location", "m", 3);
    point.location = {l[0], l[1], l[2]};
  }
  const char* socket = element.FirstChildElement("socket_parent_frame") ? "socket_parent_frame"
                       : element.FirstChildElement("socket_parent")     ? "socket_parent"
                                                                        : nullptr;
  if (!socket) {
    point.body = readText(source, element, "body");
    if (point.body != "ground" && !reading.frames.contains("/bodyset/" + point.body)) {
      fail(source, element, fmt::format("body = '{}', must name a body of the model", point.body),
           element.FirstChildElement("body"));
    }
    return;
  }
  const BodyFrame frame = resolveFrame(reading, element, "", socket);
  point.body = frame.body;
  if (moves && !(frame.placement == FramePlacement{})) {
    fail(source, element,
         fmt::format("{} is an offset frame, a moving point must be on a body", socket),
         element.FirstChildElement(socket));
  }
  point.location = compose(frame.placement, {point.location, {}}).translation;
}

void readCondition(const Reading& reading, const Element& element, PathPoint& point) {
  const auto range = readNumbers(reading.source, element, "range", "", 2);
  const bool socket = element.FirstChildElement("socket_coordinate") != nullptr;
  PointCondition condition;
  condition.coordinate =
      readCoordinateName(reading, element, socket ? "socket_coordinate" : "coordinate");
  condition.lower = range[0];
  condition.upper = range[1];
  if (!(range[0] <= range[1])) {
    fail(reading.source, element,
         fmt::format("range = {} to {}, must not fall", range[0], range[1]),
         element.FirstChildElement("range"));
  }
  point.condition = condition;
}

// As OpenSim's MovingPathPoint does; a name that the model lacks is refused later.
void holdWithinRange(const Model& model, const std::string& name, Function& function) {
  const Coordinate* coordinate = coordinateOrNull(model, name);
  if (!coordinate) return;
  function.low = coordinate->rangeMin;
  function.high = coordinate->rangeMax;
}

void readMotion(Reading& reading, const Element& element, PathPoint& point) {
  PointMotion motion;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string axis(1, "xyz"[i]);
    const std::string location = axis + "_location";
    const Element* function = findFunction(element, location.c_str());
    if (!function) {
      fail(reading.source, element, fmt::format("{} is missing, must be given", location));
    }
    motion.location[i] = readFunction(reading, *function);
    const std::string socket = "socket_" + axis + "_coordinate", plain = axis + "_coordinate";
    const char* property = element.FirstChildElement(socket.c_str())  ? socket.c_str()
                           : element.FirstChildElement(plain.c_str()) ? plain.c_str()
                                                                      : nullptr;
    if (property && !readText(reading.source, element, property).empty()) {
      motion.coordinate[i] = readCoordinateName(reading, element, property);
      holdWithinRange(reading.model, motion.coordinate[i], motion.location[i]);
    } else if (!std::holds_alternative<ConstantFunction>(motion.location[i].shape)) {
      fail(reading.source, element, fmt::format("{} is missing, must be given", plain));
    }
  }
  point.motion = std::move(motion);
}

PathPoint readPoint(Reading& reading, const Element& element) {
  const std::string_view kind = element.Name();
  PathPoint point;
  if (const char* name = element.Attribute("name")) point.name = name;
  placePoint(reading, element, point);
  if (kind == "ConditionalPathPoint") {
    readCondition(reading, element, point);
  } else if (kind == "MovingPathPoint") {
    readMotion(reading, element, point);
  } else if (kind != "PathPoint") {
    fail(reading.source, element,
         fmt::format("path point of class {}, must be PathPoint, ConditionalPathPoint or "
                     "MovingPathPoint",
                     kind));
  }
  return point;
}

PathWrap readWrap(const Reading& reading, const Element& element, std::size_t points) {
  PathWrap wrap;
  wrap.wrapObject = readText(reading.source, element, "wrap_object");
  const auto& wraps = reading.model.wrapObjects;
  if (std::none_of(wraps.begin(), wraps.end(),
                   [&](const WrapObject& w) { return w.name == wrap.wrapObject; })) {
    fail(reading.source, element,
         fmt::format("wrap_object = '{}', must name a wrap object of the model", wrap.wrapObject),
         element.FirstChildElement("wrap_object"));
  }
  const auto range =
      readNumbers(reading.source, element, "range", "", 2, std::vector<double>{-1, -1});
  const auto valid = [&](double r) {
    return r == std::floor(r) && r <= static_cast<double>(points);
  };
  const bool falls = range[0] >= 1 && range[1] >= 1 && range[0] > range[1];
  if (!valid(range[0]) || !valid(range[1]) || falls) {
    fail(reading.source, element,
         fmt::format("range = {} {}, must be rising numbers of the path's {} points, or -1",
                     range[0], range[1], points),
         element.FirstChildElement("range"));
  }
  wrap.firstPoint = range[0] < 1 ? -1 : static_cast<int>(range[0]);
  wrap.lastPoint = range[1] < 1 ? -1 : static_cast<int>(range[1]);
  return wrap;
}

// `<CLASS name="path">`, or `<CLASS>` in `<path>`.
const Element* pathElement(const Element& force, const char* kind) {
  if (const Element* direct = force.FirstChildElement(kind)) return direct;
  const Element* path = force.FirstChildElement("path");
  return path ? path->FirstChildElement(kind) : nullptr;
}

}  // namespace

void readWrapObjects(Reading& reading, const Element& model) {
  std::map<std::string, int> names;
  if (const Element* ground = model.FirstChildElement("Ground")) {
    readWrapsOf(reading, *ground, {"ground", {}}, names);
  }
  for (const Element* body : objectsOf(model, "BodySet")) {
    readWrapsOf(reading, *body, {nameOf(reading.source, *body), {}}, names);
  }
  for (const auto& [element, ownerPath] : reading.offsetFrames) {
    const std::string path = ownerPath + "/" + nameOf(reading.source, *element);
    readWrapsOf(reading, *element, reading.frames.at(path), names);
  }
}

Path readPath(Reading& reading, const Element& force) {
  const Element* geometry = pathElement(force, "GeometryPath");
  if (!geometry) {
    if (const Element* function = pathElement(force, "FunctionBasedPath")) {
      return readFunctionPath(reading, force, *function);
    }
    fail(reading.source, force, "GeometryPath or FunctionBasedPath is missing, must be given");
  }
  Path path;
  for (const Element* point : objectsOf(*geometry, "PathPointSet")) {
    path.points.push_back(readPoint(reading, *point));
  }
  if (path.points.size() < 2) {
    fail(reading.source, force,
         fmt::format("its path has {} points, must have at least 2", path.points.size()), geometry);
  }
  for (const Element* wrap : objectsOf(*geometry, "PathWrapSet")) {
    path.wraps.push_back(readWrap(reading, *wrap, path.points.size()));
  }
  return path;
}

}  // namespace bio::osim
