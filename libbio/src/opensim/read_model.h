#pragma once

#include <tinyxml2.h>

#include <string>

#include "bio/model/model.h"

namespace bio::osim {

/// What a parsed document says; `file` is the name used in messages.
/// @throws FileError
Model readModel(const tinyxml2::XMLDocument& document, const std::string& file);

}  // namespace bio::osim
