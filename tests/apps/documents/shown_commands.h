#pragma once

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "support/scratch_folder.h"

// Commands that a page shows.
namespace documents {

/// The lines of every ```sh block of a file.
inline std::vector<std::string> shellLines(const std::filesystem::path& file) {
  std::vector<std::string> lines;
  std::istringstream text(support::contentOf(file));
  bool inside = false;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with("```")) {
      inside = !inside && line == "```sh";
    } else if (inside && !line.empty()) {
      lines.push_back(line);
    }
  }
  return lines;
}

/// A command of a ```console block, and the lines shown below it.
struct ShownRun {
  std::string command;
  std::vector<std::string> output;
};

inline std::vector<ShownRun> consoleRuns(const std::filesystem::path& file) {
  std::vector<ShownRun> runs;
  std::istringstream text(support::contentOf(file));
  bool inside = false;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with("```")) {
      inside = !inside && line == "```console";
    } else if (inside && line.starts_with("$ ")) {
      runs.push_back({line.substr(2), {}});
    } else if (inside && line != "  …") {
      runs.back().output.push_back(line);
    }
  }
  return runs;
}

}  // namespace documents
