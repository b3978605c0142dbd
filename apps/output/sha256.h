#pragma once

#include <filesystem>
#include <string>

namespace app {

/// SHA-256 of a file's bytes as 64 lower-case hexadecimal digits.
/// @throws std::runtime_error if the file cannot be read
std::string sha256OfFile(const std::filesystem::path& file);

}  // namespace app
