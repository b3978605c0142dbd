#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bio/discover/add_effects.h"
#include "bio/discover/elbow_disagreement.h"
#include "bio/table_file.h"
#include "info/discover/discover.h"
#include "info/discover/fitted_numbers.h"

namespace bio::discover {

/// One trial of a search, and how far simulations are from what was measured in it: root mean
/// squares in [rad] or [m], NaN where there is none.
struct RepairedTrial {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  int index = 0;                ///< of ElbowDisagreement
  bool isHeldOut = false;       ///< judged by only
  TrialStart start;             ///< of the coordinate, with the repaired model
  std::optional<Table> driven;  ///< what is to be replayed in the trial's place: excitations that
                                ///< drove the muscles, the sensor's errors taken off
  double nominal = none;        ///< replay of the model as it came, of the trial as it was recorded
  double after = none;          ///< replay of the repaired model, of `driven` where there is one
  double fitted = none;         ///< the fit's own simulation, at the same numbers
  double floor = none;          ///< noise of what is replayed
  Eigen::Index samples = 0;     ///< that `after` compares, else `nominal`
};

/// A model with all that a search has fitted, and what replays of it give.
struct Repaired {
  Augmented added;
  std::vector<RepairedTrial> trials;

  /// Root mean square of one figure over the samples of those trials that are held out, or of the
  /// others; NaN if one of them has none.
  double pooled(double RepairedTrial::*figure, bool heldOut) const;
};

/// The effects of a verdict, with their probabilities unless those were vetoed.
std::vector<EffectToAdd> effectsToAdd(const ElbowDisagreement& data,
                                      const info::discover::Verdict& verdict);

/// The model at Verdict::values: effects and every nuisance, with the trials' starts and the time
/// step of the search (Model::fitted). Each trial is then replayed as `fisherhill replay` would.
///
/// With a sensor's errors the recording is corrected, q(t) = (y(t + clock) − bias)/(1 + gain), and
/// the figures are in units of the coordinate itself; `floor` is the noise divided by 1 + gain.
/// @param heldOut  indices of the trials that were not fitted
/// @param step     [s] that replays of the model as it came are to take; nothing: as stepOf() has
/// it
/// @throws what augmentedModel and drivenTable throw
Repaired repairedModel(const ElbowDisagreement& data, const info::discover::Verdict& verdict,
                       const std::vector<int>& heldOut, const std::optional<double>& step,
                       const EffectProvenance& provenance);

/// The trials alone, of a verdict with which no model goes: without `after`.
std::vector<RepairedTrial> recordedTrials(const ElbowDisagreement& data,
                                          const info::discover::Verdict& verdict,
                                          const std::vector<int>& heldOut,
                                          const std::optional<double>& step);

/// The gap of a verdict with the figures of the replays in the places of the fit's.
void takeReplays(info::discover::Verdict& verdict, const Repaired& repaired);

/// info::discover::fittedNumbers, with factors of single parameters told as these parameters, by
/// the names of ParameterCatalogue and in their units.
std::vector<info::discover::FittedNumber> fittedNumbers(const ElbowDisagreement& data,
                                                        const info::discover::Verdict& verdict);

}  // namespace bio::discover
