#pragma once

#include <string>
#include <vector>

#include "bio/analysis/ensemble_statistics.h"
#include "bio/analysis/parameter_laws.h"

namespace app {

/// Writes and reads the rows from which draws.csv and band.csv are made. A row has the outcome of a
/// run, its outputs, its parameters and the course of the coordinate, in degrees or millimetres. A
/// missing number is an empty cell.
class DrawTable {
 public:
  /// @param shown factor from the coordinate's unit to degrees or millimetres
  /// @param shownUnit  "deg" or "mm"
  DrawTable(const std::vector<bio::DrawnParameter>& parameters, const std::vector<double>& course,
            double shown, const std::string& shownUnit);

  /// Names of the outputs, for --output.
  static std::vector<std::string> outputNames();

  /// Columns of the unfinished file; the first is the row's number.
  std::vector<std::string> columns() const;
  /// Number of them that draws.csv has: all but the course.
  std::size_t shortColumns() const { return columns().size() - course_.size(); }
  std::string columnOf(const bio::EnsembleOutput& output) const {
    return output.name + "_" + unit_;
  }

  /// All cells but the number.
  std::string row(const bio::EnsembleRun& run, const Eigen::VectorXd& theta) const;

  /// A row as numbers; NaN for an empty cell.
  struct Row {
    std::string outcome;
    double failedAt = 0;
    std::vector<double> outputs = {};  ///< in the order of bio::ensembleOutputs()
    std::vector<double> parameters = {};
    std::vector<double> course = {};
    std::string head = {};  ///< the cells for draws.csv
  };
  /// @throws std::runtime_error if a cell is not a number
  Row parse(std::uint64_t number, const std::string& text) const;

  double shown() const { return shown_; }
  const std::string& unit() const { return unit_; }
  const std::vector<double>& course() const { return course_; }

 private:
  std::vector<std::string> parameters_;  ///< "TRI.radius [m]"
  std::vector<double> course_;
  double shown_;
  std::string unit_;
};

}  // namespace app
