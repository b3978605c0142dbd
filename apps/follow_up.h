#pragma once

#include <string>

#include "info/discover/discover.h"

namespace app {

/// The experiment that would tell most after this verdict, in words: what separates the members of
/// a class, or what to record where nothing could be said. Chosen by what the effects are, not
/// simulated.
std::string followUp(const info::discover::Disagreement& data,
                     const info::discover::Verdict& verdict);

}  // namespace app
