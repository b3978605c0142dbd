#pragma once

#include <optional>
#include <string>
#include <vector>

#include "score/outcome.h"

namespace hidden {

/// Recovery against detectability: sets with one hidden effect, by its amplitude over the least one
/// that these trials would have shown (Outcome::visibility).
struct RecoveryBin {
  double from = 0, to = 0;  ///< of that ratio; the last one is infinite
  int right = 0, n = 0;     ///< right name first, alone or of its class
};
/// Sets of the suite "out" and verdicts that tell nothing of the effect are left out.
std::vector<RecoveryBin> recoveryByDetectability(const std::vector<Outcome>& outcomes);

/// How far estimates are from the truth in units of the deviation they are given with, which is the
/// Cramér–Rao bound with the priors: √(mean z²). Nothing without estimates.
std::optional<double> recoveryError(const std::vector<Outcome>& outcomes);

/// Both as Markdown.
std::string recoveryTable(const std::vector<Outcome>& outcomes);

}  // namespace hidden
