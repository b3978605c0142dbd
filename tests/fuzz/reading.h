#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <typeinfo>

#include "bio/tables/file_error.h"

/// What the fuzz targets share: bytes become a file, and a reader has two ways to end.
namespace fuzz {

/// A file in memory that is overwritten for every input; gone when the program ends.
class InputFile {
 public:
  explicit InputFile(const std::string& name)
      : folder_("/dev/shm/fisherhill-fuzz-" + std::to_string(::getpid())) {
    std::filesystem::create_directories(folder_);
    path_ = folder_ / name;
    descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT, 0600);
    if (descriptor_ < 0) std::abort();
  }
  ~InputFile() {
    ::close(descriptor_);
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::filesystem::path& holding(std::string_view text) {
    const auto size = static_cast<ssize_t>(text.size());
    if (::ftruncate(descriptor_, 0) != 0) std::abort();
    if (::pwrite(descriptor_, text.data(), text.size(), 0) != size) std::abort();
    return path_;
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path folder_, path_;
  int descriptor_ = -1;
};

[[noreturn]] inline void finding(const char* kind, const char* what) {
  std::fprintf(stderr, "finding: %s: %s\n", kind, what);
  std::abort();
}

/// True if the reader is content; false if it refuses with one line of the documented kind.
/// Everything else ends the program: another exception, a message of several lines or none.
template <class Refusal, class Read>
bool readsOrRefuses(Read read) {
  try {
    read();
    return true;
  } catch (const Refusal& refusal) {
    const std::string_view what = refusal.what();
    if (what.empty()) finding("empty message", "");
    if (what.find_first_of("\r\n") != what.npos) finding("message of several lines", what.data());
    return false;
  } catch (const std::exception& other) {
    finding(typeid(other).name(), other.what());
  }
}

/// The text that libFuzzer hands over.
inline std::string_view textOf(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace fuzz
