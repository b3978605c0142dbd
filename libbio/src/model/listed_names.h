#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace bio {

/// The names for one line of a message: "A, B, C and 12 more" where there are more than `most`.
inline std::string listedNames(const std::vector<std::string>& names, std::size_t most = 5) {
  if (names.size() <= most + 1) return fmt::format("{}", fmt::join(names, ", "));
  return fmt::format(
      "{} and {} more",
      fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(most), ", "),
      names.size() - most);
}

/// One note for all muscles that no free coordinate moves; none without such muscles.
inline std::vector<std::string> unmovedMuscles(const std::vector<std::string>& names) {
  if (names.empty()) return {};
  if (names.size() == 1) {
    return {fmt::format("muscle '{}' is left out: no free coordinate moves it", names.front())};
  }
  return {fmt::format("{} muscles are left out: no free coordinate moves them ({})", names.size(),
                      listedNames(names))};
}

}  // namespace bio
