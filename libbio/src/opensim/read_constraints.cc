#include <fmt/format.h>

#include <sstream>
#include <string_view>

#include "opensim/reading.h"

namespace bio::osim {
namespace {

void readCoupler(Reading& reading, const Element& element, std::map<std::string, int>& dependents) {
  const Source& source = reading.source;
  std::istringstream names(readText(source, element, "independent_coordinate_names"));
  std::string first, second;
  names >> first >> second;
  if (!second.empty()) {
    reading.model.warnings.push_back(
        fmt::format("{} is not simulated: it depends on several coordinates", label(element)));
    return;
  }
  CoordinateCoupler coupler;
  coupler.name = nameOf(source, element);
  coupler.independent = readCoordinateName(reading, element, "independent_coordinate_names");
  coupler.dependent = readCoordinateName(reading, element, "dependent_coordinate_name");
  const Element* function = findFunction(element, "coupled_coordinates_function");
  if (!function) fail(source, element, "coupled_coordinates_function is missing, must be given");
  coupler.function = readFunction(reading, *function);
  coupler.function.scale *= readNumber(source, element, "scale_factor", "", Rule::finite, 1.0);
  if (coupler.independent == coupler.dependent) {
    fail(source, element,
         fmt::format("couples '{}' to itself, must name two coordinates", coupler.dependent));
  }
  const auto [found, isNew] = dependents.emplace(coupler.dependent, element.GetLineNum());
  if (!isNew) {
    fail(source, element,
         fmt::format("dependent_coordinate_name = '{}' is coupled in line {} already, one coupler "
                     "per coordinate",
                     coupler.dependent, found->second));
  }
  reading.model.couplers.push_back(std::move(coupler));
}

}  // namespace

std::string readCoordinateName(const Reading& reading, const Element& object,
                               const char* property) {
  std::string name = readText(reading.source, object, property);
  if (const auto slash = name.find_last_of('/'); slash != std::string::npos) {
    // "/jointset/j1/rz": by joint and name where several joints have one of this name
    const auto before = slash == 0 ? std::string::npos : name.find_last_of('/', slash - 1);
    const std::string full = before == std::string::npos ? name : name.substr(before + 1);
    name = coordinateOrNull(reading.model, full) ? full : name.substr(slash + 1);
  }
  if (!coordinateOrNull(reading.model, name)) {
    fail(reading.source, object,
         fmt::format("{} = '{}', must name a coordinate of the model", property, name),
         object.FirstChildElement(property));
  }
  return name;
}

bool isEnabled(const Reading& reading, const Element& force) {
  return readFlag(reading.source, force, "appliesForce", true) &&
         readFlag(reading.source, force, "isEnforced", true) &&
         !readFlag(reading.source, force, "isDisabled", false);
}

void readConstraints(Reading& reading, const Element& model) {
  std::map<std::string, int> dependents;
  for (const Element* element : objectsOf(model, "ConstraintSet")) {
    if (!isEnabled(reading, *element)) continue;
    if (std::string_view(element->Name()) == "CoordinateCouplerConstraint") {
      readCoupler(reading, *element, dependents);
    } else {
      reading.model.warnings.push_back(fmt::format("{} is not simulated", label(*element)));
    }
  }
}

}  // namespace bio::osim
