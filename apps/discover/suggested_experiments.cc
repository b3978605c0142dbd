#include "discover/suggested_experiments.h"

#include <algorithm>

#include "bio/discovery/end_of_limb.h"

namespace app {

using info::discover::Finding;

namespace {

/// "visc" of "knee_angle_r.visc".
std::string withoutOwner(const std::string& id) {
  return id.substr(id.rfind('.') + 1);
}

}  // namespace

namespace {

FollowUps followUpsOfMechanisms(const std::string& end, const std::string& place) {
  return {
      {
          {{"drive_delay", "drive_lag", "clock", "lag"},
           "Repeat a trial with steps of the command: behind a lag the motion begins at once but "
           "slowly, behind a delay late; where the sensor is late, a push by hand shows late, "
           "too."},
          {{"drive_gain", "mass", "payload", "inertia_", "centre_", "gain"},
           "Repeat a trial with a known mass, e.g. 1 kg, " + place +
               ", and let it swing without the drive: the first depends on the drive's gain, the "
               "second does not."},
          {{"drive_saturation", "drive_gain"},
           "Repeat a trial with half the command: a drive below its limit does not saturate."},
          {{"tilt", "handforce", "const"},
           "Repeat a trial with a known mass, e.g. 1 kg, " + place + ": the effect of gravity " +
               "grows with it, a force on " + end + " does not."},
          {{"payload", "mass", "const", "handforce"},
           "Let it swing without its drive: a mass adds weight and inertia, a force adds no "
           "inertia."},
          {{"visc", "coulomb", "stribeck", "drag", "powerdamp"},
           "Repeat the trial at half and at twice the speed: at twice the speed Coulomb friction "
           "is unchanged, viscous torque doubles, quadratic drag quadruples."},
      },
      "Repeat the trials at another speed and with a known mass " + place +
          ": these data cannot distinguish the effects listed together.",
      "Record motion without the drive over the region that the score map marks: this shows "
      "whether the missing effect belongs to the joint or to the drive.",
      "Record one more trial and compare it with the motion that with_effect.osim predicts."};
}

}  // namespace

FollowUps followUpsOfModels(const bio::discover::EncompassingModel& model) {
  std::string loadColumn;
  for (const bio::discover::MovingCoordinate& at : model.coordinates())
    loadColumn += (loadColumn.empty() ? "" : " or ") + at.coordinate.name +
                  (at.coordinate.isRotation ? ".torque" : ".force");
  const std::string end = bio::discover::endOfLimb(model);
  const std::string place = bio::discover::placeOfMass(model);
  if (model.system().numMuscles() == 0) return followUpsOfMechanisms(end, place);
  FollowUps known{
      {
          {{"delay", "clock"},
           "Repeat a trial with recorded pulses of external load (column " + loadColumn +
               "): the limb responds to a pulse at once and to its muscles with a delay, whereas "
               "a clock offset shifts both."},
          {{"tilt", "handforce", "const"},
           "Repeat a trial with a known mass, e.g. 1 kg, " + place + ": the effect of gravity " +
               "grows with it, a force on " + end + " does not."},
          {{"payload", "mass", "const", "handforce"},
           "Let the limb hang and swing passively with relaxed muscles: a mass adds weight and "
           "inertia, a force adds no inertia."},
          {{"gain_", "Fmax_", "lopt_", "lslack_", "crosstalk", "saturated_", "offset_"},
           "Record one isolated contraction of each muscle, and one against a load cell at a "
           "fixed angle."},
          {{"stiffness", "cubic", "tilt", "limit", "wrap_", "gain", "bias", "Fmax_"},
           "Move the relaxed limb slowly through its whole range with a dynamometer (column " +
               loadColumn + "): this shows the passive effects without the muscles."},
          {{"missing_", "Fmax_", "gain_"},
           "Record the EMG of the muscle that is switched off in the model (a column with its "
           "name): this distinguishes it from its synergists."},
          {{"visc", "coulomb", "stribeck", "drag", "powerdamp"},
           "Repeat the trial at half and at twice the speed: at twice the speed Coulomb friction "
           "is unchanged, viscous torque doubles, quadratic drag quadruples."},
      },
      "Repeat the trials at another speed and with a known mass " + place +
          ": these data cannot distinguish the effects listed together.",
      "Record passive motion (relaxed muscles, limb moved by hand or by a dynamometer) over the "
      "region that the score map marks: this shows whether the missing effect belongs to the "
      "joint or to the muscles.",
      "Record one more trial and compare it with the motion that with_effect.osim predicts."};
  const bool isOnADynamometer =
      std::any_of(model.coordinates().begin(), model.coordinates().end(),
                  [&](const auto& at) { return model.system().isPrescribed(at.index); });
  if (isOnADynamometer)
    known.interventions.push_back(
        {{"lever_", "payload", "mass", "tilt", "const", "bias", "lag"},
         "Record the dynamometer moving as in a trial without the limb: "
         "what its lever weighs and its inertia are in that record alone."});
  return known;
}

std::string followUp(const info::discover::DiscoveryProblem& data,
                     const info::discover::Verdict& verdict, const FollowUps& known) {
  const auto& candidates = data.candidates();
  for (const auto& effect : verdict.effects) {
    if (effect.equals.size() < 2) continue;
    const Intervention* best = nullptr;
    long most = 1;
    for (const Intervention& intervention : known.interventions) {
      const long touched =
          std::count_if(effect.equals.begin(), effect.equals.end(), [&](std::size_t c) {
            return std::any_of(intervention.separates.begin(), intervention.separates.end(),
                               [&](const std::string& id) {
                                 return candidates[c].id.starts_with(id) ||
                                        withoutOwner(candidates[c].id).starts_with(id);
                               });
          });
      if (touched > most) {
        most = touched;
        best = &intervention;
      }
    }
    return best ? best->sentence : known.otherwise;
  }
  if (verdict.reached != info::discover::Stage::finished && verdict.finding != Finding::numerical) {
    return "None yet: the search was stopped; run it to its end.";
  }
  switch (verdict.finding) {
    case Finding::unknown:
      return known.ifUnknown;
    case Finding::none:
      return "To detect smaller effects than the table lists, record longer and faster motions "
             "over more of the range.";
    case Finding::numerical:
      return "None yet: repeat the search with a shorter --step.";
    default:
      return known.ifNamed;
  }
}

}  // namespace app
