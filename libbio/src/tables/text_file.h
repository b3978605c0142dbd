#pragma once

#include <filesystem>
#include <string>

namespace bio {

/// All bytes of a file.
/// @throws FileError if it is missing, a directory, a device or a pipe, longer than mostTextBytes,
///   or cannot be read
std::string readTextFile(const std::filesystem::path& file);

/// Writes the text under a temporary name beside `file` and renames it, so that no half-written
/// file is ever seen.
/// @throws FileError if that fails
void writeTextFile(const std::filesystem::path& file, const std::string& text);

/// The text with a space for every control character, line breaks among them.
std::string onOneLine(std::string text);

}  // namespace bio
