#include <fmt/format.h>

#include <string_view>

#include "opensim/reading.h"

namespace bio::osim {
namespace {

Eigen::Vector3d readVector(const Reading& reading, const Element& element, const char* property,
                           const char* unit, const Eigen::Vector3d& fallback) {
  const auto v = readNumbers(reading.source, element, property, unit, 3,
                             std::vector<double>{fallback[0], fallback[1], fallback[2]});
  return {v[0], v[1], v[2]};
}

Eigen::Vector3d readNotNegative(const Reading& reading, const Element& element,
                                const char* property, const char* unit) {
  const Eigen::Vector3d v = readVector(reading, element, property, unit, {0, 0, 0});
  if (!(v.minCoeff() >= 0)) {
    fail(reading.source, element,
         fmt::format("{} = {} {} {} {}, must be ≥ 0", property, v[0], v[1], v[2], unit),
         element.FirstChildElement(property));
  }
  return v;
}

// OpenSim 4 names a frame by a socket, OpenSim 3 a body.
BodyFrame readFrame(const Reading& reading, const Element& element, const char* socket,
                    const char* plain) {
  if (element.FirstChildElement(socket)) {
    return resolveFrame(reading, element, "/forceset/" + nameOf(reading.source, element), socket);
  }
  const std::string body = readText(reading.source, element, plain);
  if (body != "ground" && !reading.frames.contains("/bodyset/" + body)) {
    fail(reading.source, element,
         fmt::format("{} = '{}', must name a body of the model", plain, body),
         element.FirstChildElement(plain));
  }
  return {body, {}};
}

PointToPointSpring readPointSpring(const Reading& reading, const Element& element) {
  PointToPointSpring spring;
  spring.name = nameOf(reading.source, element);
  spring.enabled = isEnabled(reading, element);
  const std::array<std::array<const char*, 3>, 2> names{
      {{"socket_body1", "body1", "point1"}, {"socket_body2", "body2", "point2"}}};
  for (std::size_t i = 0; i < 2; ++i) {
    const BodyFrame frame = readFrame(reading, element, names[i][0], names[i][1]);
    spring.body[i] = frame.body;
    const Eigen::Vector3d point = readVector(reading, element, names[i][2], "m", {0, 0, 0});
    spring.point[i] = compose(frame.placement, {point, {}}).translation;
  }
  spring.stiffness =
      readNumber(reading.source, element, "stiffness", "N/m", Rule::notNegative, 1.0);
  spring.restLength =
      readNumber(reading.source, element, "rest_length", "m", Rule::notNegative, 0.0);
  return spring;
}

BushingForce readBushing(const Reading& reading, const Element& element) {
  BushingForce bushing;
  bushing.name = nameOf(reading.source, element);
  bushing.enabled = isEnabled(reading, element);
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string number = std::to_string(i + 1);
    const BodyFrame frame =
        readFrame(reading, element, ("socket_frame" + number).c_str(), ("body_" + number).c_str());
    const FramePlacement offset{
        readVector(reading, element, ("location_body_" + number).c_str(), "m", {0, 0, 0}),
        readVector(reading, element, ("orientation_body_" + number).c_str(), "rad", {0, 0, 0})};
    bushing.body[i] = frame.body;
    bushing.frame[i] = compose(frame.placement, offset);
  }
  bushing.rotationalStiffness =
      readNotNegative(reading, element, "rotational_stiffness", "N m/rad");
  bushing.translationalStiffness =
      readNotNegative(reading, element, "translational_stiffness", "N/m");
  bushing.rotationalDamping = readNotNegative(reading, element, "rotational_damping", "N m s/rad");
  bushing.translationalDamping =
      readNotNegative(reading, element, "translational_damping", "N s/m");
  return bushing;
}

ElasticPath readElasticPath(Reading& reading, const Element& element, ElasticPathKind kind) {
  const Source& source = reading.source;
  ElasticPath elastic;
  elastic.name = nameOf(source, element);
  elastic.kind = kind;
  elastic.enabled = isEnabled(reading, element);
  elastic.path = readPath(reading, element);
  const auto positive = [&](const char* property, const char* unit,
                            std::optional<double> fallback) {
    return readNumber(source, element, property, unit, Rule::positive, fallback);
  };
  const auto notNegative = [&](const char* property, const char* unit, double fallback) {
    return readNumber(source, element, property, unit, Rule::notNegative, fallback);
  };
  switch (kind) {
    case ElasticPathKind::ligament: {
      elastic.restLength = positive("resting_length", "m", {});
      elastic.scale = notNegative("pcsa_force", "N", 0);
      const Element* curve = findFunction(element, "force_length_curve");
      if (!curve) fail(source, element, "force_length_curve is missing, must be given");
      elastic.curve = readFunction(reading, *curve);
      break;
    }
    case ElasticPathKind::spring:
      elastic.restLength = positive("resting_length", "m", {});
      elastic.scale = notNegative("stiffness", "N/m", 1);
      elastic.damping = notNegative("dissipation", "s/m", 0);
      break;
    case ElasticPathKind::blankevoort1991:
      elastic.restLength = positive("slack_length", "m", {});
      elastic.scale = notNegative("linear_stiffness", "N", 1);
      elastic.transitionStrain = positive("transition_strain", "", 0.06);
      elastic.damping = notNegative("damping_coefficient", "N s", 0.003);
      break;
  }
  return elastic;
}

// Three functions of time of a set, `<forceFunctions>` or `<FunctionSet name="forceFunctions">`.
std::vector<Function> readFunctions(Reading& reading, const Element& element, const char* name) {
  const Element* set = element.FirstChildElement(name);
  for (const Element* child : childrenOf(&element)) {
    const char* own = child->Attribute("name");
    if (std::string_view(child->Name()) == "FunctionSet" && own && std::string_view(own) == name) {
      set = child;
    }
  }
  std::vector<Function> functions;
  if (!set) return functions;
  const Element* inner = set->FirstChildElement("FunctionSet");
  for (const Element* function : childrenOf((inner ? inner : set)->FirstChildElement("objects"))) {
    functions.push_back(readFunction(reading, *function));
  }
  if (!functions.empty() && functions.size() != 3) {
    fail(reading.source, element,
         fmt::format("{}: {} functions, must be 3 or none", name, functions.size()), set);
  }
  return functions;
}

BodyLoad readPrescribed(Reading& reading, const Element& element) {
  const Source& source = reading.source;
  BodyLoad load;
  load.name = nameOf(source, element);
  load.enabled = isEnabled(reading, element);
  const BodyFrame frame = readFrame(reading, element, "socket_frame", "body");
  if (frame.body == "ground" || !(frame.placement == FramePlacement{})) {
    fail(source, element, "acts on a frame, must act on a body of the model");
  }
  load.body = frame.body;
  const std::vector<Function> point = readFunctions(reading, element, "pointFunctions");
  const bool inGround = readFlag(source, element, "pointIsGlobal", false) && !point.empty();
  load.pointFrame = inGround ? "ground" : load.body;
  load.forceFrame = readFlag(source, element, "forceIsGlobal", true) ? "ground" : load.body;
  for (const auto& part : {readFunctions(reading, element, "forceFunctions"), point,
                           readFunctions(reading, element, "torqueFunctions")}) {
    for (std::size_t i = 0; i < 3; ++i) {
      load.functions.push_back(part.empty() ? Function{1, ConstantFunction{0}} : part[i]);
    }
  }
  return load;
}

CoordinateActuator readActuator(const Reading& reading, const Element& element) {
  CoordinateActuator actuator;
  actuator.name = nameOf(reading.source, element);
  actuator.enabled = isEnabled(reading, element);
  actuator.coordinate = readCoordinateName(reading, element, "coordinate");
  actuator.optimalForce =
      readNumber(reading.source, element, "optimal_force", "N m", Rule::finite, 1.0);
  return actuator;
}

}  // namespace

