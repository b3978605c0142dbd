#pragma once

#include <cstdint>

// Numbers of the search for effects that no caller changes.

namespace info::discover {

// the score of what could not be simulated at all
inline constexpr double kFailed = -1e300;
inline constexpr double kWidest = 0.8, kFirstSize = 0.3, kRaceSize = 0.1, kSmallSize = 0.005;
inline constexpr double kSmallest = 1e-3;
// A large latent force leads to a minimum, and lets go of the parameters in it; others may be much
// lower (docs/decisions/046-multiple-starts.md). So many starts with a small one, and how far they
// are drawn [prior deviations].
inline constexpr std::uint64_t kStarts = 6, kStartsBesidesLed = 3;
inline constexpr double kSpread = 0.7;
// with so large a latent force none at all is out of the question, and its fit is not worth the
// time
inline constexpr double kHopeless = 0.03;

// nats by which a search at longer steps may be wrong about which of two hypotheses is better
inline constexpr double kDraftError = 3;

// A fit that is not done after so many iterations is given up if it is so many nats behind. A truth
// in a wrong minimum has stood 53 behind (visc, seed 20010 of validation/discovery).
inline constexpr int kIterations = 25, kShort = 8;
inline constexpr double kGivenUp = 60;

// Likelihood::marginal gains a few nats, and more where a hypothesis damps the model; what is
// further behind stays behind. The second: nats by which a fit must be better than the one before
// for that to be worth doing again.
inline constexpr double kMarginalGain = 10, kNews = 0.2;

}  // namespace info::discover
