#include "index/found_results.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <set>

namespace app {
namespace {

namespace fs = std::filesystem;
using IndexedJson = nlohmann::ordered_json;

constexpr std::size_t mostNumbers = 500;  // of one result

void addNumbers(const std::string& name, const IndexedJson& value, FoundResult& result) {
  if (result.numbers.size() >= mostNumbers || value.is_array()) return;
  if (!value.is_object()) {
    result.numbers.emplace_back(name, value);
    return;
  }
  for (const auto& [key, part] : value.items()) addNumbers(name + "." + key, part, result);
}

std::string timeOf(const fs::path& file) {
  struct stat status {};
  if (stat(file.c_str(), &status) != 0) return "";
  return fmt::format("{:%Y-%m-%d %H:%M}", fmt::gmtime(status.st_mtime));
}

bool isModel(const std::string& path) {
  static const std::set<std::string> extensions = {".osim", ".urdf", ".mjcf", ".xml"};
  return extensions.contains(fs::path(path).extension().string());
}

/// @throws nlohmann::json::exception if it is no summary of this program
FoundResult resultOf(const fs::path& file) {
  std::ifstream stream(file);
  const IndexedJson json = IndexedJson::parse(stream);
  static const std::set<std::string> common = {
      "program", "version",  "subcommand", "command_line", "inputs",
      "seed",    "warnings", "files",      "files_sha256", "sentence"};
  FoundResult result;
  result.subcommand = json.at("subcommand").get<std::string>();
  result.version = json.at("version").get<std::string>();
  result.sentence = json.value("sentence", "");
  result.warnings = json.at("warnings").size();
  for (const IndexedJson& input : json.at("inputs")) {
    const auto path = input.at("path").get<std::string>();
    if (result.model.empty() && isModel(path)) {
      result.model = path;
    } else {
      result.trials.push_back(path);
    }
  }
  for (const auto& [key, value] : json.items())
    if (!common.contains(key)) addNumbers(key, value, result);
  result.date = timeOf(file);
  result.hasReport = fs::is_regular_file(file.parent_path() / "report.html");
  return result;
}

}  // namespace

FoundResults resultsBelow(const fs::path& folder) {
  std::vector<fs::path> files;
  const auto add = [&](const fs::path& place) {
    if (fs::is_regular_file(fs::symlink_status(place / "summary.json")))
      files.push_back(place / "summary.json");
  };
  add(folder);
  std::error_code ignored;
  fs::recursive_directory_iterator at(folder, fs::directory_options::skip_permission_denied);
  for (; at != fs::recursive_directory_iterator(); at.increment(ignored)) {
    if (!at->is_directory(ignored) || at->is_symlink(ignored)) continue;
    if (at->path().filename().string().starts_with('.')) {
      at.disable_recursion_pending();
    } else {
      add(at->path());
    }
  }
  std::sort(files.begin(), files.end());
  FoundResults found;
  for (const fs::path& file : files) {
    try {
      found.results.push_back(resultOf(file));
      found.results.back().folder = file.parent_path().lexically_relative(folder).string();
    } catch (const nlohmann::json::exception&) {
      found.unreadable.push_back(file.string() + ": is not a summary of fisherhill");
    }
  }
  return found;
}

}  // namespace app
