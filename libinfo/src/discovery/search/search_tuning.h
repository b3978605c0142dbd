#pragma once

#include <cstddef>
#include <cstdint>

// Constants of the search for effects.

namespace info::discover {

// score of a hypothesis that cannot be simulated
inline constexpr double kFailed = -1e300;
inline constexpr double kWidest = 0.8, kFirstSize = 0.3, kRaceSize = 0.1, kSmallSize = 0.005;
inline constexpr double kSmallest = 1e-3;
// Homotopy from a large latent force leads to one minimum; others may be much lower
// (docs/decisions/046-multiple-starts.md). Number of additional starts with a small latent force,
// and their spread [prior standard deviations].
inline constexpr std::uint64_t kStarts = 6, kStartsBesidesLed = 3;
inline constexpr double kSpread = 0.7;
// with so large a latent force the hypothesis without one is excluded and not fitted
inline constexpr double kHopeless = 0.03;

// error [nats] of differences of evidence at a longer time step
inline constexpr double kDraftError = 3;

// A fit that has not converged after this many iterations is abandoned if it is this many nats
// behind. The margin is large because the true hypothesis may be far behind while it is in a wrong
// minimum.
inline constexpr int kIterations = 25, kShort = 8;
inline constexpr double kGivenUp = 60;

// Of nudgeStages: strong enough for stability, weak enough for missing effects to show.
inline constexpr std::size_t kHeldStage = 2;

// Likelihood::marginal gains a few nats, and more for hypotheses that damp the model; hypotheses
// further behind are skipped. The second: gain [nats] of a fit from which the step is repeated.
inline constexpr double kMarginalGain = 10, kNews = 0.2;

}  // namespace info::discover
