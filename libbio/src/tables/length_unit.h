#pragma once

#include <string_view>

namespace bio::tables {

/// Metres of one unit of length as motion capture systems write it; 0 if it is none.
double metresPer(std::string_view unit);

}  // namespace bio::tables