bool readBodyForce(Reading& reading, const Element& element, std::map<std::string, int>& names) {
  Model& model = reading.model;
  const std::string_view kind = element.Name();
  const auto isNew = [&] { requireNewName(reading, element, "force", names); };
  if (kind == "PointToPointSpring") {
    isNew();
    model.pointSprings.push_back(readPointSpring(reading, element));
  } else if (kind == "BushingForce") {
    isNew();
    model.bushings.push_back(readBushing(reading, element));
  } else if (kind == "Ligament") {
    isNew();
    model.elasticPaths.push_back(readElasticPath(reading, element, ElasticPathKind::ligament));
  } else if (kind == "PathSpring") {
    isNew();
    model.elasticPaths.push_back(readElasticPath(reading, element, ElasticPathKind::spring));
  } else if (kind == "Blankevoort1991Ligament") {
    isNew();
    model.elasticPaths.push_back(
        readElasticPath(reading, element, ElasticPathKind::blankevoort1991));
  } else if (kind == "PrescribedForce") {
    isNew();
    model.prescribedForces.push_back(readPrescribed(reading, element));
  } else if (kind == "CoordinateActuator") {
    isNew();
    model.actuators.push_back(readActuator(reading, element));
  } else {
    return false;
  }
  return true;
}

}  // namespace bio::osim
