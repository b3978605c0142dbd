#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace bio {

/// Edit distance between two words (Levenshtein), ignoring case.
std::size_t editDistance(const std::string& a, const std::string& b);

/// The name that was probably meant: the nearest one (the first of equals), if at most a third of
/// the word is mistyped (always allowing two letters, one in short words); else "".
std::string nearestName(const std::string& word, const std::vector<std::string>& names);

/// ", did you mean 'BRA'?", or "".
std::string meantInstead(const std::string& word, const std::vector<std::string>& names);

}  // namespace bio
