#pragma once

#include <string>
#include <vector>

#include "bio/emg/emg.h"

namespace bio {

/// Sentences for the report: what was done, and what the result cannot tell.
std::vector<std::string> remarksOn(const Recording& recording, const EmgConfig& config,
                                   const EmgResult& result);

}  // namespace bio
