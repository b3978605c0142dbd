#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bio/discovery/add_effects.h"
#include "bio/discovery/musculoskeletal_problem.h"
#include "bio/tables/table_file.h"
#include "info/discovery/discover.h"
#include "info/discovery/likelihood/fitted_numbers.h"

namespace bio::discover {

/// One trial of a search and the RMS errors of its simulations, in the unit of the output; of
/// several outputs as ExcessError has them. NaN if unavailable.
struct RepairedTrial {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  int index = 0;                   ///< of MusculoskeletalProblem
  bool isHeldOut = false;          ///< judged by only
  std::vector<TrialStart> starts;  ///< initial states of the coordinates, for the repaired model
  std::optional<Table> driven;     ///< trial to replay instead: the excitations that
                                   ///< drove the muscles, sensor errors removed
  double nominal = none;           ///< replay of the original model on the recorded trial
  double after = none;             ///< replay of the repaired model, on `driven` if there is one
  double fitted = none;            ///< the fit's own simulation at the same values
  double floor = none;             ///< noise of the replayed trial
  Eigen::Index samples = 0;        ///< number of samples compared by `after`, else by `nominal`
};

/// A model with all values fitted by a search, and its replays.
struct Repaired {
  Augmented added;
  std::vector<RepairedTrial> trials;

  /// RMS of one of these errors over the samples of the held-out or of the other trials; NaN if one
  /// of them has none.
  double pooled(double RepairedTrial::*figure, bool heldOut) const;
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
