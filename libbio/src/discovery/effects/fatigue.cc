#include "discovery/effects/effects.h"

// Fatigue. Priors are judgements: a few tenths of the force, after seconds to a minute of full
// excitation.

namespace bio::discover {

void addFatigue(EncompassingModel& model) {
  if (model.system().numMuscles() == 0) return;
  const std::size_t share = model.add(
      amplitude("fatigue.share", "", 0, 0.9, 0.3),
      {Meaning::Kind::shift, {{model.number(EmgTarget{EmgTarget::What::fatigue, ""}, 0)}}});
  info::discover::Quantity time = shape("fatigue.time", "s", 3, 0.05, 100, 1.5);
  time.logarithmic = true;
  const std::size_t T = model.add(
      time,
      {Meaning::Kind::shift, {{model.number(EmgTarget{EmgTarget::What::fatigueTime, ""}, 0)}}});
  model.add(candidate(
      model, "fatigue", "muscle fatigue",
      "The longer a muscle has been active, the less force it produces for the same EMG.",
      info::discover::EffectKind::structure, {share, T}, {{0.1, 0.3}, {0.1, 3}, {0.1, 30}}));
}

}  // namespace bio::discover
