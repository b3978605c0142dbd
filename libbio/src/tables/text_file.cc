#include "tables/text_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cctype>
#include <cmath>
#include <fstream>

#include "bio/tables/file_error.h"

namespace bio {

std::string readTextFile(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) {
    throw FileError(fmt::format("{}: there is no such file", file.string()));
  }
  if (std::filesystem::is_directory(file, error)) {
    throw FileError(fmt::format("{}: is a directory, must be a file", file.string()));
  }
  // Some devices and pipes never end, others never begin.
  const bool isPipe =
      std::filesystem::is_fifo(file, error) || std::filesystem::is_socket(file, error);
  if (isPipe || !std::filesystem::is_regular_file(file, error)) {
    throw FileError(
        fmt::format("{}: is a {}, must be a file", file.string(), isPipe ? "pipe" : "device"));
  }
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (!error && size > mostTextBytes) {
    throw FileError(fmt::format("{}: has {:.3g} GiB, must be at most 1 GiB", file.string(),
                                std::ldexp(static_cast<double>(size), -30)));
  }
  std::ifstream stream(file, std::ios::binary);
  std::string text(error ? 0 : size, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  // some files do not tell their size
  for (char c = 0; stream.get(c);) text.push_back(c);
  if (stream.bad() || !stream.eof()) {
    throw FileError(fmt::format("{}: cannot be read", file.string()));
  }
  return text;
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
