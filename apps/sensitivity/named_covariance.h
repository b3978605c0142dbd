#pragma once

#include <Eigen/Dense>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

namespace app {

/// A covariance of named parameters, in the format that `calibrate` writes:
///     parameter,TRI.radius,hand.mass
///     TRI.radius,1e-08,2e-06
///     hand.mass,2e-06,0.0009
/// The first column is optional.
struct NamedCovariance {
  std::vector<std::string> names;
  Eigen::MatrixXd values;  ///< symmetric, > 0 on the diagonal [product of the two units]

  Eigen::MatrixXd correlation() const;
};

/// @throws std::invalid_argument naming file, line and column, for another kind of table, a cell
///   that is not a finite number, a variance that is not > 0, or an asymmetry of more than 1e-6 of
///   the product of the standard deviations
NamedCovariance readCovariance(const std::filesystem::path& file);

void writeCovariance(const NamedCovariance& covariance, std::ostream& out);

}  // namespace app
