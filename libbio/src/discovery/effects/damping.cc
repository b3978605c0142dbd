#include <cmath>

#include "discovery/effects/effects.h"

// Forces against the motion. Priors: what healthy elbows and orthoses show, of the order of 0.1 to
// 0.5 N·m·s/rad and 0.5 N·m (MacKay et al. 1986; Esteki & Mansour 1996 for exponents below 1).

namespace bio::discover {
namespace {

/// Anything that damps through the whole range.
std::string damperOf(const EncompassingModel& model) {
  for (const SpringGeneralizedForce& spring : model.base().springForces) {
    const bool here = spring.enabled && spring.coordinate == model.coordinate().name;
    if (here && spring.viscosity != 0) return spring.name;
  }
  for (const CoordinateLimitForce& limit : model.base().limitForces) {
    if (!limit.enabled || limit.coordinate != model.coordinate().name) continue;
    if (evaluate(limit, model.middle(), 1).dForce_dqDot != 0) return limit.name;
  }
  return {};
}

}  // namespace

void addViscousDamping(EncompassingModel& model) {
  if (const std::string damper = damperOf(model); !damper.empty()) {
    return model.addPresent("visc", damper);
  }
  const std::size_t law =
      model.addLaw(SpringGeneralizedForce{lawName(model, "visc"), model.coordinate().name});
  const std::size_t b =
      model.add(amplitude("visc.viscosity", "N m s/rad", 0, 3, 0.3),
                {Meaning::Kind::shift, {{model.number(SpringForceTarget{law, 2}, 0)}}});
  model.lawFollows({b});
  model.add(candidate(model, "visc", "viscous joint damping",
                      "The joint resists its motion in proportion to the speed.",
                      info::discover::EffectKind::structure, {b}, {{0.1}}));
}

void addCoulombFriction(EncompassingModel& model) {
  addExpression(model, {"coulomb",
                        "Coulomb friction",
                        "The joint resists its motion with a constant torque at any speed.",
                        "-c*tanh(qdot/0.05)",
                        {"c"},
                        {amplitude("coulomb.torque", "N m", 0, 3, 0.6)},
                        {{0.2}}});
}

void addStribeckFriction(EncompassingModel& model) {
  addExpression(model,
                {"stribeck",
                 "Stribeck friction",
                 "The joint resists its motion with a torque that is twice as large near rest.",
                 "-c*(1+exp(-(qdot/v)^2))*tanh(qdot/0.05)",
                 {"c", "v"},
                 {amplitude("stribeck.torque", "N m", 0, 3, 0.6),
                  shape("stribeck.speed", "rad/s", 0.3, 0.1, 1, 0.15)},
                 {{0.15, 0.3}}});
}

void addQuadraticDrag(EncompassingModel& model) {
  addExpression(model, {"drag",
                        "quadratic drag",
                        "The joint resists its motion in proportion to the square of the speed.",
                        "-c*qdot*abs(qdot)",
                        {"c"},
                        {amplitude("drag.coefficient", "N m s^2/rad^2", 0, 1, 0.1)},
                        {{0.03}}});
}

void addPowerDamping(EncompassingModel& model) {
  addExpression(model, {"powerdamp",
                        "sub-linear damping",
                        "The joint resists its motion with a power of the speed between 0 "
                        "(constant) and 1 (proportional).",
                        "-b*qdot*exp((n-1)/2*log(qdot^2+0.0001))",
                        {"b", "n"},
                        {amplitude("powerdamp.torque", "N m at 1 rad/s", 0, 3, 0.3),
                         shape("powerdamp.exponent", "", 0.5, 0.2, 0.9, 0.2)},
                        {{0.2, 0.5}}});
}

}  // namespace bio::discover
