#pragma once

#include <optional>

#include "info/discovery/discover.h"

namespace info::discover {

/// A position of an axis beyond which the base model lacks a force at once, as where
/// something is met or an input's direction jumps (docs/decisions/068-position-breaks.md).
struct PositionBreak {
  std::size_t axis = 0;
  double position = 0;  ///< [unit of the axis]
  bool above = true;    ///< beyond it: larger positions; false: smaller ones
  double before = 0;    ///< mean of the latent force next to it on the near side [its force unit]
  double beyond = 0;    ///< on the far side
  double z = 0;         ///< their difference in standard errors
  double margin = 0;    ///< how uncertain the position is, roughly [unit of the axis]
};

/// Compares, axis by axis, the latent forces of the base model on both sides of every position that
/// the fitted trials visit, each side a tenth of their range wide.
/// @param verdict  of a search of these data: its σ_y, and the samples that it used
/// @return the position with the largest |z| over all axes, if that is at least 5 and no more than
///   40 % of the time is spent beyond; empty also if DiscoveryProblem::nudged is not available
/// @throws what Likelihood throws
std::optional<PositionBreak> positionBreak(const DiscoveryProblem& data, const Options& options,
                                           const Verdict& verdict);

}  // namespace info::discover
