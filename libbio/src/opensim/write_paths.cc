#include <fmt/format.h>

#include "opensim/writing.h"

namespace bio::osim {
namespace {

const char* className(WrapShape shape) {
  switch (shape) {
    case WrapShape::cylinder:
      return "WrapCylinder";
    case WrapShape::sphere:
      return "WrapSphere";
    case WrapShape::ellipsoid:
      return "WrapEllipsoid";
    case WrapShape::torus:
      break;
  }
  return "WrapTorus";
}

void appendWrapObject(Element& parent, const WrapObject& wrap) {
  Element& element = append(parent, className(wrap.shape), wrap.name);
  appendFlag(element, "active", wrap.active);
  appendNumbers(element, "xyz_body_rotation", wrap.frame.orientation);
  appendNumbers(element, "translation", wrap.frame.translation);
  appendText(element, "quadrant", wrap.quadrant);
  switch (wrap.shape) {
    case WrapShape::cylinder:
      appendNumber(element, "radius", wrap.radius);
      appendNumber(element, "length", wrap.length);
      break;
    case WrapShape::sphere:
      appendNumber(element, "radius", wrap.radius);
      break;
    case WrapShape::ellipsoid:
      appendNumbers(element, "dimensions", wrap.semiAxes);
      break;
    case WrapShape::torus:
      appendNumber(element, "inner_radius", wrap.radius);
      appendNumber(element, "outer_radius", wrap.outerRadius);
      break;
  }
}

void appendCoordinateReference(const Writing& writing, Element& element,
                               const std::string& property, const std::string& coordinate) {
  if (writing.format == Format::opensim4) {
    appendText(element, ("socket_" + property).c_str(), coordinatePath(writing.model, coordinate));
  } else {
    appendText(element, property.c_str(), coordinate);
  }
}

void appendPoint(const Writing& writing, Element& parent, const PathPoint& point) {
  const bool is4 = writing.format == Format::opensim4;
  const char* kind = point.condition ? "ConditionalPathPoint"
                     : point.motion  ? "MovingPathPoint"
                                     : "PathPoint";
  Element& element = append(parent, kind, point.name);
  if (is4) {
    appendText(element, "socket_parent_frame", bodyPath(point.body));
  } else {
    appendText(element, "body", point.body);
  }
  if (!point.motion || !is4) appendNumbers(element, "location", point.location);
  if (point.condition) {
    appendCoordinateReference(writing, element, "coordinate", point.condition->coordinate);
    appendNumbers(element, "range",
                  std::vector<double>{point.condition->lower, point.condition->upper});
  }
  if (!point.motion) return;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string axis(1, "xyz"[i]);
    if (!point.motion->coordinate[i].empty()) {
      appendCoordinateReference(writing, element, axis + "_coordinate",
                                point.motion->coordinate[i]);
    }
    appendFunction(append(element, (axis + "_location").c_str()), point.motion->location[i], "");
  }
}

// The name of the element is that of the property, which is how OpenSim finds it.
void appendFunctionPath(const Writing& writing, Element& muscle, const PathFunction& function) {
  Element& element = append(muscle, "FunctionBasedPath", "path");
  std::string coordinates;
  for (const std::string& name : function.coordinates) {
    if (!coordinates.empty()) coordinates += ' ';
    coordinates += coordinatePath(writing.model, name);
  }
  appendText(element, "coordinate_paths", coordinates);
  Element& length = append(element, "length_function");
  if (const auto* plain = std::get_if<Function>(&function.length)) {
    return appendFunction(length, *plain, "");
  }
  const auto& polynomial = std::get<MultivariatePolynomial>(function.length);
  Element& written = append(length, "MultivariatePolynomialFunction");
  appendNumbers(written, "coefficients", polynomial.coefficients);
  appendText(written, "dimension", std::to_string(polynomial.dimension));
  appendText(written, "order", std::to_string(polynomial.order));
}

}  // namespace

void appendWrapObjects(const Writing& writing, Element& body, const std::string& name) {
  Element& objects = appendSet(writing, body, "WrapObjectSet", "wrapobjectset");
  for (const WrapObject& wrap : writing.model.wrapObjects) {
    if (wrap.body == name) appendWrapObject(objects, wrap);
  }
}

void appendPath(const Writing& writing, Element& muscle, const Path& path) {
  if (path.function) return appendFunctionPath(writing, muscle, *path.function);
  Element& geometry =
      append(muscle, "GeometryPath", writing.format == Format::opensim4 ? "geometrypath" : "");
  Element& points = appendSet(writing, geometry, "PathPointSet", "");
  for (const PathPoint& point : path.points) appendPoint(writing, points, point);
  Element& wraps = appendSet(writing, geometry, "PathWrapSet", "");
  for (std::size_t i = 0; i < path.wraps.size(); ++i) {
    const PathWrap& wrap = path.wraps[i];
    // OpenSim wants names that differ within a set.
    const std::string name = i == 0 ? "pathwrap" : fmt::format("pathwrap_{}", i);
    Element& element = append(wraps, "PathWrap", writing.format == Format::opensim4 ? name : "");
    appendText(element, "wrap_object", wrap.wrapObject);
    appendText(element, "method", "hybrid");
    appendText(element, "range", fmt::format("{} {}", wrap.firstPoint, wrap.lastPoint));
  }
}

}  // namespace bio::osim
