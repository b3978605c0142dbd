#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace bio {

/// Edits from one word to another (Levenshtein), capitals aside.
std::size_t editDistance(const std::string& a, const std::string& b);

/// The name that was probably meant: the nearest one, the first of equals, if no more than a third
/// of the word was mistyped (two letters may be, of short words one); else "".
std::string nearestName(const std::string& word, const std::vector<std::string>& names);

/// ", did you mean 'BRA'?", or nothing.
std::string meantInstead(const std::string& word, const std::vector<std::string>& names);

}  // namespace bio
