#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bio/tables/study_file.h"
#include "report/report.h"

namespace app {

/// An estimate of one subject, as parameters.csv of its calibration has it.
struct StudyEstimate {
  std::string subject, name, unit;
  double nominal = 0, estimate = 0;
  double sd = 0;  ///< NaN: no interval
};

/// A finished study.
struct StudyFindings {
  const bio::StudyFile& study;
  std::vector<std::vector<std::string>> rows;  ///< of study.csv
  std::vector<StudyEstimate> estimates;        ///< without initial states
  std::optional<Playback> playback = {};
};

/// Cell of a row by its column's name.
const std::string& cellOf(const std::vector<std::string>& row, const std::string& column);

/// Numbers of subjects by status, and by verdict if effects were looked for.
std::map<std::string, int> countsOf(const StudyFindings& findings, const std::string& column);

Report studyReport(const StudyFindings& findings);

}  // namespace app
