#include "text_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cctype>
#include <fstream>
#include <sstream>

#include "bio/file_error.h"

namespace bio {

std::string readTextFile(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) {
    throw FileError(fmt::format("{}: there is no such file", file.string()));
  }
  if (std::filesystem::is_directory(file, error)) {
    throw FileError(fmt::format("{}: is a directory, must be a file", file.string()));
  }
  // Some devices never end.
  if (std::filesystem::is_character_file(file, error) ||
      std::filesystem::is_block_file(file, error)) {
    throw FileError(fmt::format("{}: is a device, must be a file", file.string()));
  }
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream) throw FileError(fmt::format("{}: cannot be read", file.string()));
  return std::move(text).str();
}

void writeTextFile(const std::filesystem::path& file, const std::string& text) {
  const std::filesystem::path temporary =
      file.string() + fmt::format(".{}.part", static_cast<long>(::getpid()));
  std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
  stream << text;
  stream.close();
  std::error_code error;
  if (stream) std::filesystem::rename(temporary, file, error);
  if (!stream || error) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw FileError(fmt::format("{}: cannot be written", file.string()));
  }
}

std::string onOneLine(std::string text) {
  for (char& c : text) {
    if (std::iscntrl(static_cast<unsigned char>(c))) c = ' ';
  }
  return text;
}

}  // namespace bio
