#pragma once

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "support/run_program.h"
#include "support/scratch_folder.h"
#include "support/shipped_files.h"

/// Runs of `fisherhill ensemble` and what they leave.
namespace ensemble_runs {

using support::contentOf;
using support::linesOf;
using support::model;
using support::ProgramResult;
using support::ScratchFolder;
using support::slow;

using Words = std::vector<std::string>;

/// `ensemble` on the shipped elbow with what comes behind; `before` starts it, as mpirun does.
inline ProgramResult runEnsemble(const std::string& out, Words more, Words before = {}) {
  Words words = std::move(before);
  for (const std::string& word : Words{FISHERHILL_PROGRAM, "ensemble", model, slow, "--out", out}) {
    words.push_back(word);
  }
  words.insert(words.end(), more.begin(), more.end());
  return support::runProgram(words, FISHERHILL_SOURCE_DIR);
}

inline const Words four = {"--draws", "40",  "--parameters", "TRI.radius,hand.mass,BRA.*_length",
                           "--step",  "0.02"};

inline Words with(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

inline std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> parts;
  std::istringstream text(line);
  for (std::string part; std::getline(text, part, ',');) parts.push_back(part);
  return parts;
}

inline nlohmann::json summaryIn(const std::string& folder) {
  return nlohmann::json::parse(contentOf(folder + "/summary.json"));
}

/// The result files that say nothing of when and how they were made.
inline std::string resultsIn(const std::string& folder) {
  return contentOf(folder + "/draws.csv") + contentOf(folder + "/band.csv");
}

/// All results have their names, and the rows that the folder was made of are gone.
inline bool isDone(const std::string& folder) {
  return std::filesystem::exists(folder + "/summary.json") &&
         !std::filesystem::exists(folder + "/unfinished.csv");
}

/// Starts `ensemble` and ends it by a signal, later and later until it has finished rows.
inline ProgramResult endedAtWork(const std::string& out, const Words& work,
                                 const std::string& signal) {
  ProgramResult result;
  for (double limit = 0.2; limit < 60; limit *= 1.6) {
    // --foreground: one signal, not another one for the whole group, which would end it at once
    result =
        runEnsemble(out, work, {"timeout", "--foreground", "-s", signal, std::to_string(limit)});
    if (linesOf(contentOf(out + "/unfinished.csv")).size() > 4) break;
  }
  return result;
}

/// A folder of data sets "a", "b", …: half a second of a shipped trial each, shifted by rows.
inline void writeSets(const ScratchFolder& scratch, int count) {
  const auto lines = linesOf(contentOf(FISHERHILL_SOURCE_DIR "/emg_data/hidden_a/train_1.sto"));
  const auto header =
      static_cast<std::size_t>(std::find(lines.begin(), lines.end(), "endheader") - lines.begin());
  for (int set = 0; set < count; ++set) {
    std::string text = "cut\nversion=1\nnRows=51\nnColumns=10\ninDegrees=no\n";
    for (std::size_t i = header; i < header + 2; ++i) text += lines[i] + "\n";
    for (std::size_t i = 0; i < 51; ++i) {
      text += lines[header + 2 + i + 30 * static_cast<std::size_t>(set)] + "\n";
    }
    const std::string folder = std::string("sets/") + static_cast<char>('a' + set);
    std::filesystem::create_directories(scratch / folder);
    scratch.file(folder + "/train_1.sto", text);
  }
  std::filesystem::create_directories(scratch / "sets/of_no_use");
}

inline const Words quick = {"--noise-deg", "5", "--max-effects", "1"};

inline ProgramResult discoverSets(const ScratchFolder& scratch, const std::string& out,
                                  const Words& more, Words before = {}) {
  Words words = std::move(before);
  for (const std::string& word :
       {std::string(FISHERHILL_PROGRAM), std::string("ensemble"), model, std::string("--discover"),
        (scratch / "sets").string(), std::string("--out"), (scratch / out).string()}) {
    words.push_back(word);
  }
  return support::runProgram(with(with(words, quick), more), FISHERHILL_SOURCE_DIR);
}

}  // namespace ensemble_runs
