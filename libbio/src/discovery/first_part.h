#pragma once

#include <optional>

#include "bio/tables/trial.h"

// Not public.

namespace bio::discover {

/// The rows of a trial until a time [s], and what was measured until then. Prescribed motions stay
/// whole.
Trial partUntil(const Trial& trial, double end);

/// The rows of a trial before a coordinate is first measured beyond a position.
/// @param above beyond it: larger values
/// @return the trial itself if it stays on the near side; empty if less than a second is left
std::optional<Trial> firstPart(const Trial& trial, const std::string& coordinate, double position,
                               bool above);

}  // namespace bio::discover
