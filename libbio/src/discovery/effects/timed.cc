#include <fmt/format.h>

#include "bio/discovery/end_of_limb.h"
#include "discovery/effects/effects.h"

// Forces that begin or end during the trials. Priors: those of a constant torque and of a mass in
// the hand; the time may be any, which the trials' length says (EncompassingModel::trialsLast).

namespace bio::discover {

using info::discover::EffectKind;

using Kind = TimedForce::Kind;

namespace {

/// Adds the two quantities of a timed force. @return the force
TimedForce withQuantities(EncompassingModel& model, const std::string& id, const std::string& word,
                          TimedForce force, info::discover::Quantity size) {
  size.name = id + "." + word;
  force.amplitude = model.add(std::move(size), {Meaning::Kind::timed, {}});
  force.time = model.add(shape(id + ".time", "s", 1, 0, 2, 1), {Meaning::Kind::timed, {}});
  model.addTimedForce(force);
  return force;
}

}  // namespace

void addTimedTorques(EncompassingModel& model, const MovingCoordinate& at) {
  const CoordinateUnits units = unitsOf(model, at);
  const double most = units.strength;
  const auto which = static_cast<std::size_t>(&at - model.coordinates().data());
  const auto add = [&](const char* id, bool ends, const std::string& name,
                       const std::string& sentence) {
    const TimedForce force =
        withQuantities(model, model.idAt(at, id), units.word, {Kind::force, ends, which, 0, 0},
                       amplitude("", units.force, -10 * most, 10 * most, 1 * most));
    model.add(candidateAt(model, at, id, name, sentence, {force.amplitude, force.time},
                          {{0.3 * most, 1.0}}));
  };
  add("torque_from", false, units.word + " that starts during the trial",
      fmt::format("A constant {} starts to act on the joint during the trial.", units.word));
  add("torque_until", true, units.word + " that ends during the trial",
      fmt::format("A constant {} acts on the joint and ends during the trial.", units.word));
}

void addTimedMasses(EncompassingModel& model) {
  // its moment is that of a mass on a coordinate that moves as measured, of one coordinate
  if (model.movedBodies().empty() || !model.hasOneCoordinate()) return;
  const std::string hand = endOfLimb(model);
  const double size = heaviness(model);
  const std::string subject = hand == "the hand" ? "The hand" : hand;
  const auto add = [&](const char* id, bool ends, const std::string& name,
                       const std::string& sentence) {
    const TimedForce force = withQuantities(model, id, "mass", {Kind::mass, ends, 0, 0, 0},
                                            amplitude("", "kg", 0, 5 * size, 0.7 * size));
    model.add(candidate(model, id, name, sentence, EffectKind::structure,
                        {force.amplitude, force.time}, {{0.3 * size, 1.0}}));
  };
  add("mass_from", false, "mass picked up by " + hand,
      subject + " picks up a mass during the trial.");
  add("mass_until", true, "mass put down by " + hand,
      subject + " carries a mass and puts it down during the trial.");
}

}  // namespace bio::discover
