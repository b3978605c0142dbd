#pragma once

#include <Eigen/Dense>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

namespace app {

/// A covariance of named numbers, in a file as `calibrate` writes it:
///     parameter,TRI.radius,hand.mass
///     TRI.radius,1e-08,2e-06
///     hand.mass,2e-06,0.0009
/// The first column may be missing.
struct NamedCovariance {
  std::vector<std::string> names;
  Eigen::MatrixXd values;  ///< symmetric, > 0 on the diagonal; in the product of the two units

  Eigen::MatrixXd correlation() const;
};

/// @throws std::invalid_argument naming file, line and column: not such a table, a cell that is no
///   finite number, a variance that is not > 0, or two cells that should be the same and differ by
///   more than 1e-6 of the deviations' product
NamedCovariance readCovariance(const std::filesystem::path& file);

void writeCovariance(const NamedCovariance& covariance, std::ostream& out);

}  // namespace app
