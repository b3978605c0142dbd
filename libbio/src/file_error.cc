#include "bio/file_error.h"

#include "text_file.h"

namespace bio {

FileError::FileError(const std::string& message) : std::runtime_error(onOneLine(message)) {}

}  // namespace bio
