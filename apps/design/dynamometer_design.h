#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "bio/parameters/parameter_information.h"
#include "bio/tables/table_file.h"
#include "command/command.h"
#include "options/simulation_options.h"
#include "output/summary.h"
#include "report/report.h"

namespace app {

/// `design --dynamometer`, as typed.
struct DynamometerOptions {
  std::string coordinate;
  std::vector<std::string> angles;  ///< held at; the first and the last are turned between
  std::vector<std::string> speeds;  ///< of turns [.../s]
  std::vector<double> efforts = {30, 60, 100};  ///< [% MVC]
  int count = 4;
  double momentNoise = 0.5;  ///< [N·m] > 0, of a sample
};

/// Course of a contraction [s]: how long the muscles rest before, rise, and are held.
namespace contraction {
inline constexpr double rest = 0.5, ramp = 0.3, hold = 2, after = 0.4;
}

/// An experiment that a dynamometer can do: it holds or turns the joint, and the moment is
/// measured.
struct DynamometerExperiment {
  enum class Kind { isometric, isokinetic, passive } kind;
  double from = 0, to = 0;  ///< coordinate at begin and end [rad] or [m]
  double speed = 0;         ///< > 0, of the turn
  std::string group;        ///< muscles that contract; empty: none
  double effort = 0;        ///< their excitation, 0 to 1
  /// The trial without a moment: time, muscles, coordinate.
  bio::Table trial;
  Eigen::MatrixXd fisher;  ///< of the moment about the parameters; empty: it cannot be simulated
};

/// What one experiment after the other adds.
struct DynamometerPlan {
  std::vector<bio::ModelParameter> parameters;
  std::size_t candidates = 0, failed = 0;
  std::vector<DynamometerExperiment> chosen;
  std::vector<double> information;      ///< ½ log det ratio that each adds [nats]
  std::vector<Eigen::VectorXd> bounds;  ///< √diag (I + Λ)⁻¹ after each
};

/// "Hold at 60 deg; 2 s of rest, then …": to the person on the dynamometer.
std::string instructionOf(const DynamometerExperiment& experiment, bool turns);

void tellDynamometer(const DynamometerPlan& plan, bool turns, Summary& summary);
Report dynamometerReport(const DynamometerPlan& plan, const DynamometerOptions& options,
                         bool turns);

void addDynamometerOptions(CLI::App& options, DynamometerOptions& dynamometer);

/// Ranks all experiments of the lists by what the measured moment tells of the parameters, one
/// after the other, each once. Nuisance parameters are unknown as well; all have their default
/// priors.
/// @throws std::invalid_argument for an option out of its range
ExitStatus designOnDynamometer(const CommandContext& context, const std::string& modelFile,
                               const std::vector<std::string>& parameters,
                               const std::vector<std::string>& nuisance,
                               const DynamometerOptions& dynamometer, double rate,
                               const SimulationOptions& simulation);

}  // namespace app
