#include "bio/tables/file_error.h"

#include "tables/text_file.h"

namespace bio {

FileError::FileError(const std::string& message) : std::runtime_error(onOneLine(message)) {}

}  // namespace bio
