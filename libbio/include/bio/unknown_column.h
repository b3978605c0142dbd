#pragma once

#include <string>
#include <utility>

#include "bio/file_error.h"

namespace bio {

/// A table's column that means nothing in the model it is read for. Readers that can pass over such
/// columns throw it where they are not told to; how they are told is the caller's to say.
class UnknownColumn : public FileError {
 public:
  UnknownColumn(const std::string& message, std::string column)
      : FileError(message), column_(std::move(column)) {}
  const std::string& column() const { return column_; }

 private:
  std::string column_;
};

}  // namespace bio
