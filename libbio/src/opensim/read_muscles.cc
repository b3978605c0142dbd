#include <fmt/format.h>
#include <cmath>

#include <numbers>
#include <string_view>

#include "bio/muscle/muscle_parameters.h"
#include "opensim/reading.h"

namespace bio::osim {
namespace {

// A curve may come from the class's default object too.
const Element* findCurve(const Source& source, const Element& element, const char* name) {
  if (const Element* own = findFunction(element, name)) return own;
  const auto found = source.defaults.find(element.Name());
  return found == source.defaults.end() ? nullptr : findFunction(*found->second, name);
}

SplineFunction readCurve(Reading& reading, const Element& element) {
  const std::string_view kind = element.Name();
  if (kind == "NaturalCubicSpline" || kind == "natCubicSpline") {
    reading.model.warnings.push_back(
        fmt::format("{} is evaluated with the end conditions of a SimmSpline", label(element)));
  } else if (kind != "SimmSpline") {
    fail(reading.source, element, fmt::format("curve of class {}, must be a SimmSpline", kind));
  }
  return readSpline(reading, element);
}

// Muscle's and the Schutte class's own defaults in OpenSim stand where the file is silent.
SchutteParameters readSchutte(Reading& reading, const Element& element) {
  const Source& source = reading.source;
  const auto positive = [&](const char* property, const char* unit, double fallback) {
    return readNumber(source, element, property, unit, Rule::positive, fallback);
  };
  SchutteParameters p;
  p.maxIsometricForce = positive("max_isometric_force", "N", 1000);
  p.optimalFibreLength = positive("optimal_fiber_length", "m", 0.1);
  p.tendonSlackLength = positive("tendon_slack_length", "m", 0.2);
  p.pennation =
      readNumber(source, element, "pennation_angle_at_optimal", "rad", Rule::notNegative, 0.0);
  if (!(p.pennation < std::numbers::pi / 2)) {
    fail(source, element,
         fmt::format("pennation_angle_at_optimal = {} rad, must be < π/2", p.pennation),
         findProperty(source, element, "pennation_angle_at_optimal"));
  }
  p.timeScale = positive("time_scale", "s", 0.1);
  p.activation1 = readNumber(source, element, "activation1", "", Rule::notNegative, 7.667);
  p.activation2 = positive("activation2", "", 1.459854);
  p.damping = positive("damping", "", 0.1);
  p.minControl = readNumber(source, element, "min_control", "", Rule::notNegative, 0.0);
  p.maxControl = readNumber(source, element, "max_control", "", Rule::positive, 1.0);
  if (!(p.minControl < p.maxControl)) {
    fail(source, element,
         fmt::format("min_control = {}, must be < max_control = {}", p.minControl, p.maxControl));
  }
  const Element* tendon = findCurve(source, element, "tendon_force_length_curve");
  const Element* active = findCurve(source, element, "active_force_length_curve");
  const Element* passive = findCurve(source, element, "passive_force_length_curve");
  p.tendonForceLength = tendon ? readCurve(reading, *tendon) : schutteTendonCurve();
  p.activeForceLength = active ? readCurve(reading, *active) : schutteActiveCurve();
  if (passive) p.passiveForceLength = readCurve(reading, *passive);
  return p;
}

}  // namespace

Muscle readMuscle(Reading& reading, const Element& element) {
  Muscle muscle;
  muscle.name = nameOf(reading.source, element);
  muscle.className = element.Name();
  muscle.enabled = isEnabled(reading, element);
  muscle.path = readPath(reading, element);
  if (muscle.className.starts_with("Schutte1993Muscle")) {
    muscle.schutte = readSchutte(reading, element);
  }
  return muscle;
}

}  // namespace bio::osim
