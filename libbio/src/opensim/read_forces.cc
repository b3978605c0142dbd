#include <fmt/format.h>

#include <string_view>

#include "bio/model/units.h"
#include "opensim/reading.h"

namespace bio::osim {
namespace {

// OpenSim writes limits of an angle in degrees and stiffness and damping per degree.
CoordinateLimitForce readLimitForce(const Reading& reading, const Element& element) {
  const Source& source = reading.source;
  CoordinateLimitForce force;
  force.name = nameOf(source, element);
  force.coordinate = readCoordinateName(reading, element, "coordinate");
  const bool angle = findCoordinate(reading.model, force.coordinate).isRotation;
  const double radians = angle ? radiansPerDegree : 1.0;
  const auto read = [&](const char* property, const char* unit, Rule rule, double fallback) {
    return readNumber(source, element, property, unit, rule, fallback);
  };
  force.upperLimit = read("upper_limit", "deg", Rule::finite, 0) * radians;
  force.upperStiffness = read("upper_stiffness", "N m/deg", Rule::notNegative, 1) / radians;
  force.lowerLimit = read("lower_limit", "deg", Rule::finite, 0) * radians;
  force.lowerStiffness = read("lower_stiffness", "N m/deg", Rule::notNegative, 1) / radians;
  force.damping = read("damping", "N m s/deg", Rule::notNegative, 0.001) / radians;
  force.transition = read("transition", "deg", Rule::positive, 0.1) * radians;
  force.enabled = isEnabled(reading, element);
  if (!(force.lowerLimit <= force.upperLimit)) {
    fail(source, element,
         fmt::format("lower_limit = {} deg, must be ≤ upper_limit = {} deg",
                     force.lowerLimit / radians, force.upperLimit / radians),
         element.FirstChildElement("lower_limit"));
  }
  return force;
}

SpringGeneralizedForce readSpring(const Reading& reading, const Element& element) {
  const Source& source = reading.source;
  SpringGeneralizedForce force;
  force.name = nameOf(source, element);
  force.coordinate = readCoordinateName(reading, element, "coordinate");
  force.stiffness = readNumber(source, element, "stiffness", "N m/rad", Rule::finite, 0.0);
  force.restLength = readNumber(source, element, "rest_length", "rad", Rule::finite, 0.0);
  force.viscosity = readNumber(source, element, "viscosity", "N m s/rad", Rule::notNegative, 0.0);
  force.enabled = isEnabled(reading, element);
  return force;
}

ExpressionBasedCoordinateForce readExpression(const Reading& reading, const Element& element) {
  ExpressionBasedCoordinateForce force;
  force.name = nameOf(reading.source, element);
  force.coordinate = readCoordinateName(reading, element, "coordinate");
  force.expression = readText(reading.source, element, "expression");
  force.enabled = isEnabled(reading, element);
  if (force.expression.empty()) {
    fail(reading.source, element, "expression is empty, must be given",
         element.FirstChildElement("expression"));
  }
  return force;
}

void readForce(Reading& reading, const Element& element, std::map<std::string, int>& names) {
  Model& model = reading.model;
  const std::string_view kind = element.Name();
  const bool isMuscle = kind.find("Muscle") != std::string_view::npos;
  const bool isKnown = isMuscle || kind == "CoordinateLimitForce" ||
                       kind == "SpringGeneralizedForce" || kind == "ExpressionBasedCoordinateForce";
  if (!isKnown && readBodyForce(reading, element, names)) return;
  if (!isKnown) {
    if (isEnabled(reading, element)) {
      model.warnings.push_back(fmt::format("{} is not simulated", label(element)));
    }
    return;
  }
  requireNewName(reading, element, "force", names);
  if (isMuscle) {
    model.muscles.push_back(readMuscle(reading, element));
  } else if (kind == "CoordinateLimitForce") {
    model.limitForces.push_back(readLimitForce(reading, element));
  } else if (kind == "SpringGeneralizedForce") {
    model.springForces.push_back(readSpring(reading, element));
  } else {
    model.expressionForces.push_back(readExpression(reading, element));
  }
}

// Parts of a model that exert no force of their own.
bool isPassive(std::string_view kind) {
  return kind == "PhysicalOffsetFrame" || kind == "Marker" || kind == "Station" ||
         kind.starts_with("Contact") || kind.find("Controller") != std::string_view::npos;
}

// One line for each class of muscles whose dynamics are not simulated.
void warnOfOtherMuscles(Model& model) {
  std::map<std::string, std::string> names;
  for (const Muscle& muscle : model.muscles) {
    if (muscle.canBeSimulated() || !muscle.enabled) continue;
    std::string& list = names[muscle.className];
    list += (list.empty() ? "" : ", ") + muscle.name;
  }
  for (const auto& [kind, list] : names) {
    model.warnings.push_back(
        fmt::format("{} is not simulated, only the paths are used: {}", kind, list));
  }
}

}  // namespace

void readForces(Reading& reading, const Element& model) {
  std::map<std::string, int> names;
  for (const Element* element : objectsOf(model, "ForceSet")) readForce(reading, *element, names);
  for (const Element* element : objectsOf(model, "ComponentSet")) {
    if (!isPassive(element->Name())) readForce(reading, *element, names);
  }
  for (const Element* element : childrenOf(model.FirstChildElement("components"))) {
    if (!isPassive(element->Name())) readForce(reading, *element, names);
  }
  warnOfOtherMuscles(reading.model);
}

}  // namespace bio::osim
