#pragma once

#include <string>
#include <vector>

#include "bio/analysis/ensemble_statistics.h"
#include "bio/analysis/trial_ensemble.h"
#include "bio/model/units.h"

namespace app {

/// An observed channel as people see it.
struct ShownChannel {
  std::string name;
  bio::ShownUnit unit;  ///< degrees for angles, millimetres for coordinates that slide
};

/// Writes and reads the rows from which draws.csv and band.csv are made. A row has the outcome of a
/// run, the outputs of its channels, its parameters and the courses of the channels. A missing
/// number is an empty cell.
class DrawTable {
 public:
  explicit DrawTable(const bio::TrialEnsemble& ensemble);

  /// Names of the outputs, for --output.
  static std::vector<std::string> outputNames();

  /// Columns of the unfinished file; the first is the row's number.
  std::vector<std::string> columns() const;
  /// Number of them that draws.csv has: all but the course.
  std::size_t shortColumns() const { return columns().size() - channels_.size() * course_.size(); }
  /// A number of a channel, e.g. "final": "final_deg" where one coordinate is all that is observed,
  /// else "elbow_flexion.final [deg]".
  std::string columnOf(const ShownChannel& channel, const std::string& number) const;

  /// All cells but the number.
  std::string row(const bio::EnsembleRun& run, const Eigen::VectorXd& theta) const;

  /// A row as numbers; NaN for an empty cell.
  struct Row {
    std::string outcome;
    double failedAt = 0;
    std::vector<double> outputs = {};  ///< channel by channel in the order of ensembleOutputs()
    std::vector<double> parameters = {};
    std::vector<double> course = {};  ///< channel by channel
    std::string head = {};            ///< the cells for draws.csv
  };
  /// @throws std::runtime_error if a cell is not a number
  Row parse(std::uint64_t number, const std::string& text) const;

  const std::vector<ShownChannel>& channels() const { return channels_; }
  const std::vector<double>& course() const { return course_; }
  /// Whether the first channel is a coordinate, and whether it is the only one.
  bool startsWithCoordinate() const { return startsWithCoordinate_; }
  bool isOneCoordinate() const { return startsWithCoordinate_ && channels_.size() == 1; }

 private:
  std::vector<std::string> parameters_;  ///< "TRI.radius [m]"
  std::vector<double> course_;
  std::vector<ShownChannel> channels_;
  bool startsWithCoordinate_;
};

}  // namespace app
