#pragma once

#include <string>
#include <utility>

#include "bio/tables/file_error.h"

namespace bio {

/// Thrown for a column of a table that matches nothing in the model. Readers can ignore such
/// columns if they are asked to; the caller adds to the message how this is done.
class UnknownColumn : public FileError {
 public:
  UnknownColumn(const std::string& message, std::string column)
      : FileError(message), column_(std::move(column)) {}
  const std::string& column() const { return column_; }

 private:
  std::string column_;
};

}  // namespace bio
