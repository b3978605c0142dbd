#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bio/discovery/contradiction.h"
#include "bio/discovery/effect_size.h"
#include "bio/discovery/musculoskeletal_problem.h"
#include "bio/discovery/predicted_experiments.h"
#include "bio/discovery/repaired.h"
#include "info/discovery/judgement/position_break.h"
#include "info/discovery/search/shorter_steps.h"

namespace bio::discover {

/// Question to a search for a missing effect.
struct DiscoveryRequest {
  const Model& model;
  SystemOptions system;
  CoordinateNames coordinates;  ///< those in question
  std::vector<Trial> trials;    ///< those held out last
  std::size_t numHeldOut = 0;   ///< < trials.size(); tested by only
  std::optional<double> step;   ///< [s]; empty: that of problem.simulation, halved if need be
  MusculoskeletalProblemOptions problem;
  info::discover::Options search;  ///< heldOut is set by discover()
  EffectProvenance provenance;     ///< for the credits of written models
};

/// Findings of a search, with everything that follows from them.
struct DiscoveryResult {
  std::unique_ptr<MusculoskeletalProblem> data;
  InputAgreement inputs;  ///< of the whole trials
  info::discover::SteppedVerdict found;

  /// Where the model fails at once, if the search of whole trials ended with an unknown effect.
  std::optional<info::discover::PositionBreak> positionBreak;
  /// The search was repeated with the trials up to where they first pass that position, and its
  /// verdict has a name: it is the one in `found`. Its trials are in `data`.
  bool trialsAreCut = false;

  /// The model with all fitted values, if the search has a model: with the effects found, with the
  /// formula of an unknown effect or the closest match (Verdict::surrogate), or, if nothing is
  /// missing, with refitted parameters only.
  std::optional<Repaired> repaired;
  bool addsEffect = false;              ///< `repaired` has an effect or a formula
  std::optional<Augmented> effectOnly;  ///< the effects found, all other values as in the request
  std::vector<RepairedTrial> trials;    ///< replays of all trials
  int shown = 0;                        ///< the trial of `sizes`: a held-out one if there is one
  std::vector<EffectSize> sizes;        ///< of Verdict::effects
  std::vector<info::discover::FittedNumber> fitted;
  std::vector<PredictedExperiment> experiments;  ///< that would distinguish the alternatives
};

/// Searches for effects that a model lacks, repairs the model and replays every trial with it.
///
/// A recording that contradicts itself (inputAgreement() with remedies) is not searched: only the
/// base model is fitted, the finding is `unknown`, and the sentence says what would make it agree.
/// If the excitations are unrelated to the motion, no effect has a probability, unless they are
/// related as the muscles receive them with the effects found (channels exchanged back).
///
/// The search is info::discover::searchTrials on a MusculoskeletalProblem. If it ends with an
/// unknown effect and the model fails at a position at once (positionBreak), it is repeated with
/// what of the trials comes before it; a name found there has no probability. repairedModel gives
/// the model, whose errors replace those of the fit in the verdict (takeReplays). A search that was
/// stopped has neither model nor experiments.
/// @throws what MusculoskeletalProblem, searchTrials and repairedModel throw
DiscoveryResult discover(const DiscoveryRequest& request);

}  // namespace bio::discover
