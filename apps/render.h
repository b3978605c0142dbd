#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "command.h"
#include "simulation_options.h"

namespace app {

/// What `render` was asked for, as it was typed.
struct RenderOptions {
  std::string model;
  std::string states;
  std::optional<double> time;  ///< of a single picture [s]; without: the middle of the motion
  bool film = false;
  double framesPerSecond = 30;  ///< > 0
  int width = 1280;             ///< [pixel]
  int height = 960;             ///< [pixel]
  std::string camera = "fit";
  std::string geometry;  ///< folder of .vtp files
  bool showWraps = false;
  bool thicknessByForce = true;
  std::string ghost;       ///< a second motion
  std::string ghostModel;  ///< the model that makes it; empty: the same
  bool ignoreExtra = false;
  SimulationOptions simulation;  ///< the model options alone
};

using Drawing = std::function<ExitStatus(const RenderOptions&, const CommandContext&)>;

/// `render`: a picture or a film of the arm.
std::unique_ptr<Command> renderCommand(Drawing draw);

/// Where the program that links VTK is, built or not.
std::filesystem::path pictureProgram();

/// Hands the same command line to the program `fisherhill-render` beside this one, which links
/// VTK; does not return. @throws std::runtime_error if it is not there
ExitStatus drawInOtherProgram(const RenderOptions& options, const CommandContext& context);

}  // namespace app
