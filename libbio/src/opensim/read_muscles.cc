#include <fmt/format.h>
#include <cmath>

#include <numbers>
#include <string_view>

#include "opensim/reading.h"

namespace bio::osim {
namespace {

// What OpenSim's Schutte class uses when the file gives no curve.
SplineFunction defaultTendonCurve() {
  return {{-10, -0.002, -0.001, 0, 0.00131, 0.00281, 0.00431, 0.00581, 0.00731, 0.00881, 0.0103,
           0.0118, 0.0123, 9.2, 9.201, 9.202, 20},
          {0, 0, 0, 0, 0.0108, 0.0257, 0.0435, 0.0652, 0.0915, 0.123, 0.161, 0.208, 0.227, 345, 345,
           345, 345}};
}

SplineFunction defaultActiveCurve() {
  return {{-5.307692, -4.307692, -1.923077, -0.884615, -0.269231, 0.230769, 0.461538,
           0.52725,   0.62875,   0.71875,   0.86125,   1.045,     1.2175,   1.43875,
           1.5,       1.615385,  2,         2.961538,  3.692308,  5.461538, 9.901902},
          {0.012188, 0.021899, 0.036466, 0.052493, 0.075312, 0.114158, 0.157859,
           0.226667, 0.636667, 0.856667, 0.95,     0.993333, 0.77,     0.246667,
           0.193821, 0.133252, 0.072683, 0.044417, 0.036341, 0.021899, 0.007332}};
}

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
  p.tendonForceLength = tendon ? readCurve(reading, *tendon) : defaultTendonCurve();
  p.activeForceLength = active ? readCurve(reading, *active) : defaultActiveCurve();
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
