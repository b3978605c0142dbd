#pragma once

#include <vector>

#include "info/discovery/discover.h"

namespace info::discover {

/// What has been found out about all hypotheses before anything is said.
struct Judgement {
  std::vector<Finalist> raced;  ///< among them the base, and whatever `chosen` competes with
  std::vector<std::size_t>
      chosen;              ///< effects that greedy selection accepted, sorted; may be empty
  Adequacy before, after;  ///< of the base, and with the chosen effects
  double latentBefore = 0, latentAfter = 0;  ///< σ_d
  double surprise = 0;                       ///< largest one among the base's parameters
  /// held-out trials are further off than the base, or the chosen effects, lead to expect
  bool strangeBefore = false, strangeAfter = false;
  bool heldOutWorse = false;       ///< trials that were held out speak against the chosen effects
  bool heldOutFarOff = false;      ///< their simulation is: Options::farOff
  bool nonparametricWins = false;  ///< NonparametricForce::wins
};

struct Decision {
  Finding finding = Finding::none;
  std::vector<NamedEffect> effects;
  double probability = 0;
  bool vetoed = false, proxy = false;
};

/// The rules, in this order. Adequate means: all tests passed, σ_d within what inputs may scatter,
/// and held-out trials as expected.
/// - Nothing chosen, base adequate: `parameter` if one is off by more than `surprise`, else `none`.
/// - Nothing chosen, base inadequate: `unknown`.
/// - Chosen, but what is left is not white or has a cause, the latent force is too large, or what
///   was held out is strange or speaks against it: `unknown`, the chosen ones are a surrogate.
/// - Chosen, but one of them, in a class of its own, has a number that shapes it at a bound: the
///   same, it is another law.
/// - Chosen, but a force without a name explains more: the same.
/// - Chosen: each in a class with its declared equivalents and with all that are no further behind
///   than `classWidth` in its place. Every class of one: `named`, or `parameter` if that is all
///   they are; otherwise `ambiguous`. Innovations of the wrong size, and held-out trials that are
///   far off, veto the probability.
/// A name's probability is its share of exp(log Z) among what was raced in its place; declared
/// equivalents no further behind than `classWidth` count as much as the leader.
Decision decide(const std::vector<Candidate>& candidates, const Judgement& judgement,
                const Options& options);

}  // namespace info::discover
