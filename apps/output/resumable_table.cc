#include "output/resumable_table.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <thread>

#include "output/json_text.h"

namespace app {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t greatestNumber = std::uint64_t{1} << 32;
constexpr const char* checksumColumn = ",checksum\n";

std::runtime_error failure(const std::filesystem::path& path, const std::string& what) {
  return std::runtime_error(fmt::format("{}: {}", path.string(), what));
}

/// Changes with every byte that changes: FNV-1a, eight hexadecimal digits.
std::string checksumOf(std::string_view text) {
  std::uint32_t sum = 2166136261u;
  for (const char c : text) sum = (sum ^ static_cast<unsigned char>(c)) * 16777619u;
  return fmt::format("{:08x}", sum);
}
constexpr std::size_t checksumSize = 8;

/// The number of a line that is a row as it was written.
std::optional<std::uint64_t> numberOf(std::string_view line, std::size_t cells) {
  std::uint64_t number = 0;
  const auto [behind, error] = std::from_chars(line.data(), line.data() + line.size(), number);
  const bool isRow =
      error == std::errc() && behind != line.data() + line.size() && *behind == ',' &&
      number <= greatestNumber &&
      static_cast<std::size_t>(std::count(line.begin(), line.end(), ',')) == cells + 1 &&
      line.size() > checksumSize;
  if (!isRow) return std::nullopt;
  const std::size_t end = line.size() - checksumSize - 1;
  if (line[end] != ',' || checksumOf(line.substr(0, end)) != line.substr(end + 1)) {
    return std::nullopt;
  }
  return number;
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
      columns_(fmt::format("{}{}", fmt::join(columns, ","), checksumColumn)) {
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
  lock();
  const std::string head = "# " + jsonText(settings) + "\n" + columns_;
  std::ifstream stream(path_, std::ios::binary);
  std::string beginning(head.size(), '\0');
  stream.read(beginning.data(), static_cast<std::streamsize>(head.size()));
  beginning.resize(static_cast<std::size_t>(stream.gcount()));
  if (beginning == head) return read(head.size());
  // killed before the first row: what there is of the head is the beginning of ours
  if (head.starts_with(beginning)) return begin(head);
  stream.clear();
  stream.seekg(0);
  std::string first, second;
  std::getline(stream, first);
  std::getline(stream, second);
  const Json there =
      first.starts_with("# {") ? Json::parse(first.substr(2), nullptr, false) : Json();
  if (!there.is_object()) {
    throw failure(path_, "is not the unfinished result of an ensemble and is left unchanged");
  }
  if (replace) return begin(head);
  if (there == settings && second + checksumColumn == columns_) {
    throw failure(path_,
                  "is the unfinished result of an earlier version, whose rows have no checksum; "
                  "--force replaces it");
  }
  throw failure(path_, fmt::format("is the unfinished result of other settings ({}); --force "
                                   "replaces it",
                                   firstDifference(there, settings)));
}

void RowFile::lock() const {
  using namespace std::chrono_literals;
  // The lock of a killed program ends with it, which takes longer than to send the signal.
  for (int attempt = 0; attempt < 200; ++attempt) {
    if (flock(file_, LOCK_EX | LOCK_NB) == 0) return;
    if (errno != EWOULDBLOCK) throw failure(path_, std::strerror(errno));
    std::this_thread::sleep_for(5ms);
  }
  throw failure(path_, "is in use by another program");
}

void RowFile::begin(const std::string& head) {
  if (ftruncate(file_, 0) != 0 || lseek(file_, 0, SEEK_SET) < 0) {
    throw failure(path_, std::strerror(errno));
  }
  end_ = 0;
  write(head);
}

void RowFile::read(std::uint64_t from) {
  std::ifstream stream(path_, std::ios::binary);
  stream.seekg(static_cast<std::streamoff>(from));
  for (std::string line; std::getline(stream, line) && !stream.eof();) {  // else it was cut off
    const std::optional<std::uint64_t> number = numberOf(line, cells_);
    if (!number) {
      ++damaged_;
    } else if (!contains(*number)) {
      keep(*number, from);
    }
    from += line.size() + 1;
  }
  if (ftruncate(file_, static_cast<off_t>(from)) != 0 || lseek(file_, 0, SEEK_END) < 0) {
    throw failure(path_, std::strerror(errno));
  }
  end_ = from;
}

void RowFile::keep(std::uint64_t number, std::uint64_t place) {
  if (number >= places_.size()) places_.resize(number + 1);
  places_[number] = place;
  ++count_;
}

void RowFile::append(std::uint64_t number, const std::string& text) {
  if (contains(number)) return;
  if (file_ < 0) {
    kept_.push_back(text);
    return keep(number, kept_.size());
  }
  const std::uint64_t place = end_;
  const std::string row = fmt::format("{},{}", number, text);
  write(fmt::format("{},{}\n", row, checksumOf(row)));
  keep(number, place);
}

std::string RowFile::row(std::uint64_t number) const {
  if (!contains(number)) throw std::out_of_range(fmt::format("no row {}", number));
  const std::uint64_t place = places_[number];
  if (file_ < 0) return kept_.at(place - 1);
  std::string line;
  std::array<char, 4096> block;
  for (std::size_t end = line.npos; end == line.npos; end = line.find('\n')) {
    const ssize_t got =
        pread(file_, block.data(), block.size(), static_cast<off_t>(place + line.size()));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) throw failure(path_, "cannot be read");
    line.append(block.data(), static_cast<std::size_t>(got));
  }
  line.resize(line.find('\n') - checksumSize - 1);
  return line.substr(line.find(',') + 1);
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
  end_ += text.size();
}

void RowFile::remove() {
  if (file_ < 0) return;
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
  close(file_);
  file_ = -1;
}

}  // namespace app
