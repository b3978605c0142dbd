#pragma once

#include <nlohmann/json.hpp>

#include "info/estimation/monte_carlo.h"
#include "report/report.h"

/// Matrices and simulated trials in the report of the robot subcommand.
namespace app {

/// A matrix as a list of its rows.
nlohmann::ordered_json rowsOf(const Eigen::MatrixXd& matrix);

/// The heading of histograms of estimates.
void sayHistograms(Report& report);

/// Histogram of the estimates of one parameter about the true value, in standard deviations of the
/// bound.
Figure histogram(const std::string& name, const info::MonteCarloResult& result,
                 Eigen::Index parameter, double truth);

}  // namespace app
