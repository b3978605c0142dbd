#pragma once

#include <string>

#include "bio/discovery/encompassing_model.h"

namespace bio::discover {

/// The body that takes a mass or a force, in words: "the hand" if that is what moves last, else the
/// name of the last moving body, e.g. "calcn_r"; "the limb" if no body with a mass moves.
std::string endOfLimb(const EncompassingModel& model);

/// Where a mass is, in words: "in the hand", else "on calcn_r".
std::string placeOfMass(const EncompassingModel& model);

}  // namespace bio::discover
