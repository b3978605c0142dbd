#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "options/quantity.h"

namespace app {

/// The options that every subcommand with a simulation has, as they were typed; names are checked
/// against the model later.
struct SimulationOptions {
  std::string integrator = "vi";         ///< vi, vi-left, vi-adaptive, rk4 or cvode
  std::optional<double> step;            ///< Δt [s] > 0; see stepOrDefault
  std::vector<std::string> coordinates;  ///< the free ones; empty: chooseCoordinates() chooses
  bool areChosen = false;                ///< `coordinates` were chosen, not typed
  std::vector<std::string> prescribed;   ///< coordinates whose motion is that of the trial
  bool takesPrescribed = false;          ///< the command has these options
  /// Coordinates that move on the model's own functions of time; chooseCoordinates() fills them in.
  std::vector<std::string> prescribedByModel;
  std::optional<double> prescribeCutoff;  ///< smooths that motion [Hz] > 0
  /// Locked coordinates whose reaction is wanted, with their values [rad] or [m];
  /// chooseCoordinates() fills them in.
  std::map<std::string, double> held;
  std::vector<Assignment> locks;    ///< values of locked coordinates that differ from the defaults
  std::vector<Assignment> initial;  ///< start values of free coordinates
  std::vector<Assignment> set;      ///< other values of parameters, as set_parameters.h takes them
  std::vector<std::string> wrapAsCylinder;  ///< ellipsoids to treat as cylinders
  bool ignoreExtra = false;                 ///< ignore unknown columns of a trial

  /// Δt [s]: as given, else the integrator's own.
  double stepOrDefault() const;
  /// Whether the integrator is a variational one, which alone have sensitivities.
  bool isVariational() const;
};

void addSimulationOptions(CLI::App& subcommand, SimulationOptions& options);

/// Adds --prescribe and --prescribe-cutoff, for commands that take the motion of coordinates from a
/// trial.
void addPrescribing(CLI::App& subcommand, SimulationOptions& options);

/// Adds an option that takes NAME=VALUE and may be repeated.
CLI::Option* addAssignments(CLI::App& subcommand, const std::string& name,
                            std::vector<Assignment>& target, const std::string& description);

/// The options that say what is simulated, as words of another command: " --coordinate knee …".
/// Starts and values of parameters (setWords) are not among them.
/// @param withStep  whether --step is
std::string typedOptions(const SimulationOptions& options, bool withStep);

/// All of them as one JSON object, to compare with another run.
nlohmann::ordered_json settingsOf(const SimulationOptions& options);

/// Adds only the options of the model: --coordinate, --lock, --set and --wrap-as-cylinder.
void addModelOptions(CLI::App& subcommand, SimulationOptions& options);

}  // namespace app
