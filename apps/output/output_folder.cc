#include "output/output_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "output/interruption.h"

namespace app {
namespace fs = std::filesystem;

OutputFolder::OutputFolder(const CommandContext& context, std::vector<std::string> resultNames)
    : force_(context.force), inputs_(context.inputs) {
  if (!context.out) return;
  if (context.out->empty()) throw std::runtime_error("--out: the folder's name is empty");
  folder_ = *context.out;
  if (fs::exists(fs::status(folder_)) && !fs::is_directory(folder_)) {
    throw std::runtime_error(fmt::format("--out {}: is not a folder", folder_.string()));
  }
  resultNames.insert(resultNames.end(), {"summary.json", "report.html"});
  for (const std::string& name : resultNames) mayBeWritten(name);

  // Remember which folders are made here, to take them away again if there is no result.
  std::vector<fs::path> missing;
  for (fs::path p = fs::absolute(folder_).lexically_normal(); !fs::exists(fs::status(p));
       p = p.parent_path()) {
    if (p.has_filename()) missing.push_back(p);
  }
  std::reverse(missing.begin(), missing.end());
  std::error_code error;
  for (const fs::path& p : missing) {
    fs::create_directory(p, error);
    if (error) break;
    foldersMade_.push_back(p);
  }
  if (!error && access(folder_.c_str(), W_OK | X_OK) != 0) {
    error.assign(errno, std::generic_category());
  }
  if (error) {
    for (auto p = foldersMade_.rbegin(); p != foldersMade_.rend(); ++p) fs::remove(*p);
    throw std::runtime_error(
        fmt::format("--out {}: cannot be written to ({})", folder_.string(), error.message()));
  }
  removeLeftovers(folder_);
}

OutputFolder::~OutputFolder() {
  if (!active()) return;
  std::error_code ignored;
  if (!unfinished_.empty()) fs::remove(mark_->temporaryPath(unfinished_), ignored);
  for (std::size_t i = committed_; i < finished_.size(); ++i) {
    const fs::path temporary = mark_->temporaryPath(finished_[i]);
    if (interruptionRequested()) {
      fs::rename(temporary, path(finished_[i]), ignored);
    } else {
      fs::remove(temporary, ignored);
    }
  }
  mark_.reset();
  // Only empty folders go: remove() refuses the others.
  for (auto p = foldersMade_.rbegin(); p != foldersMade_.rend(); ++p) fs::remove(*p, ignored);
}

fs::path OutputFolder::path(std::string_view name) const {
  return active() ? folder_ / name : fs::path();
}

void OutputFolder::mayBeWritten(const std::string& name) const {
  for (const fs::path& input : inputs_) {
    std::error_code ignored;
    if (!fs::equivalent(folder_ / name, input, ignored)) continue;
    throw std::invalid_argument(fmt::format(
        "{}: is an input and would be overwritten; choose another --out", input.string()));
  }
  if (force_ || !fs::exists(fs::symlink_status(folder_ / name))) return;
  throw std::runtime_error(
      fmt::format("--out {}: {} exists already; --force overwrites it", folder_.string(), name));
}

void OutputFolder::write(const std::string& name,
                         const std::function<void(std::ostream&)>& content) {
  writeFile(name, [&](const fs::path& temporary) {
    errno = 0;
    std::ofstream stream(temporary, std::ios::binary);
    if (stream) content(stream);
    stream.close();
    if (!stream) {
      throw std::runtime_error(
          fmt::format("{}: cannot be written ({})", path(name).string(), std::strerror(errno)));
    }
  });
}

void OutputFolder::writeFile(const std::string& name,
                             const std::function<void(const fs::path&)>& writer) {
  if (!active()) return;
  mayBeWritten(name);
  if (!mark_) mark_.emplace(folder_);
  unfinished_ = name;
  writer(mark_->temporaryPath(name));
  unfinished_.clear();
  finished_.push_back(name);
}

void OutputFolder::commit() {
  for (; committed_ < finished_.size(); ++committed_) {
    const std::string& name = finished_[committed_];
    fs::rename(mark_->temporaryPath(name), path(name));
  }
  mark_.reset();
}

}  // namespace app
