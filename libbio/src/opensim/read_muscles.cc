#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <stdexcept>
#include <string_view>

#include "bio/muscle/muscle_parameters.h"
#include "bio/tables/file_error.h"
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

// One number of a class's table; of a sub-object where its name has a class in front. Null: absent.
struct Place {
  const Element* owner;  // of the property
  std::string property;
  const Element* element;
};
Place findNumber(const Source& source, const Element& element, std::string_view name) {
  const std::size_t cut = name.find('/');
  if (cut == name.npos) {
    const std::string property(name);
    return {&element, property, findProperty(source, element, property.c_str())};
  }
  const std::string owner(name.substr(0, cut)), property(name.substr(cut + 1));
  const Element* curve = findProperty(source, element, owner.c_str());
  return {curve, property, curve ? curve->FirstChildElement(property.c_str()) : nullptr};
}

// The optional numbers of a curve: all in the file or none.
bool areGiven(const Source& source, const Element& element,
              std::initializer_list<const char*> names) {
  std::size_t given = 0;
  for (const char* name : names) {
    const Element* number = findNumber(source, element, name).element;
    if (number && !trimmedText(number).empty()) ++given;
  }
  if (given != 0 && given != names.size()) {
    fail(source, element,
         fmt::format("{} of the {} optional numbers of {} are given, must be all or none", given,
                     names.size(),
                     std::string_view(*names.begin())
                         .substr(0, std::string_view(*names.begin()).find('/'))));
  }
  return given != 0;
}

void readOptional(Reading&, const Element&, muscles::Thelen2003Parameters<double>&) {}
void readOptional(Reading& reading, const Element& element,
                  muscles::DeGrooteFregly2016Parameters<double>& p) {
  p.ignorePassiveFibreForce =
      readFlag(reading.source, element, "ignore_passive_fiber_force", p.ignorePassiveFibreForce);
}
void readOptional(Reading& reading, const Element& element,
                  muscles::Millard2012Parameters<double>& p) {
  const Source& source = reading.source;
  p.passiveShapeIsGiven = areGiven(
      source, element,
      {"FiberForceLengthCurve/stiffness_at_low_force",
       "FiberForceLengthCurve/stiffness_at_one_norm_force", "FiberForceLengthCurve/curviness"});
  p.tendonShapeIsGiven = areGiven(
      source, element,
      {"TendonForceLengthCurve/stiffness_at_one_norm_force",
       "TendonForceLengthCurve/norm_force_at_toe_end", "TendonForceLengthCurve/curviness"});
}

// The class has neither, whatever the switches of Muscle say in its file.
void readOptional(Reading& reading, const Element& element,
                  muscles::RigidTendonParameters<double>& p) {
  p.ignoreTendonCompliance = p.ignoreActivationDynamics = true;
  const auto readInto = [&](const char* name, SplineFunction& curve) {
    if (const Element* given = findCurve(reading.source, element, name)) {
      curve = readCurve(reading, *given);
    }
  };
  readInto("active_force_length_curve", p.curves.activeForceLength);
  readInto("passive_force_length_curve", p.curves.passiveForceLength);
  readInto("force_velocity_curve", p.curves.forceVelocity);
}

// Every number by the class's own table; where the file is silent OpenSim's default stands.
muscles::AnyParameters readHill(Reading& reading, const Element& element) {
  const Source& source = reading.source;
  muscles::AnyParameters any = muscles::MuscleClasses::defaultsOf(element.Name());
  std::visit(
      [&]<class Parameters>(Parameters& p) {
        p.ignoreTendonCompliance =
            readFlag(source, element, "ignore_tendon_compliance", p.ignoreTendonCompliance);
        p.ignoreActivationDynamics =
            readFlag(source, element, "ignore_activation_dynamics", p.ignoreActivationDynamics);
        p.minControl = readNumber(source, element, "min_control", "", Rule::finite, p.minControl);
        p.maxControl = readNumber(source, element, "max_control", "", Rule::finite, p.maxControl);
        readOptional(reading, element, p);
        for (std::size_t i = 0; i < Parameters::count; ++i) {
          if (!p.isGiven(i)) continue;
          const auto& property = Parameters::properties[i];
          Place place = findNumber(source, element, property.name);
          // so it was called in files of OpenSim 2
          if (!place.element && property.name == "pennation_angle_at_optimal") {
            place = findNumber(source, element, "pennation_angle");
          }
          if (!place.element) continue;
          double& value = Parameters::at(p, i);
          value = readNumber(source, *place.owner, place.property.c_str(),
                             std::string(property.unit).c_str(), Rule::finite, value);
        }
        try {
          p.requireRules();
        } catch (const std::invalid_argument& broken) {
          fail(source, element, broken.what());
        }
      },
      any);
  return any;
}

}  // namespace

Muscle readMuscle(Reading& reading, const Element& element) {
  Muscle muscle;
  muscle.name = nameOf(reading.source, element);
  muscle.className = element.Name();
  muscle.enabled = isEnabled(reading, element);
  muscle.path = readPath(reading, element);
  try {
    if (muscle.className.starts_with("Schutte1993Muscle")) {
      muscle.schutte = readSchutte(reading, element);
    } else if (muscles::MuscleClasses::has(muscle.className)) {
      muscle.hill = readHill(reading, element);
    }
  } catch (const UnreadableNumber&) {
    throw;
  } catch (const FileError& broken) {
    // a number that a muscle cannot have is no reason to refuse the rest of the model
    const std::string what = broken.what();
    muscle.schutte.reset();
    muscle.hill.reset();
    reading.model.warnings.push_back(
        fmt::format("line {}; the muscle is not simulated, only its path is used",
                    what.substr(std::min(what.size(), reading.source.file.size() + 1))));
  }
  return muscle;
}

}  // namespace bio::osim
