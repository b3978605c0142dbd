#pragma once

#include <string>
#include <vector>

#include "bio/model/model.h"
#include "command/command.h"
#include "options/simulation_options.h"
#include "output/summary.h"

namespace app {

/// Request of `moment-arms --fit`.
struct FitRequest {
  CLI::Option* option = nullptr;     ///< --fit
  std::string table;                 ///< empty: the model's own lengths
  std::vector<std::string> muscles;  ///< empty: all
  double tolerance = 0.1;            ///< [mm]
  int order = 9;
  bool isGiven() const { return option->count() > 0; }
};

/// Adds --fit [TABLE], --fit-muscle, --fit-tolerance and --fit-order.
void addFitOptions(CLI::App& options, FitRequest& request);

/// Fits polynomials to paths and writes a model with them: fitted_paths.osim, fitted_paths.csv.
/// @param file  of the model
ExitStatus runFit(const CommandContext& context, Summary& summary, const std::string& file,
                  const bio::Model& model, SimulationOptions& options, const FitRequest& request);

}  // namespace app
