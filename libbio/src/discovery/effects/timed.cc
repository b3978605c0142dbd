#include <fmt/format.h>

#include "bio/discovery/end_of_limb.h"
#include "discovery/effects/effects.h"

// Forces that begin or end during the trials. Priors: those of a constant torque and of a mass in
// the hand; the time may be any, which the trials' length says (EncompassingModel::trialsLast).

namespace bio::discover {

using info::discover::EffectKind;

void addTimedForces(EncompassingModel& model) {
  const CoordinateUnits units = unitsOf(model);
  const double most = units.strength;
  const auto add = [&](const char* id, const std::string& name, const std::string& sentence,
                       TimedForce force, info::discover::Quantity size,
                       const std::vector<double>& starts) {
    size.name = fmt::format("{}.{}", id, force.of == TimedForce::Of::mass ? "mass" : units.word);
    force.amplitude = model.add(std::move(size), {Meaning::Kind::timed, {}});
    force.time =
        model.add(shape(fmt::format("{}.time", id), "s", 1, 0, 2, 1), {Meaning::Kind::timed, {}});
    std::vector<std::vector<double>> all;
    for (const double start : starts) all.push_back({start, 1.0});
    model.add(candidate(model, id, name, sentence, EffectKind::structure,
                        {force.amplitude, force.time}, all));
    model.addTimedForce(force);
  };
  using Of = TimedForce::Of;
  const auto torque = amplitude("", units.force, -10 * most, 10 * most, 1 * most);
  add("torque_from", units.word + " that starts during the trial",
      fmt::format("A constant {} starts to act on the joint during the trial.", units.word),
      {Of::force, false, 0, 0}, torque, {0.3 * most});
  add("torque_until", units.word + " that ends during the trial",
      fmt::format("A constant {} acts on the joint and ends during the trial.", units.word),
      {Of::force, true, 0, 0}, torque, {0.3 * most});
  if (model.movedBodies().empty()) return;
  const auto mass = amplitude("", "kg", 0, 5, 0.7);
  const std::string hand = endOfLimb(model);
  const std::string subject = hand == "the hand" ? "The hand" : hand;
  add("mass_from", "mass picked up by " + hand, subject + " picks up a mass during the trial.",
      {Of::mass, false, 0, 0}, mass, {0.3});
  add("mass_until", "mass put down by " + hand,
      subject + " carries a mass and puts it down during the trial.", {Of::mass, true, 0, 0}, mass,
      {0.3});
}

}  // namespace bio::discover
