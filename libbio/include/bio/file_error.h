#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace bio {

/// A longer file is no model, trial, recording or configuration and is not read.
inline constexpr std::uintmax_t mostTextBytes = std::uintmax_t{1} << 30;

/// A file that cannot be used. what() is one line: `file:line: element 'name': quantity = value,
/// rule` (or `file: …` when no line is to blame). Line breaks and other control characters that the
/// file's own words bring in become spaces.
class FileError : public std::runtime_error {
 public:
  explicit FileError(const std::string& message);
};

}  // namespace bio
