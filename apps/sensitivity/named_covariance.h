#pragma once

#include <filesystem>
#include <ostream>

#include "bio/analysis/parameter_laws.h"

namespace app {

using bio::NamedCovariance;

/// A covariance in the format that `calibrate` writes:
///     parameter,TRI.radius,hand.mass
///     TRI.radius,1e-08,2e-06
///     hand.mass,2e-06,0.0009
/// The first column is optional.
/// @throws std::invalid_argument naming file, line and column, for another kind of table, a cell
///   that is not a finite number, and what requireCovariance throws
NamedCovariance readCovariance(const std::filesystem::path& file);

void writeCovariance(const NamedCovariance& covariance, std::ostream& out);

}  // namespace app
