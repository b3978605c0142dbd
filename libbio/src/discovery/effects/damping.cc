#include <fmt/format.h>

#include <cmath>

#include "discovery/effects/effects.h"

// Forces against the motion. Priors: what healthy elbows and orthoses show, of the order of 0.1 to
// 0.5 N·m·s/rad and 0.5 N·m (MacKay et al. 1986; Esteki & Mansour 1996 for exponents below 1).

namespace bio::discover {
namespace {

/// Anything that damps through the whole range.
std::string damperOf(const EncompassingModel& model, const MovingCoordinate& at) {
  for (const SpringGeneralizedForce& spring : model.base().springForces) {
    const bool here = spring.enabled && spring.coordinate == at.coordinate.name;
    if (here && spring.viscosity != 0) return spring.name;
  }
  for (const CoordinateLimitForce& limit : model.base().limitForces) {
    if (!limit.enabled || limit.coordinate != at.coordinate.name) continue;
    if (evaluate(limit, at.middle(), 1).dForce_dqDot != 0) return limit.name;
  }
  return {};
}

}  // namespace

void addViscousDamping(EncompassingModel& model, const MovingCoordinate& at) {
  if (const std::string damper = damperOf(model, at); !damper.empty()) {
    return model.addPresent(model.idAt(at, "visc"), damper);
  }
  const CoordinateUnits units = unitsOf(model, at);
  const double size = units.strength / units.speedSize;
  const std::size_t law =
      model.addLaw(SpringGeneralizedForce{lawName(at, "visc"), at.coordinate.name});
  const std::size_t b = model.add(
      amplitude(model.idAt(at, "visc.viscosity"), units.viscosity(), 0, 3 * size, 0.3 * size),
      {Meaning::Kind::shift,
       {{model.number(SpringForceTarget{law, SpringForceTarget::Quantity::viscosity}, 0)}}});
  model.lawFollows({b});
  model.add(candidateAt(model, at, "visc", "viscous joint damping",
                        "The joint resists its motion in proportion to the speed.", {b},
                        {{0.1 * size}}));
}

void addCoulombFriction(EncompassingModel& model, const MovingCoordinate& at) {
  const CoordinateUnits units = unitsOf(model, at);
  const double size = units.strength, width = units.frictionWidth;
  ExpressionEffect effect{
      "coulomb",
      "Coulomb friction",
      fmt::format("The joint resists its motion with a constant {} at any speed.", units.word),
      fmt::format("-c*tanh(qdot/{})", width),
      {"c"},
      {amplitude("coulomb." + units.word, units.force, 0, 3 * size, 0.6 * size)},
      {{0.2 * size}}};
  if (model.system().numMuscles() == 0) {  // what sticks creeps at such a speed
    effect.expression = "-c*tanh(qdot/w)";
    effect.constants.emplace_back("w");
    effect.quantities.push_back(
        shape("coulomb.speed", units.speed, width, width / 5, 5 * width, 0.5 * width));
    effect.starts.front().push_back(width);
  }
  addExpression(model, at, effect);
}

void addStribeckFriction(EncompassingModel& model, const MovingCoordinate& at) {
  const CoordinateUnits units = unitsOf(model, at);
  const double size = units.strength, speed = units.speedSize;
  addExpression(
      model, at,
      {"stribeck",
       "Stribeck friction",
       fmt::format("The joint resists its motion with a {} that is twice as large near rest.",
                   units.word),
       fmt::format("-c*(1+exp(-(qdot/v)^2))*tanh(qdot/{})", units.frictionWidth),
       {"c", "v"},
       {amplitude("stribeck." + units.word, units.force, 0, 3 * size, 0.6 * size),
        shape("stribeck.speed", units.speed, 0.3 * speed, 0.1 * speed, 1 * speed, 0.15 * speed)},
       {{0.15 * size, 0.3 * speed}}});
}

void addQuadraticDrag(EncompassingModel& model, const MovingCoordinate& at) {
  const CoordinateUnits units = unitsOf(model, at);
  const double size = units.strength / (units.speedSize * units.speedSize);
  addExpression(
      model, at,
      {"drag",
       "quadratic drag",
       "The joint resists its motion in proportion to the square of the speed.",
       "-c*qdot*abs(qdot)",
       {"c"},
       {amplitude("drag.coefficient", fmt::format("{} s^2/{}^2", units.force, units.position), 0,
                  1 * size, 0.1 * size)},
       {{0.03 * size}}});
}

void addPowerDamping(EncompassingModel& model, const MovingCoordinate& at) {
  const CoordinateUnits units = unitsOf(model, at);
  // b |q̇|^n at n = 1/2 is as large as an elbow's where q̇ is `speedSize` times its speed
  const double size = units.strength / std::sqrt(units.speedSize);
  addExpression(
      model, at,
      {"powerdamp",
       "sub-linear damping",
       "The joint resists its motion with a power of the speed between 0 "
       "(constant) and 1 (proportional).",
       fmt::format("-b*qdot*exp((n-1)/2*log(qdot^2+{}))",
                   0.0001 * units.speedSize * units.speedSize),
       {"b", "n"},
       {amplitude("powerdamp." + units.word, fmt::format("{} at 1 {}", units.force, units.speed), 0,
                  3 * size, 0.3 * size),
        shape("powerdamp.exponent", "", 0.5, 0.2, 0.9, 0.2)},
       {{0.2 * size, 0.5}}});
}

}  // namespace bio::discover
