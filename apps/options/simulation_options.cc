#include "options/simulation_options.h"

#include <fmt/format.h>

#include "bio/simulation/integrator_names.h"
#include "options/number_rules.h"
#include "options/set_parameters.h"
#include "output/text.h"

namespace app {
namespace {

const std::string modelGroup = "Model";
const std::string simulationGroup = "Simulation";

}  // namespace

CLI::Option* addAssignments(CLI::App& subcommand, const std::string& name,
                            std::vector<Assignment>& target, const std::string& description) {
  return subcommand
      .add_option_function<std::vector<std::string>>(
          name,
          [&target, name](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) {
              try {
                target.push_back(parseAssignment(text));
              } catch (const std::invalid_argument& error) {
                throw CLI::ValidationError(name, error.what());
              }
            }
          },
          description)
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
}

double SimulationOptions::stepOrDefault() const {
  return step.value_or(bio::defaultStep(bio::integratorNamed(integrator).value()));
}

bool SimulationOptions::isVariational() const {
  return bio::isVariational(bio::integratorNamed(integrator).value());
}

std::string typedOptions(const SimulationOptions& options, bool withStep) {
  std::string text;
  if (!options.areChosen)
    for (const std::string& name : options.coordinates) text += " --coordinate " + shellWord(name);
  for (const std::string& name : options.prescribed) text += " --prescribe " + shellWord(name);
  if (options.prescribeCutoff)
    text += fmt::format(" --prescribe-cutoff {}", *options.prescribeCutoff);
  for (const Assignment& lock : options.locks)
    text += " --lock " + shellWord(fmt::format("{}={}", lock.name, lock.value));
  for (const std::string& name : options.wrapAsCylinder)
    text += " --wrap-as-cylinder " + shellWord(name);
  if (options.integrator != SimulationOptions().integrator)
    text += " --integrator " + options.integrator;
  if (options.ignoreExtra) text += " --ignore-extra";
  if (withStep && options.step) text += fmt::format(" --step {}", *options.step);
  return text;
}

nlohmann::ordered_json settingsOf(const SimulationOptions& options) {
  const auto valuesOf = [](const std::vector<Assignment>& assignments) {
    nlohmann::ordered_json list = nlohmann::ordered_json::object();
    for (const Assignment& assignment : assignments) list[assignment.name] = assignment.value;
    return list;
  };
  return {{"integrator", options.integrator},
          {"step_s", options.stepOrDefault()},
          {"coordinates", options.coordinates},
          {"locked", valuesOf(options.locks)},
          {"initial", valuesOf(options.initial)},
          {"set", valuesOf(options.set)},
          {"wrap_as_cylinder", options.wrapAsCylinder},
          {"ignore_extra", options.ignoreExtra},
          {"prescribed", options.prescribed},
          {"prescribe_cutoff_Hz", options.prescribeCutoff.value_or(0)},
          {"held", options.held}};
}

void addModelOptions(CLI::App& subcommand, SimulationOptions& options) {
  subcommand
      .add_option("--coordinate", options.coordinates,
                  "free coordinate; may be repeated; default: the measured coordinates of the "
                  "trials, else all that the model does not lock")
      ->type_name("NAME")
      ->allow_extra_args(false)
      ->delimiter(',')
      ->group(modelGroup);
  addAssignments(subcommand, "--lock", options.locks,
                 "value at which another coordinate is locked, as 30deg or 0.52 (rad; m if it "
                 "slides); default: the model's default value")
      ->group(modelGroup);
  addSetOption(subcommand, options.set)->group(modelGroup);
  subcommand
      .add_option("--wrap-as-cylinder", options.wrapAsCylinder,
                  "treat this wrap ellipsoid as a cylinder; two of its semi-axes must be equal")
      ->type_name("NAME")
      ->allow_extra_args(false)
      ->delimiter(',')
      ->group(modelGroup);
}

void addPrescribing(CLI::App& subcommand, SimulationOptions& options) {
  options.takesPrescribed = true;
  subcommand
      .add_option("--prescribe", options.prescribed,
                  "coordinate that moves as its column in the trial says, as on a dynamometer; "
                  "what holds it there is NAME.reaction; may be repeated; default: those that the "
                  "model prescribes move on its functions of time")
      ->type_name("NAME")
      ->allow_extra_args(false)
      ->delimiter(',')
      ->group(modelGroup);
  subcommand
      .add_option("--prescribe-cutoff", options.prescribeCutoff,
                  "smooth the prescribed motions, so that a sine of this frequency [Hz] is halved; "
                  "default: not smoothed")
      ->check(positive())
      ->type_name("HZ")
      ->group(modelGroup);
}

void addSimulationOptions(CLI::App& subcommand, SimulationOptions& options) {
  addModelOptions(subcommand, options);
  subcommand
      .add_option(
          "--integrator", options.integrator,
          "vi (midpoint variational, forces at both ends of a step, second order), vi-left (the "
          "same with forces at the left end only, first order), vi-adaptive (vi in parts of a step "
          "as short as their errors ask for), rk4 or cvode (adaptive reference)")
      ->check(CLI::IsMember({"vi", "vi-left", "vi-adaptive", "rk4", "cvode"}))
      ->capture_default_str()
      ->group(simulationGroup);
  subcommand
      .add_option_function<std::string>(
          "--step",
          [&options](const std::string& text) {
            double step = 0;
            try {
              step = parseNumber(text);
            } catch (const std::invalid_argument& error) {
              throw CLI::ValidationError("--step", error.what());
            }
            if (!(step > 0)) {
              throw CLI::ValidationError("--step", fmt::format("{} s must be > 0", text));
            }
            options.step = step;
          },
          "time step; default 0.01 (rk4: 0.0002)")
      ->type_name("SECONDS")
      ->group(simulationGroup);
  addAssignments(
      subcommand, "--initial", options.initial,
      "initial value of a free coordinate, at rest, as 34deg or 0.59 (rad; m if it slides); "
      "default: the fitted or first measured value, else the model's default value")
      ->group(simulationGroup);
  subcommand
      .add_flag("--ignore-extra", options.ignoreExtra,
                "ignore columns of the trial that match nothing in the model")
      ->group(simulationGroup);
}

}  // namespace app
