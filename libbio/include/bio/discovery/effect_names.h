#pragma once

#include <string>
#include <vector>

namespace bio::discover {

/// The id of an effect by its id or by its long name: "viscous_damping" is "visc",
/// "max_isometric_force_TRI" is "Fmax_TRI". What is neither comes back as it is.
std::string effectId(const std::string& name);

/// Ids of the effects of a list of names.
std::vector<std::string> effectIds(const std::vector<std::string>& names);

/// The long name of an effect: "viscous_damping" for "visc"; the id itself where that is in plain
/// words already.
std::string effectLongName(const std::string& id);

}  // namespace bio::discover
