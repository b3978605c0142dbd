#include "output/output_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdio.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "output/interruption.h"
#include "output/sha256.h"

namespace app {
namespace fs = std::filesystem;
namespace {

/// The folder in which this one lies.
fs::path besides(const fs::path& folder) {
  std::error_code error;
  const fs::path whole = fs::canonical(folder, error);
  return error ? fs::path() : whole.parent_path();
}

/// What the folder of --figures holds is listed in this file of it.
constexpr const char* figureList = "figures.tex";

/// That file itself and the names in its lines "% file: NAME".
std::vector<std::string> filesListedIn(const fs::path& list) {
  std::vector<std::string> names = {figureList};
  std::ifstream stream(list);
  constexpr std::string_view begin = "% file: ";
  for (std::string line; std::getline(stream, line);) {
    const std::string name = line.substr(std::min(line.size(), begin.size()));
    const bool isPlain = !name.empty() && !name.starts_with('.') && name.find('/') == name.npos;
    if (line.starts_with(begin) && isPlain) names.push_back(name);
  }
  return names;
}

}  // namespace

OutputFolder::OutputFolder(const CommandContext& context, std::vector<std::string> resultNames)
    : force_(context.force), inputs_(context.inputs) {
  if (context.figures) figures_.reset(new OutputFolder(context, *context.figures, "--figures"));
  if (!context.out) return;
  resultNames.insert(resultNames.end(), {"summary.json", "report.html", "reproduce.sh"});
  open(*context.out, std::move(resultNames));
  std::error_code ignored;
  if (figures_ && fs::equivalent(folder_, figures_->folder_, ignored)) {
    for (auto p = foldersMade_.rbegin(); p != foldersMade_.rend(); ++p) fs::remove(*p, ignored);
    throw std::invalid_argument(fmt::format(
        "--figures {}: is the folder of --out, must be another one", figures_->folder_.string()));
  }
}

OutputFolder::OutputFolder(const CommandContext& context, const fs::path& folder,
                           std::string option)
    : option_(std::move(option)), force_(context.force), inputs_(context.inputs) {
  open(folder, filesListedIn(folder / figureList));
}

void OutputFolder::open(const fs::path& folder, std::vector<std::string> resultNames) {
  if (folder.empty()) throw std::runtime_error(option_ + ": the folder's name is empty");
  folder_ = folder;
  if (fs::exists(fs::status(folder_)) && !fs::is_directory(folder_)) {
    throw std::runtime_error(fmt::format("{} {}: is not a folder", option_, folder_.string()));
  }
  for (const std::string& name : resultNames) mayBeWritten(name);
  resultNames_ = resultNames;

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
    throw std::runtime_error(fmt::format("{} {}: cannot be written to ({})", option_,
                                         folder_.string(), error.message()));
  }
  removeLeftovers(folder_);
  removeLeftovers(besides(folder_));
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
        "{}: is an input and would be overwritten; choose another {}", input.string(), option_));
  }
  if (fs::is_directory(fs::symlink_status(folder_ / name))) {
    throw std::runtime_error(fmt::format("{} {}: {} is a folder, a file of this name is written",
                                         option_, folder_.string(), name));
  }
  if (force_ || !fs::exists(fs::symlink_status(folder_ / name))) return;
  throw std::runtime_error(fmt::format("{} {}: {} exists already; --force overwrites it", option_,
                                       folder_.string(), name));
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

void OutputFolder::makeExecutable(const std::string& name) {
  if (!active()) return;
  const fs::path file = mark_->temporaryPath(name);
  // by those who may read it
  const auto readers = static_cast<unsigned>(fs::status(file).permissions()) & 0444U;
  fs::permissions(file, static_cast<fs::perms>(readers >> 2U), fs::perm_options::add);
}

std::string OutputFolder::hashOf(const std::string& name) const {
  return active() ? sha256OfFile(mark_->temporaryPath(name)) : std::string();
}

bool OutputFolder::isReplaced(const std::string& name) const {
  const auto holds = [&](const std::vector<std::string>& names) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  return holds(finished_) || holds(resultNames_);
}

bool OutputFolder::exchange() {
  std::error_code error;
  const fs::path target = fs::canonical(folder_, error);
  if (error || !target.has_filename() || target == target.root_path()) return false;
  // whoever works in the folder, this program too, would be left in the old one
  const std::string here = (fs::current_path(error) / "").string();
  if (error || here.starts_with((target / "").string())) return false;
  if (WriterMark::hasOne(target.parent_path())) return false;  // e.g. of a study's subject
  const WriterMark mark(target.parent_path());
  const fs::path aside =
      mark.temporaryPath(target.filename().string() + std::string(WriterMark::exchanged));
  if (!fs::create_directory(aside, target, error)) return false;
  const auto giveUp = [&] {
    std::error_code ignored;
    for (const std::string& name : finished_)
      if (fs::exists(aside / name)) fs::rename(aside / name, mark_->temporaryPath(name), ignored);
    fs::remove_all(aside, ignored);
    return false;
  };
  const std::string own = mark_->temporaryPath("").filename().string();
  for (const auto& entry : fs::directory_iterator(target, error)) {
    const std::string name = entry.path().filename().string();
    if (isReplaced(name) || name + "-" == own || name.starts_with(own)) continue;
    fs::copy(entry.path(), aside / name,
             fs::copy_options::create_hard_links | fs::copy_options::recursive |
                 fs::copy_options::copy_symlinks,
             error);
    if (error) return giveUp();
  }
  if (error) return giveUp();
  for (const std::string& name : finished_) {
    fs::rename(mark_->temporaryPath(name), aside / name, error);
    if (error) return giveUp();
  }
  if (renameat2(AT_FDCWD, aside.c_str(), AT_FDCWD, target.c_str(), RENAME_EXCHANGE) != 0)
    return giveUp();
  committed_ = finished_.size();
  // what somebody put there meanwhile
  for (const auto& entry : fs::directory_iterator(aside, error)) {
    const std::string name = entry.path().filename().string();
    if (isReplaced(name) || name + "-" == own || fs::exists(target / name)) continue;
    std::error_code ignored;
    fs::rename(entry.path(), target / name, ignored);
  }
  fs::remove_all(aside, error);
  return true;
}

void OutputFolder::commit() {
  if (!active() || finished_.empty()) return;
  if (exchange()) {
    mark_.reset();
    return;
  }
  // the older result goes first: nobody finds a part of it beside a part of the new one
  std::error_code ignored;
  for (const std::string& name : resultNames_) fs::remove(folder_ / name, ignored);
  for (; committed_ < finished_.size(); ++committed_) {
    const std::string& name = finished_[committed_];
    fs::rename(mark_->temporaryPath(name), path(name));
  }
  mark_.reset();
}

}  // namespace app
