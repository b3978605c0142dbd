#include "design/dynamometer_design.h"

#include <fmt/format.h>

#include <cmath>

#include "design/design_methods.h"
#include "design/design_options.h"
#include "options/set_parameters.h"
#include "options/system_options.h"
#include "options/trial_input.h"
#include "output/output_folder.h"
#include "report/result.h"

namespace app {
namespace {

/// Checks the roles of the coordinates beside the dynamometer's, and what else is said of that one.
void checkRoles(const DynamometerOptions& options, const SimulationOptions& simulation,
                const bio::Model& model) {
  if (!simulation.coordinates.empty()) {
    throw std::invalid_argument(
        "--coordinate cannot be combined with --dynamometer: all other coordinates are locked");
  }
  for (const Assignment& lock : simulation.locks) {
    if (lock.name != options.coordinate) continue;
    throw std::invalid_argument(fmt::format(
        "--lock {}: is held and turned by the dynamometer, must not be locked", lock.name));
  }
  SimulationOptions others = simulation;
  others.prescribed = {options.coordinate};
  refusePrescribedByModel(others, model);
}

}  // namespace

ExitStatus designOnDynamometer(const CommandContext& context, const DesignOptions& typed) {
  const DynamometerOptions& options = typed.dynamometer;
  if (!(options.momentNoise > 0 && std::isfinite(options.momentNoise))) {
    throw std::invalid_argument(
        fmt::format("--moment-noise: {} N·m, must be > 0", options.momentNoise));
  }
  std::vector<std::string> names;
  for (int n = 1; n <= options.count; ++n) names.push_back(fmt::format("experiment_{}.csv", n));
  OutputFolder folder(context, names);
  Summary summary(context);
  bio::Model model = readModel(typed.model, summary);
  checkRoles(options, typed.simulation, model);
  SimulationOptions simulation = typed.simulation;
  simulation.prescribed = {options.coordinate};
  model = withSetParameters(std::move(model), simulation, summary);
  const bio::MusculoskeletalSystem system = movableSystem(model, typed.model, simulation, summary);
  const bio::Coordinate& coordinate = bio::findCoordinate(model, options.coordinate);
  bio::DynamometerQuestion question = dynamometerQuestion(typed, coordinate);
  question.threads = context.threads;
  const bio::SimulationOptions simulated = simulationOptions(simulation, 0, 1);
  const bio::DynamometerPlan plan =
      bio::planOnDynamometer(model, system, systemOptions(simulation), simulated, question);
  for (std::size_t n = 0; n < plan.chosen.size(); ++n) {
    folder.writeFile(names[n], [&](const std::filesystem::path& path) {
      bio::writeTable(plan.chosen[n].trial, path);
    });
  }
  if (plan.failed > 0) {
    summary.warn(fmt::format("{} of {} experiments cannot be simulated and were left out",
                             plan.failed, plan.candidates));
  }
  tellDynamometer(plan, coordinate.isRotation, summary);
  summary.saySimulation(simulation.integrator, simulated.step);
  sayDynamometer(plan, question, coordinate.isRotation, summary.methods());
  deliver(context, summary, dynamometerReport(plan, question, coordinate.isRotation), folder);
  return ExitStatus::done;
}

}  // namespace app
