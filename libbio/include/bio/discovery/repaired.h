#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bio/analysis/driven_trial.h"
#include "bio/discovery/add_effects.h"
#include "bio/discovery/musculoskeletal_problem.h"
#include "info/discovery/discover.h"
#include "info/discovery/likelihood/fitted_numbers.h"

namespace bio::discover {

/// One trial of a search and the RMS errors of its simulations, in the unit of the output; of
/// several outputs as ExcessError has them. NaN if unavailable. `samples` are those compared by
/// `after`, else by `nominal`.
struct RepairedTrial : FittedTrial {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  double nominal = none;  ///< replay of the original model on the recorded trial
  double fitted = none;   ///< the fit's own simulation at the same values
  double floor = none;    ///< noise of the replayed trial
};

/// A model with all values fitted by a search, and its replays.
struct Repaired {
  Augmented added;
  std::vector<RepairedTrial> trials;
};

/// The effects of a verdict, with their probabilities unless none are given (Verdict::vetoed).
std::vector<EffectToAdd> effectsToAdd(const MusculoskeletalProblem& data,
                                      const info::discover::Verdict& verdict);

/// The model at Verdict::values: effects and all nuisance parameters, with the initial states of
/// the trials and the time step of the search (Model::fitted). Each trial is then replayed as by
/// `fisherhill replay`.
///
/// If the sensor is in error, the recording is corrected, q(t) = (y(t + clock) − bias)/(1 + gain),
/// and the errors are those of the coordinate itself; `floor` is the noise divided by 1 + gain.
/// @param heldOut  indices of the trials that were not fitted
/// @param step [s] for replays of the original model; empty: that of stepOf()
/// @throws what augmentedModel and drivenTable throw
Repaired repairedModel(const MusculoskeletalProblem& data, const info::discover::Verdict& verdict,
                       const std::vector<int>& heldOut, const std::optional<double>& step,
                       const EffectProvenance& provenance);

/// Only the trials, for a verdict without a model: without `after`.
std::vector<RepairedTrial> recordedTrials(const MusculoskeletalProblem& data,
                                          const info::discover::Verdict& verdict,
                                          const std::vector<int>& heldOut,
                                          const std::optional<double>& step);

/// Replaces the errors of the fit in a verdict's gap by those of the replays.
void takeReplays(info::discover::Verdict& verdict, const Repaired& repaired);

/// info::discover::fittedNumbers, with factors of single parameters given as these parameters, with
/// the names of ParameterCatalogue and in their units.
std::vector<info::discover::FittedNumber> fittedNumbers(const MusculoskeletalProblem& data,
                                                        const info::discover::Verdict& verdict);

}  // namespace bio::discover
