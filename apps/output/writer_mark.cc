#include "output/writer_mark.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

namespace app {
namespace fs = std::filesystem;
namespace {

/// ".unfinished-HOST-": machines share folders, but not always locks.
std::string marksHere() {
  std::array<char, 65> host = {};
  gethostname(host.data(), host.size() - 1);
  std::string name(host.data());
  std::replace(name.begin(), name.end(), '/', '_');
  return ".unfinished-" + name + "-";
}

bool isMarkOf(const std::string& name, const std::string& marks) {
  return name.size() > marks.size() && name.starts_with(marks) &&
         name.find_first_not_of("0123456789", marks.size()) == name.npos;
}

enum class Lock { got, held, impossible };

Lock lockOf(int file) {
  if (flock(file, LOCK_EX | LOCK_NB) == 0) return Lock::got;
  return errno == EWOULDBLOCK ? Lock::held : Lock::impossible;
}

/// Whether the open file is still what is at the path.
bool isAt(int file, const fs::path& path) {
  struct stat opened {
  }, there{};
  return fstat(file, &opened) == 0 && lstat(path.c_str(), &there) == 0 &&
         opened.st_ino == there.st_ino && opened.st_dev == there.st_dev;
}

constexpr int openFlags = O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;

bool isRegular(const fs::path& path) {
  std::error_code failed;
  return fs::symlink_status(path, failed).type() == fs::file_type::regular;
}

std::vector<fs::path> pathsIn(const fs::path& folder) {
  std::vector<fs::path> paths;
  std::error_code failed;
  for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed)) {
    paths.push_back(at->path());
  }
  return paths;
}

}  // namespace

WriterMark::WriterMark(fs::path folder)
    : path_(std::move(folder) / fmt::format("{}{}", marksHere(), getpid())) {
  using namespace std::chrono_literals;
  // A dead program may have had this number: whoever is clearing up after it is soon done.
  for (int attempt = 0; attempt < 200; ++attempt) {
    const int file = open(path_.c_str(), openFlags | O_CREAT, 0666);
    if (file < 0) return;  // writing the files is going to say why
    const Lock lock = lockOf(file);
    if (lock == Lock::got && isAt(file, path_)) {
      lock_ = file;
      return;
    }
    close(file);
    if (lock == Lock::impossible) {
      std::error_code ignored;
      fs::remove(path_, ignored);
      return;
    }
    std::this_thread::sleep_for(5ms);
  }
  throw std::runtime_error(
      fmt::format("{}: another program is writing under this name", path_.string()));
}

WriterMark::~WriterMark() {
  if (lock_ < 0) return;
  std::error_code ignored;
  fs::remove(path_, ignored);
  close(lock_);
}

bool WriterMark::hasOne(const fs::path& folder) {
  std::error_code ignored;
  return fs::exists(folder / fmt::format("{}{}", marksHere(), getpid()), ignored);
}

fs::path WriterMark::temporaryPath(const std::string& name) const {
  return path_.string() + "-" + name;
}

void removeLeftovers(const fs::path& folder) {
  const std::string marks = marksHere();
  const std::vector<fs::path> paths = pathsIn(folder);
  for (const fs::path& mark : paths) {
    if (!isMarkOf(mark.filename().string(), marks) || !isRegular(mark)) continue;
    const int file = open(mark.c_str(), openFlags);
    if (file < 0) continue;
    if (lockOf(file) == Lock::got && isAt(file, mark)) {
      // With the lock in our hand nobody can begin to write under this name.
      const std::string begin = mark.filename().string() + "-";
      std::error_code ignored;
      for (const fs::path& path : paths) {
        if (!path.filename().string().starts_with(begin)) continue;
        const bool isExchanged =
            path.filename().string().ends_with(WriterMark::exchanged) &&
            fs::symlink_status(path, ignored).type() == fs::file_type::directory;
        if (isExchanged) fs::remove_all(path, ignored);
        if (isRegular(path)) fs::remove(path, ignored);
      }
      fs::remove(mark, ignored);
    }
    close(file);
  }
}

}  // namespace app
