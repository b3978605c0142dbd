#include "follow_up.h"

#include <algorithm>

namespace app {

using info::discover::Finding;

const FollowUps& followUpsOfArms() {
  static const FollowUps known{
      {
          {{"delay", "clock"},
           "Repeat a trial with a torque from outside in pulses that are recorded with it "
           "(column elbow_flexion.torque): the arm answers a push at once, but muscles late; a "
           "shifted clock shifts both."},
          {{"tilt", "handforce", "const"},
           "Repeat a trial with a known mass, e.g. 1 kg, in the hand: gravity's moment grows "
           "with it, a force on the hand does not."},
          {{"payload", "mass", "const", "handforce"},
           "Let the forearm hang and swing passively, muscles at rest: weight and inertia act "
           "together, a force without inertia does not."},
          {{"gain_", "Fmax_", "lopt_", "lslack_", "crosstalk", "offset_"},
           "Record one isolated contraction of each muscle, and one against a load cell at a "
           "fixed angle."},
          {{"stiffness", "tilt", "limit", "wrap_", "gain", "bias", "Fmax_"},
           "Move the relaxed arm slowly through its whole range with a dynamometer (column "
           "elbow_flexion.torque): what is passive shows, muscles do not."},
          {{"missing_", "Fmax_", "gain_"},
           "Record the EMG of the muscle that is switched off in the model (a column with its "
           "name): it tells the muscle from its synergists."},
          {{"visc", "coulomb", "stribeck", "drag", "powerdamp"},
           "Repeat the trial at half and at twice the speed: dry friction does not care, viscous "
           "damping doubles, drag grows fourfold."},
      },
      "Repeat the trials at another speed and with a known mass in the hand; these data cannot "
      "tell the effects of the class apart.",
      "Record passive motion (muscles at rest, moved by hand or a dynamometer) over the region "
      "that the score map marks: it tells whether what is missing belongs to the joint or to the "
      "muscles.",
      "Repeat one trial that was not used here, and compare it with with_effect.osim."};
  return known;
}

std::string followUp(const info::discover::Disagreement& data,
                     const info::discover::Verdict& verdict, const FollowUps& known) {
  const auto& candidates = data.candidates();
  for (const auto& effect : verdict.effects) {
    if (effect.equals.size() < 2) continue;
    const Intervention* best = nullptr;
    long most = 1;
    for (const Intervention& one : known.interventions) {
      const long touched =
          std::count_if(effect.equals.begin(), effect.equals.end(), [&](std::size_t c) {
            return std::any_of(
                one.separates.begin(), one.separates.end(),
                [&](const std::string& id) { return candidates[c].id.starts_with(id); });
          });
      if (touched > most) {
        most = touched;
        best = &one;
      }
    }
    return best ? best->sentence : known.otherwise;
  }
  if (verdict.reached != info::discover::Stage::finished && verdict.finding != Finding::numerical) {
    return "None yet: run this to its end.";
  }
  switch (verdict.finding) {
    case Finding::unknown:
      return known.ifUnknown;
    case Finding::none:
      return "To see less than the table of detectable sizes says, record longer, faster and over "
             "more of the range.";
    case Finding::numerical:
      return "None yet: repeat this with a shorter --step.";
    default:
      return known.ifNamed;
  }
}

}  // namespace app
