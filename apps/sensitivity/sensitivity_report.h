#pragma once

#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "bio/analysis/sensitivity_study.h"
#include "output/methods.h"
#include "report/report.h"
#include "report/result.h"

namespace app {

/// The findings of `sensitivity`.
struct SensitivityFindings {
  std::string modelFile;
  std::vector<std::string> trialFiles;
  const bio::Coordinate& coordinate;  ///< the one observed
  const bio::Trial& trial;            ///< the first
  double noise;                       ///< [rad] or [m]; 1 where something else is observed
  Eigen::Index samples;               ///< of all trials
  const bio::Model* model = nullptr;
  std::vector<bio::Sweep> sweeps = {};
  std::vector<std::string> parameters = {};  ///< of the local analysis, in the order of its columns
  std::optional<bio::ParameterInformation> information = {};
  std::optional<bio::SensitivityTrajectory> local = {};  ///< of the first trial
  double costRatio = 0;
  /// Observed channels, in words; empty: the coordinate is observed. Sensitivities to channels are
  /// in standard deviations of the noise.
  std::string observed = {};
  /// Gains of other channels, the largest first; empty: not computed.
  std::vector<bio::ChannelGain> gains = {};
  std::optional<bio::ProfileFinding> profile = {};
  bio::GlobalFinding global = {};

  /// Unit in which the sensitivities to the observation are shown, and its factor.
  double shownFactor() const;
  std::string shownUnit() const;
};

/// Degrees for a rotation, millimetres for a translation.
double shownFactor(const bio::Coordinate& coordinate);
std::string shownUnit(const bio::Coordinate& coordinate);

/// Indices by falling score.
std::vector<std::size_t> ranking(const Eigen::VectorXd& score);

/// sensitivity.csv, most influential first; an empty cell means no information.
void writeSensitivities(const SensitivityFindings& findings, std::ostream& out);
/// fisher.csv: the matrix with its names.
void writeFisher(const SensitivityFindings& findings, std::ostream& out);
/// sweep.csv: time, the model's motion, and that of each value.
void writeSweep(const bio::Sweep& sweep, const bio::Coordinate& coordinate, std::ostream& out);
/// profile.csv and global.csv
void writeProfile(const bio::ProfileFinding& finding, std::ostream& out);
void writeGlobal(const SensitivityFindings& findings, std::ostream& out);

/// How the numbers were made.
void sayMethods(const SensitivityFindings& findings, Methods& methods);

/// All of these that there is something for.
void writeTables(const SensitivityFindings& findings, OutputFolder& folder);

/// Sets the values of summary.json: parameters, cost_ratio, …
void tellSensitivity(const SensitivityFindings& findings, Summary& summary);
Report sensitivityReport(const SensitivityFindings& findings);

}  // namespace app
