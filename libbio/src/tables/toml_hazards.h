#pragma once

#include <string>
#include <string_view>

namespace bio {

/// Refuses what toml11 3.7 does not survive: it calls itself for every level until the stack is
/// full, reads beyond the end of a text of several lines that is not closed and of one that is not
/// UTF-8, lets binary numbers overflow, looks for the last table of a list that is empty, and takes
/// a time that grows with the square of the number of values: at most 10,000 are let through.
/// @throws FileError naming file and line
void refuseTomlHazards(std::string_view text, const std::string& file);

}  // namespace bio
