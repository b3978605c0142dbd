#include <array>

#include "opensim/writing.h"

namespace bio::osim {
namespace {

void appendIsEnabled(const Writing& writing, Element& element, bool enabled) {
  const bool is4 = writing.format == Format::opensim4;
  appendFlag(element, is4 ? "appliesForce" : "isDisabled", is4 == enabled);
}

void appendPointSpring(const Writing& writing, Element& parent, const PointToPointSpring& spring) {
  Element& element = append(parent, "PointToPointSpring", spring.name);
  appendIsEnabled(writing, element, spring.enabled);
  const bool is4 = writing.format == Format::opensim4;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string number = std::to_string(i + 1);
    appendText(element, ((is4 ? "socket_body" : "body") + number).c_str(),
               is4 ? bodyPath(spring.body[i]) : spring.body[i]);
    appendNumbers(element, ("point" + number).c_str(), spring.point[i]);
  }
  appendNumber(element, "stiffness", spring.stiffness);
  appendNumber(element, "rest_length", spring.restLength);
}

void appendBushing(const Writing& writing, Element& parent, const BushingForce& bushing) {
  Element& element = append(parent, "BushingForce", bushing.name);
  appendIsEnabled(writing, element, bushing.enabled);
  if (writing.format == Format::opensim4) {
    appendText(element, "socket_frame1", bushing.name + "_frame1");
    appendText(element, "socket_frame2", bushing.name + "_frame2");
    Element& frames = append(element, "frames");
    for (std::size_t i = 0; i < 2; ++i) {
      Element& frame =
          append(frames, "PhysicalOffsetFrame", bushing.name + "_frame" + std::to_string(i + 1));
      appendText(frame, "socket_parent", bodyPath(bushing.body[i]));
      appendNumbers(frame, "translation", bushing.frame[i].translation);
      appendNumbers(frame, "orientation", bushing.frame[i].orientation);
    }
  } else {
    for (std::size_t i = 0; i < 2; ++i) {
      const std::string number = std::to_string(i + 1);
      appendText(element, ("body_" + number).c_str(), bushing.body[i]);
      appendNumbers(element, ("location_body_" + number).c_str(), bushing.frame[i].translation);
      appendNumbers(element, ("orientation_body_" + number).c_str(), bushing.frame[i].orientation);
    }
  }
  appendNumbers(element, "rotational_stiffness", bushing.rotationalStiffness);
  appendNumbers(element, "translational_stiffness", bushing.translationalStiffness);
  appendNumbers(element, "rotational_damping", bushing.rotationalDamping);
  appendNumbers(element, "translational_damping", bushing.translationalDamping);
}

void appendElasticPath(const Writing& writing, Element& parent, const ElasticPath& elastic) {
  static constexpr std::array tags{"Ligament", "PathSpring", "Blankevoort1991Ligament"};
  Element& element = append(parent, tags[static_cast<std::size_t>(elastic.kind)], elastic.name);
  appendIsEnabled(writing, element, elastic.enabled);
  appendPath(writing, element, elastic.path);
  switch (elastic.kind) {
    case ElasticPathKind::ligament:
      appendNumber(element, "resting_length", elastic.restLength);
      appendNumber(element, "pcsa_force", elastic.scale);
      appendFunction(append(element, "force_length_curve"), elastic.curve, {});
      break;
    case ElasticPathKind::spring:
      appendNumber(element, "resting_length", elastic.restLength);
      appendNumber(element, "stiffness", elastic.scale);
      appendNumber(element, "dissipation", elastic.damping);
      break;
    case ElasticPathKind::blankevoort1991:
      appendNumber(element, "slack_length", elastic.restLength);
      appendNumber(element, "linear_stiffness", elastic.scale);
      appendNumber(element, "transition_strain", elastic.transitionStrain);
      appendNumber(element, "damping_coefficient", elastic.damping);
      break;
  }
}

void appendPrescribed(const Writing& writing, Element& parent, const BodyLoad& load) {
  Element& element = append(parent, "PrescribedForce", load.name);
  appendIsEnabled(writing, element, load.enabled);
  const bool is4 = writing.format == Format::opensim4;
  appendText(element, is4 ? "socket_frame" : "body", is4 ? bodyPath(load.body) : load.body);
  appendFlag(element, "pointIsGlobal", load.pointFrame == "ground");
  appendFlag(element, "forceIsGlobal", load.forceFrame == "ground");
  static constexpr std::array names{"forceFunctions", "pointFunctions", "torqueFunctions"};
  for (std::size_t part = 0; part < 3; ++part) {
    Element& objects = append(append(element, "FunctionSet", names[part]), "objects");
    for (std::size_t i = 0; i < 3; ++i) {
      appendFunction(objects, load.functions[3 * part + i], std::string(1, "xyz"[i]));
    }
  }
}

}  // namespace

void appendBodyForces(const Writing& writing, Element& parent) {
  const Model& model = writing.model;
  for (const PointToPointSpring& spring : model.pointSprings) {
    appendPointSpring(writing, parent, spring);
  }
  for (const BushingForce& bushing : model.bushings) appendBushing(writing, parent, bushing);
  for (const ElasticPath& elastic : model.elasticPaths) appendElasticPath(writing, parent, elastic);
  for (const BodyLoad& load : model.prescribedForces) appendPrescribed(writing, parent, load);
  for (const CoordinateActuator& actuator : model.actuators) {
    Element& element = append(parent, "CoordinateActuator", actuator.name);
    appendIsEnabled(writing, element, actuator.enabled);
    appendText(element, "coordinate", actuator.coordinate);
    appendNumber(element, "optimal_force", actuator.optimalForce);
  }
}

}  // namespace bio::osim
