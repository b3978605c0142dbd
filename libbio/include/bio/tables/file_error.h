#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace bio {

/// Longer files are refused: they are not models, trials, recordings or configurations.
inline constexpr std::uintmax_t mostTextBytes = std::uintmax_t{1} << 30;

/// A file that cannot be used. what() is one line: `file:line: element 'name': quantity = value,
/// rule` (or `file: …` if no line is concerned). Line breaks and other control characters from the
/// file become spaces.
class FileError : public std::runtime_error {
 public:
  explicit FileError(const std::string& message);
};

}  // namespace bio
