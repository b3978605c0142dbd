#include "row_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <stdexcept>

#include "json_text.h"

namespace app {
namespace {

using Json = nlohmann::ordered_json;

std::runtime_error failure(const std::filesystem::path& path, const std::string& what) {
  return std::runtime_error(fmt::format("{}: {}", path.string(), what));
}

std::string allOf(int file, const std::filesystem::path& path) {
  struct stat about {};
  if (fstat(file, &about) != 0) throw failure(path, std::strerror(errno));
  std::string content(static_cast<std::size_t>(about.st_size), '\0');
  std::size_t have = 0;
  while (have < content.size()) {
    const ssize_t got =
        pread(file, content.data() + have, content.size() - have, static_cast<off_t>(have));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) throw failure(path, "cannot be read");
    have += static_cast<std::size_t>(got);
  }
  return content;
}

/// "seed is 1 there, 2 here".
std::string firstDifference(const Json& there, const Json& here) {
  for (const auto& [name, value] : here.items()) {
    const auto at = there.find(name);
    if (at != there.end() && *at == value) continue;
    if (at != there.end() && at->is_object() && value.is_object()) {
      return firstDifference(*at, value);
    }
    const std::string old = at != there.end() ? jsonText(*at) : "missing";
    const std::string now = jsonText(value);
    if (old.size() + now.size() > 120) return fmt::format("other {}", name);
    return fmt::format("{} is {} there, {} here", name, old, now);
  }
  return "other columns";
}

}  // namespace

std::vector<std::string> cellsOf(const std::string& row) {
  std::vector<std::string> cells(1);
  for (const char c : row) {
    if (c == ',') {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

RowFile::RowFile(std::filesystem::path path, const Json& settings,
                 const std::vector<std::string>& columns, bool replace)
    : path_(std::move(path)),
      cells_(columns.size() - 1),
      columns_(fmt::format("{}\n", fmt::join(columns, ","))) {
  if (path_.empty()) return;
  try {
    open(settings, replace);
  } catch (...) {
    if (file_ >= 0) close(file_);
    throw;
  }
}

RowFile::~RowFile() {
  if (file_ >= 0) close(file_);
}

void RowFile::open(const Json& given, bool replace) {
  const Json settings = Json::parse(jsonText(given));  // as it is going to be read
  file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file_ < 0) throw failure(path_, fmt::format("cannot be written ({})", std::strerror(errno)));
  if (flock(file_, LOCK_EX | LOCK_NB) != 0) {
    throw failure(path_, "another program is at work on it");
  }
  const std::string head = "# " + jsonText(settings) + "\n" + columns_;
  const std::string content = allOf(file_, path_);
  const std::size_t firstEnd = content.find('\n');
  const std::size_t headEnd =
      firstEnd == content.npos ? content.npos : content.find('\n', firstEnd + 1);
  // killed before the first row: what there is of the head is the beginning of ours
  if (content.size() < head.size() && head.starts_with(content)) return begin(head);
  Json there;
  if (content.starts_with("# {") && firstEnd != content.npos) {
    there = Json::parse(content.substr(2, firstEnd - 2), nullptr, false);
  }
  if (!there.is_object()) {
    throw failure(path_, "is not the unfinished result of an ensemble; it is left as it is");
  }
  if (there != settings || headEnd == content.npos ||
      content.substr(firstEnd + 1, headEnd - firstEnd) != columns_) {
    if (replace) return begin(head);
    throw failure(path_, fmt::format("is the unfinished result of other settings ({}); --force "
                                     "replaces it",
                                     firstDifference(there, settings)));
  }
  read(content, headEnd + 1);
}

void RowFile::begin(const std::string& head) {
  if (ftruncate(file_, 0) != 0) throw failure(path_, std::strerror(errno));
  write(head);
}

void RowFile::read(const std::string& content, std::size_t from) {
  long line = 2;
  while (from < content.size()) {
    const std::size_t end = content.find('\n', from);
    if (end == content.npos) break;  // cut off
    ++line;
    std::uint64_t number = 0;
    const char* const begin = content.data() + from;
    const char* const stop = content.data() + end;
    const auto [behind, error] = std::from_chars(begin, stop, number);
    if (error != std::errc() || behind == stop || *behind != ',' ||
        static_cast<std::size_t>(std::count(begin, stop, ',')) != cells_) {
      throw failure(path_, fmt::format("line {} is not a row of this table; --force does not mend "
                                       "it, take the file away",
                                       line));
    }
    rows_.emplace(number, std::string(behind + 1, stop));
    from = end + 1;
  }
  if (from < content.size() && ftruncate(file_, static_cast<off_t>(from)) != 0) {
    throw failure(path_, std::strerror(errno));
  }
  if (lseek(file_, 0, SEEK_END) < 0) throw failure(path_, std::strerror(errno));
}

void RowFile::append(std::uint64_t number, const std::string& text) {
  if (file_ >= 0) write(fmt::format("{},{}\n", number, text));
  rows_.emplace(number, text);
}

void RowFile::write(const std::string& text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t wrote = ::write(file_, text.data() + done, text.size() - done);
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote <= 0) {
      throw failure(path_, fmt::format("cannot be written ({})", std::strerror(errno)));
    }
    done += static_cast<std::size_t>(wrote);
  }
}

void RowFile::remove() {
  if (file_ < 0) return;
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
  close(file_);
  file_ = -1;
}

}  // namespace app
