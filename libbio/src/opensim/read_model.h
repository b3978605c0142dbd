#pragma once

#include <tinyxml2.h>

#include <string>

#include "bio/model/model.h"

namespace bio::osim {

/// Whether a parsed document is an OpenSim model of version 2 or newer (Version ≥ 20000); to be asked
/// first, as nothing in an older one is where a reader looks for it.
/// @throws FileError if not; for a file of OpenSim 1, that it must be saved by a newer one
void checkVersion(const tinyxml2::XMLDocument& document, const std::string& file);

/// The model of a parsed document that passes checkVersion; `file` is the name used in messages.
/// @throws FileError
Model readModel(const tinyxml2::XMLDocument& document, const std::string& file);

}  // namespace bio::osim
