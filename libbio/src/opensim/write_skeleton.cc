#include <fmt/format.h>

#include "opensim/writing.h"

namespace bio::osim {
namespace {

void appendGeometry(Element& element, const Body& body) {
  Element& geometry = append(element, "attached_geometry");
  for (std::size_t i = 0; i < body.geometry.size(); ++i) {
    Element& mesh = append(geometry, "Mesh", fmt::format("{}_geom_{}", body.name, i + 1));
    appendText(mesh, "socket_frame", "..");
    appendText(mesh, "mesh_file", body.geometry[i].file);
    if (body.geometry[i].scale != Eigen::Vector3d::Ones())
      appendNumbers(mesh, "scale_factors", body.geometry[i].scale);
  }
}

void appendCoordinate(const Writing& writing, Element& parent, const Coordinate& coordinate) {
  Element& element = append(parent, "Coordinate", coordinate.name);
  if (writing.format == Format::opensim3) {
    appendText(element, "motion_type", coordinate.isRotation ? "rotational" : "translational");
  }
  appendNumber(element, "default_value", coordinate.defaultValue);
  appendNumbers(element, "range", std::vector<double>{coordinate.rangeMin, coordinate.rangeMax});
  appendFlag(element, "clamped", coordinate.clamped);
  appendFlag(element, "locked", coordinate.locked);
  if (!coordinate.prescribed || !coordinate.prescribedFunction) return;
  appendFlag(element, "prescribed", coordinate.prescribed);
  appendFunction(append(element, "prescribed_function"), *coordinate.prescribedFunction, "");
}

void appendOffsetFrame(Element& parent, const std::string& body, const FramePlacement& placement) {
  Element& frame = append(parent, "PhysicalOffsetFrame", body + "_offset");
  appendText(frame, "socket_parent", bodyPath(body));
  appendNumbers(frame, "translation", placement.translation);
  appendNumbers(frame, "orientation", placement.orientation);
}

void appendTransform(const Writing& writing, Element& parent, const Joint& joint) {
  Element& transform = append(parent, "SpatialTransform");
  for (std::size_t i = 0; i < 6; ++i) {
    const TransformAxis& axis = joint.axes[i];
    const std::string name = fmt::format("{}{}", i < 3 ? "rotation" : "translation", i % 3 + 1);
    Element& element = append(transform, "TransformAxis", name);
    appendText(element, "coordinates", axis.coordinate);
    appendNumbers(element, "axis", axis.axis);
    if (writing.format == Format::opensim4) {
      appendFunction(element, axis.function, "function");
    } else {
      appendFunction(append(element, "function"), axis.function, "");
    }
  }
}

const char* className(JointKind kind) {
  switch (kind) {
    case JointKind::weld:
      return "WeldJoint";
    case JointKind::pin:
      return "PinJoint";
    case JointKind::slider:
      return "SliderJoint";
    case JointKind::custom:
      break;
  }
  return "CustomJoint";
}

}  // namespace

std::string bodyPath(const std::string& body) {
  return body == "ground" ? "/ground" : "/bodyset/" + body;
}

std::string coordinatePath(const Model& model, const std::string& coordinate) {
  for (const Joint& joint : model.joints) {
    for (const Coordinate& c : joint.coordinates) {
      if (c.name == coordinate) return fmt::format("/jointset/{}/{}", joint.name, coordinate);
    }
  }
  return coordinate;
}

void appendBody(const Writing& writing, Element& parent, const Body& body) {
  Element& element = append(parent, "Body", body.name);
  if (writing.format == Format::opensim4) appendGeometry(element, body);
  appendNumber(element, "mass", body.mass);
  appendNumbers(element, "mass_center", body.massCenter);
  if (writing.format == Format::opensim4) {
    appendNumbers(element, "inertia",
                  std::vector<double>(body.inertia.begin(), body.inertia.end()));
  } else {
    const char* names[] = {"inertia_xx", "inertia_yy", "inertia_zz",
                           "inertia_xy", "inertia_xz", "inertia_yz"};
    for (std::size_t i = 0; i < 6; ++i) appendNumber(element, names[i], body.inertia[i]);
    Element& holder = append(element, "Joint");
    for (const Joint& joint : writing.model.joints) {
      if (joint.childBody == body.name) appendJoint(writing, holder, joint);
    }
  }
  appendWrapObjects(writing, element, body.name);
}

void appendJoint(const Writing& writing, Element& parent, const Joint& joint) {
  Element& element = append(parent, className(joint.kind), joint.name);
  if (writing.format == Format::opensim4) {
    appendText(element, "socket_parent_frame", joint.parentBody + "_offset");
    appendText(element, "socket_child_frame", joint.childBody + "_offset");
    if (!joint.coordinates.empty()) {
      Element& coordinates = append(element, "coordinates");
      for (const Coordinate& c : joint.coordinates) appendCoordinate(writing, coordinates, c);
    }
    Element& frames = append(element, "frames");
    appendOffsetFrame(frames, joint.parentBody, joint.parentFrame);
    appendOffsetFrame(frames, joint.childBody, joint.childFrame);
  } else {
    appendText(element, "parent_body", joint.parentBody);
    appendNumbers(element, "location_in_parent", joint.parentFrame.translation);
    appendNumbers(element, "orientation_in_parent", joint.parentFrame.orientation);
    appendNumbers(element, "location", joint.childFrame.translation);
    appendNumbers(element, "orientation", joint.childFrame.orientation);
    Element& coordinates = appendSet(writing, element, "CoordinateSet", "");
    for (const Coordinate& c : joint.coordinates) appendCoordinate(writing, coordinates, c);
  }
  if (joint.kind == JointKind::custom) appendTransform(writing, element, joint);
}

void appendCoupler(const Writing& writing, Element& parent, const CoordinateCoupler& coupler) {
  Element& element = append(parent, "CoordinateCouplerConstraint", coupler.name);
  const bool is4 = writing.format == Format::opensim4;
  appendFlag(element, is4 ? "isEnforced" : "isDisabled", is4);
  appendFunction(append(element, "coupled_coordinates_function"), {1, coupler.function.shape}, "");
  appendText(element, "independent_coordinate_names", coupler.independent);
  appendText(element, "dependent_coordinate_name", coupler.dependent);
  appendNumber(element, "scale_factor", coupler.function.scale);
}

}  // namespace bio::osim
