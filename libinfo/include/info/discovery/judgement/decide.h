#pragma once

#include <vector>

#include "info/discovery/discover.h"

namespace info::discover {

/// The evidence about all hypotheses from which the verdict is derived.
struct Judgement {
  std::vector<Finalist> raced;      ///< with the base model and all competitors of `chosen`
  std::vector<std::size_t> chosen;  ///< effects accepted by greedy selection, sorted; may be empty
  Adequacy before, after;           ///< of the base model, and with the chosen effects
  double latentBefore = 0, latentAfter = 0;  ///< σ_d
  double priorZ = 0;                         ///< largest one of the base model's parameters
  /// errors of held-out trials are larger than expected from the base model, or from the chosen
  /// effects
  bool strangeBefore = false, strangeAfter = false;
  bool heldOutWorse = false;       ///< held-out trials are evidence against the chosen effects
  bool replicated = false;         ///< but they show the same effects: Replication::replicated
  bool heldOutFarOff = false;      ///< their simulation errors are improbable: Options::farOff
  bool heldOutVague = false;       ///< they are hardly predicted: Options::vague
  bool nonparametricWins = false;  ///< NonparametricForce::wins
  /// Share of the base model's excess squared error that the chosen effects explain:
  /// ExcessError::closedFromCalibrated.
  std::optional<double> explained;
  /// That share for the held-out trials.
  std::optional<double> heldOutExplained;
};

struct Decision {
  Finding finding = Finding::none;
  std::vector<NamedEffect> effects;
  double probability = 0;
  bool vetoed = false, surrogate = false, reserved = false;
};

/// The rules, in this order. Adequate means: all tests passed, σ_d within the tolerated scatter of
/// the inputs, and held-out trials as expected.
/// - Nothing chosen, base adequate: `parameter` if one differs by more than `largestPriorZ` prior
///   standard deviations, else `none`.
/// - Nothing chosen, base inadequate: `unknown`.
/// - Chosen, but one of them, without equivalents, has a shape parameter at a bound, so that the
///   true force has another form; or the simulation with them explains less than `leastExplained`
///   of the excess error; or held-out trials are evidence against them and do not show the same
///   effects by themselves: `unknown`, the chosen effects are a proxy.
/// - Chosen, but the residuals are not white or follow a Cause, the latent force is too large, a
///   non-parametric force explains more, or held-out trials are not as expected: the same, unless
///   the residuals are not white or not as large as the noise, so that all these tests assume too
///   much, and the effects explain `carriesOver` of the excess error of the held-out trials. Then
///   they are named with a reservation.
/// - Chosen: each forms a class with its declared equivalents and with all alternatives whose log
///   evidence is at most `classWidth` lower. If every class has one member: `named`, or `parameter`
///   if all are errors of parameters; otherwise `ambiguous`. No probability is given with a
///   reservation, or if the innovations have the wrong size, the errors of held-out trials are
///   improbably large or would be hardly less for any other effect, or the effects were only
///   replicated there. The probability of an effect is its share of exp(log Z) among the
///   alternatives that were fitted in its place; declared equivalents at most `classWidth` behind
///   count as much as the leader.
Decision decide(const std::vector<Candidate>& candidates, const Judgement& judgement,
                const Options& options);

}  // namespace info::discover
