#pragma once

#include <nlohmann/json.hpp>

#include "command_context.h"
#include "info/monte_carlo.h"
#include "info/systems/robot_experiments.h"
#include "report.h"

/// What the robot subcommand shows of information, bounds and simulated trials.
namespace app {

/// A matrix as a list of its rows.
nlohmann::ordered_json rowsOf(const Eigen::MatrixXd& matrix);
/// In increasing order.
Eigen::VectorXd eigenvaluesOf(const Eigen::MatrixXd& information);

/// Cramér–Rao bound of an experiment at its truth.
Eigen::MatrixXd boundOf(const info::PlannedExperiment& plan);

/// Simulated experiments with fresh noise, each estimated from a start drawn within 0 to 2 times
/// the truth, with a bar on the terminal.
info::MonteCarloResult simulateTrials(const CommandContext& context,
                                      const info::PlannedExperiment& plan, int trials,
                                      const std::string& label);

/// Estimates of one parameter, counted in bins about the truth, in standard deviations of the
/// bound.
Figure histogram(const std::string& name, const info::MonteCarloResult& result,
                 Eigen::Index parameter, double truth);

}  // namespace app
