#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "command/command.h"
#include "options/simulation_options.h"

namespace app {

/// Options of `render`, as typed.
struct RenderOptions {
  std::string model;
  std::string states;          ///< empty: the posture of the default and the locked values
  std::optional<double> time;  ///< of a single picture [s]; without: the middle of the motion
  bool film = false;
  double framesPerSecond = 30;  ///< > 0
  int width = 1280;             ///< [pixel]
  int height = 960;             ///< [pixel]
  std::string camera = "fit";
  std::string geometry;  ///< folder of .vtp files
  bool showWraps = false;
  bool thicknessByForce = true;
  std::optional<double> largestActivation;  ///< with the last colour, 0 to 1; without: what occurs
  std::string ghost;                        ///< a second motion
  std::string ghostModel;                   ///< model of the second motion; empty: the same
  bool ignoreExtra = false;
  SimulationOptions simulation;  ///< only the model options
};

using Drawing = std::function<ExitStatus(const RenderOptions&, const CommandContext&)>;

/// `render`: a picture or a film of the system.
std::unique_ptr<Command> renderCommand(Drawing draw);

/// Path of the program that links VTK, whether or not it was built.
std::filesystem::path pictureProgram();

/// Replaces this process by `fisherhill-render`, which links VTK, with the same command line; does
/// not return. @throws std::runtime_error if it is missing
ExitStatus drawInOtherProgram(const RenderOptions& options, const CommandContext& context);

}  // namespace app
