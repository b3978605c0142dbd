#pragma once

#include <optional>
#include <string>
#include <vector>

namespace bio {

/// A recording of EMG from which a trial is made.
struct StudyRecording {
  std::string file, config;  ///< paths as they can be opened
  bool isHeldOut = false;
};

struct StudySubject {
  std::string name;                         ///< letters, digits, '.', '_' and '-'; once in a study
  std::string model;                        ///< path as it can be opened
  std::vector<std::string> train, heldOut;  ///< trials, likewise
  std::vector<StudyRecording> recordings;
  std::vector<std::string> sets;  ///< numbers of its model, NAME=VALUE
};

/// Subjects with their models and trials, and what is to be estimated from them;
/// docs/study.md lists every key.
struct StudyFile {
  std::string file, title;
  std::vector<std::string> parameters;  ///< to estimate; empty: nothing is calibrated
  bool ownStart = false, priors = true;
  std::optional<double> noise_deg;
  int starts = 1;
  bool discover = false;
  int maxEffects = 3;
  std::vector<std::string> without;  ///< effects left out of the catalogue
  std::vector<std::string> coordinates, locks;
  std::vector<std::string> sets;  ///< numbers of every model, NAME=VALUE
  std::optional<double> step_s;
  std::vector<StudySubject> subjects;
};

/// Paths in the file are relative to its folder.
/// @throws FileError "file:line: key = value, rule" for TOML that cannot be parsed, an unknown key,
///   a value of the wrong type or out of its range, a missing key, a file that is not there, a name
///   given twice, a subject without trials; nothing to do
StudyFile readStudy(const std::string& file);

}  // namespace bio
