#include "calibrate/calibrate_playback.h"

#include "bio/analysis/driven_trial.h"
#include "playback/replayed_trials.h"

namespace app {

std::optional<Playback> calibratePlayback(const CalibrateFindings& f) {
  if (f.calibrated == nullptr) return {};
  const bio::TrialSetOptions& options = f.options.trials;
  ReplayedTrials replayed(f.training.options(), options.simulation);
  const double step = options.simulation.step;
  for (const bool heldOut : {true, false}) {
    for (const bio::CalibratedTrial& one : f.calibrated->trials) {
      if (one.isHeldOut != heldOut) continue;
      const bio::TrialSet& set = heldOut ? *f.heldOut : f.training;
      const bio::Trial& recorded = set.trials()[one.index];
      replayed.beginTrial(recorded.file + (heldOut ? " (held out)" : ""), recorded);
      const bio::Model& model = f.calibrated->model;
      replayed.add("calibrated", model,
                   one.driven ? bio::drivenTrial(*one.driven, recorded, model) : recorded,
                   {.step = step, .starts = one.starts});
      replayed.add("before", f.model, recorded, {.step = step, .given = options.initial});
    }
  }
  return replayed.playback("The motion in three dimensions");
}

}  // namespace app
