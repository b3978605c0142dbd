#pragma once

#include <stdexcept>

namespace bio {

/// A file that cannot be used. what() is one line: `file:line: element 'name': quantity = value,
/// rule` (or `file: …` when no line is to blame).
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace bio
