#pragma once

#include <nlohmann/json.hpp>

#include "command/command_context.h"
#include "info/estimation/monte_carlo.h"
#include "report/report.h"
#include "robots/robot_experiments.h"

/// Information, bounds and simulated trials in the report of the robot subcommand.
namespace app {

/// A matrix as a list of its rows.
nlohmann::ordered_json rowsOf(const Eigen::MatrixXd& matrix);
/// In increasing order.
Eigen::VectorXd eigenvaluesOf(const Eigen::MatrixXd& information);

/// Cramér–Rao bound of an experiment at the true parameters.
Eigen::MatrixXd boundOf(const info::PlannedExperiment& plan);

/// Simulated experiments with independent noise, each estimated from an initial guess drawn between
/// 0 and 2 times the true values, with a progress bar.
info::MonteCarloResult simulateTrials(const CommandContext& context,
                                      const info::PlannedExperiment& plan, int trials,
                                      const std::string& label);

/// Histogram of the estimates of one parameter about the true value, in standard deviations of the
/// bound.
Figure histogram(const std::string& name, const info::MonteCarloResult& result,
                 Eigen::Index parameter, double truth);

}  // namespace app
