#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "bio/discovery/end_of_limb.h"
#include "discovery/effects/effects.h"

// Loads: masses, gravity, constant forces. Priors: what a hand holds in a laboratory (0.7 kg), how
// well an upper arm is held upright (0.3 rad), slight contact forces (3 N, 1 N·m).

namespace bio::discover {
namespace {

using Eigen::Vector3d;

/// Unit vector along which gravity has no part, in the plane that the joint moves in; zero if the
/// joint does not turn about a fixed axis across gravity.
Vector3d horizontal(const EncompassingModel& model) {
  const Vector3d direction = model.axis().cross(model.base().gravity);
  const double size = direction.norm();
  if (!(size > 1e-6 * model.base().gravity.norm())) return Vector3d::Zero();
  return direction / size;
}

}  // namespace

void addExperimentalConditions(EncompassingModel& model) {
  ConditionQuantities conditions;
  if (!model.movedBodies().empty()) {
    conditions.massInHand =
        model.add(amplitude("known.mass", "kg", 0, 100, 1),
                  {Meaning::Kind::shift, model.numbers(model.movedBodies().back() + ".mass")});
  }
  if (!horizontal(model).isZero()) {
    conditions.armTurn =
        model.add(amplitude("known.turn", "rad", -std::numbers::pi, std::numbers::pi, 1),
                  {Meaning::Kind::tilt, {}});
  }
  model.setConditions(conditions);
}

void addPayload(EncompassingModel& model) {
  if (model.movedBodies().empty()) return;
  const std::string& hand = model.movedBodies().back();
  const double size = heaviness(model);
  const std::size_t m = model.add(amplitude("payload.mass", "kg", 0, 5 * size, 0.7 * size),
                                  {Meaning::Kind::shift, model.numbers(hand + ".mass")});
  model.add(candidate(model, "payload", "mass " + placeOfMass(model),
                      fmt::format("The {} carries a mass that the model does not have.", hand),
                      info::discover::EffectKind::structure, {m}, {{0.2 * size}}, {"mass"}));
}

void addTilt(EncompassingModel& model) {
  if (horizontal(model).isZero()) return;
  const std::size_t angle =
      model.add(amplitude("tilt.angle", "rad", -0.5, 0.5, 0.3), {Meaning::Kind::tilt, {}});
  const std::string what = model.system().numMuscles() > 0 ? "limb" : "mechanism";
  model.add(candidate(model, "tilt", "tilt of the " + what,
                      "Gravity acts in a different direction than the model assumes: the " + what +
                          " is tilted in the plane of the joint.",
                      info::discover::EffectKind::structure, {angle}, {{0.05}}, {"handforce"}));
}

void addConstantTorque(EncompassingModel& model, const MovingCoordinate& at) {
  const CoordinateUnits units = unitsOf(model, at);
  const double size = units.strength;
  addExpression(model, at,
                {"const",
                 "constant joint " + units.word,
                 fmt::format("A constant {} acts on the joint.", units.word),
                 "c",
                 {"c"},
                 {amplitude("const." + units.word, units.force, -10 * size, 10 * size, 1 * size)},
                 {{0.2 * size}}});
}

// τ(q) = F e·∂p/∂q = F(A cos(q + t) + B sin(q + t)) where the joint is a plain hinge, with e
// horizontal, p the mass centre of the hand and t the known turn of the system.
void addHandForce(EncompassingModel& model) {
  // the force of one formula acts on one coordinate
  const Vector3d e = horizontal(model);
  if (e.isZero() || !model.hasOneCoordinate()) return;
  const std::string& hand = model.movedBodies().back();
  const auto arm = [&](double q) { return e.dot(model.velocityOf(hand, q)); };
  const double A = arm(0), B = arm(std::numbers::pi / 2);
  for (const double q : {0.7, 1.9}) {
    if (std::abs(arm(q) - A * std::cos(q) - B * std::sin(q)) > 1e-9) return;
  }
  const double sign = A < 0 ? -1 : 1;
  constexpr std::size_t turn = 1;  // place of t in the constants
  const double size = heaviness(model);
  const auto force =
      addExpression(model, model.coordinates().front(),
                    {"handforce",
                     "horizontal force on " + endOfLimb(model),
                     fmt::format("A constant horizontal force acts on the {}.", hand),
                     fmt::format("F*(({:.17g})*cos(q+t)+({:.17g})*sin(q+t))", sign * A, sign * B),
                     {"F", "t"},
                     {amplitude("handforce.force", "N", -30 * size, 30 * size, 3 * size)},
                     {{0.5 * size}},
                     {"tilt"}});
  if (force)
    model.extend(*model.conditions().armTurn, {model.number(ExpressionTarget{*force, turn}, 0)});
}

}  // namespace bio::discover
