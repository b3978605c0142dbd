#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "bio/forces/coordinate_force.h"
#include "bio/model/units.h"
#include "opensim/writing.h"

namespace bio::osim {
namespace {

void appendEnabled(const Writing& writing, Element& element, bool enabled) {
  const bool is4 = writing.format == Format::opensim4;
  appendFlag(element, is4 ? "appliesForce" : "isDisabled", is4 == enabled);
}

void appendSchutte(Element& element, const SchutteParameters& p) {
  appendNumber(element, "min_control", p.minControl);
  appendNumber(element, "max_control", p.maxControl);
  appendNumber(element, "max_isometric_force", p.maxIsometricForce);
  appendNumber(element, "optimal_fiber_length", p.optimalFibreLength);
  appendNumber(element, "tendon_slack_length", p.tendonSlackLength);
  appendNumber(element, "pennation_angle_at_optimal", p.pennation);
  appendNumber(element, "time_scale", p.timeScale);
  appendNumber(element, "activation1", p.activation1);
  appendNumber(element, "activation2", p.activation2);
  appendNumber(element, "damping", p.damping);
  appendSpline(element, p.tendonForceLength, "tendon_force_length_curve");
  appendSpline(element, p.activeForceLength, "active_force_length_curve");
  if (p.passiveForceLength) {
    appendSpline(element, *p.passiveForceLength, "passive_force_length_curve");
  }
}

void appendOptional(Element&, const muscles::Thelen2003Parameters<double>&) {}
void appendOptional(Element&, const muscles::Millard2012Parameters<double>&) {}
void appendOptional(Element& element, const muscles::DeGrooteFregly2016Parameters<double>& p) {
  appendFlag(element, "ignore_passive_fiber_force", p.ignorePassiveFibreForce);
}

void appendOptional(Element& element, const muscles::RigidTendonParameters<double>& p) {
  appendSpline(element, p.curves.activeForceLength, "active_force_length_curve");
  appendSpline(element, p.curves.passiveForceLength, "passive_force_length_curve");
  appendSpline(element, p.curves.forceVelocity, "force_velocity_curve");
}

// Every number by the class's own table, those of a sub-object together in it.
void appendHill(Element& element, const muscles::AnyParameters& any) {
  std::visit(
      [&]<class Parameters>(const Parameters& p) {
        appendNumber(element, "min_control", p.minControl);
        appendNumber(element, "max_control", p.maxControl);
        appendFlag(element, "ignore_tendon_compliance", p.ignoreTendonCompliance);
        appendFlag(element, "ignore_activation_dynamics", p.ignoreActivationDynamics);
        appendOptional(element, p);
        Element* curve = nullptr;
        for (std::size_t i = 0; i < Parameters::count; ++i) {
          if (!p.isGiven(i)) continue;
          const std::string_view name = Parameters::properties[i].name;
          const std::size_t cut = name.find('/');
          if (cut == name.npos) {
            appendNumber(element, std::string(name).c_str(), Parameters::at(p, i));
            continue;
          }
          const std::string owner(name.substr(0, cut)), property(name.substr(cut + 1));
          if (!curve || owner != curve->Name()) curve = &append(element, owner.c_str());
          appendNumber(*curve, property.c_str(), Parameters::at(p, i));
        }
      },
      any);
}

// value·factor, rounded to 15 digits where that is as near as doubles get, so that 85 stays 85.
double converted(double value, double factor) {
  const double exact = value * factor;
  const double round = std::strtod(fmt::format("{:.15g}", exact).c_str(), nullptr);
  return std::abs(round - exact) <= 2e-16 * std::abs(exact) ? round : exact;
}

// OpenSim wants limits of an angle in degrees, stiffness and damping per degree.
void appendLimitForce(const Writing& writing, Element& parent, const CoordinateLimitForce& force) {
  const bool angle = findCoordinate(writing.model, force.coordinate).isRotation;
  const double degrees = angle ? degreesPerRadian : 1.0;
  Element& element = append(parent, "CoordinateLimitForce", force.name);
  appendEnabled(writing, element, force.enabled);
  appendText(element, "coordinate", force.coordinate);
  appendNumber(element, "upper_stiffness", converted(force.upperStiffness, 1 / degrees));
  appendNumber(element, "upper_limit", converted(force.upperLimit, degrees));
  appendNumber(element, "lower_stiffness", converted(force.lowerStiffness, 1 / degrees));
  appendNumber(element, "lower_limit", converted(force.lowerLimit, degrees));
  appendNumber(element, "damping", converted(force.damping, 1 / degrees));
  appendNumber(element, "transition", converted(force.transition, degrees));
}

}  // namespace

void appendMuscle(const Writing& writing, Element& parent, const Muscle& muscle) {
  Element& element = append(parent, muscle.className.c_str(), muscle.name);
  appendEnabled(writing, element, muscle.enabled);
  appendPath(writing, element, muscle.path);
  if (muscle.schutte) appendSchutte(element, *muscle.schutte);
  if (muscle.hill) appendHill(element, *muscle.hill);
}

void appendCoordinateForces(const Writing& writing, Element& parent) {
  for (const CoordinateLimitForce& force : writing.model.limitForces) {
    appendLimitForce(writing, parent, force);
  }
  for (const SpringGeneralizedForce& force : writing.model.springForces) {
    Element& element = append(parent, "SpringGeneralizedForce", force.name);
    appendEnabled(writing, element, force.enabled);
    appendText(element, "coordinate", force.coordinate);
    appendNumber(element, "stiffness", force.stiffness);
    appendNumber(element, "rest_length", force.restLength);
    appendNumber(element, "viscosity", force.viscosity);
  }
  for (const ExpressionBasedCoordinateForce& force : writing.model.expressionForces) {
    Element& element = append(parent, "ExpressionBasedCoordinateForce", force.name);
    appendEnabled(writing, element, force.enabled);
    appendText(element, "coordinate", force.coordinate);
    appendText(element, "expression", plainExpression(force));
  }
}

}  // namespace bio::osim
