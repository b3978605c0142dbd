#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace app {

/// One folder with a summary.json.
struct FoundResult {
  std::string folder;  ///< seen from the folder that was searched; "." for itself
  std::string subcommand;
  std::string model;                ///< as it was typed; empty: none
  std::vector<std::string> trials;  ///< the other inputs
  std::string sentence;             ///< the answer; empty in results of older versions
  std::size_t warnings = 0;
  std::string date;        ///< when summary.json was written, UTC: "2026-05-01 13:37"
  std::string version;     ///< of the program
  bool hasReport = false;  ///< report.html is there
  /// Numbers and texts by name, "rms_error.elbow_flexion.value"; no lists.
  std::vector<std::pair<std::string, nlohmann::ordered_json>> numbers = {};
};

struct FoundResults {
  std::vector<FoundResult> results;     ///< by folder
  std::vector<std::string> unreadable;  ///< why a summary.json is not listed, one sentence each
};

/// Every result in a folder and below it. Hidden folders and symbolic links are passed over.
FoundResults resultsBelow(const std::filesystem::path& folder);

}  // namespace app
