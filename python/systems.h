#pragma once

#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "bio/model/model.h"
#include "bio/simulation/musculoskeletal_system.h"
#include "bio/simulation/simulate.h"
#include "bio/tables/trial.h"
#include "namespace.h"

namespace python {

/// The options that most functions of systems have.
struct SystemChoice {
  std::vector<std::string> coordinates;  ///< free
  std::vector<std::string> prescribed;   ///< those of the trials, and of the model
  std::map<std::string, double> locks;   ///< [rad] or [m]
  std::string integrator = "vi";
  std::optional<double> step;  ///< [s]; none: the integrator's default

  bio::SystemOptions systemOptions() const;
  /// @throws std::invalid_argument for an integrator that there is not
  bio::SimulationOptions simulation() const;
};

/// A name or a list of them.
using Names = std::variant<std::string, std::vector<std::string>>;

/// @param trials  if no coordinate is named, bio::freeByDefault takes those that they measure
/// @param mayBeNone  as freeByDefault has it; where something is prescribed none is an answer
/// anyway
/// @throws std::invalid_argument for a step that is not > 0, and what freeByDefault throws
SystemChoice systemChoice(const bio::Model& model, const std::vector<bio::Trial>& trials,
                          const Names& coordinate, const std::map<std::string, double>& lock,
                          const std::string& integrator, std::optional<double> step,
                          bool mayBeNone = false);

/// Defines a function whose last four arguments are those of armChoice(), by name.
/// @param before  annotations of the arguments before them, and the docstring
template <class Function, class... Annotations>
void defineWithChoice(py::module_& module, const char* name, Function function,
                      const Annotations&... before) {
  module.def(name, function, before..., "coordinate"_a = std::vector<std::string>(),
             "lock"_a = std::map<std::string, double>(), "integrator"_a = "vi",
             "step"_a = py::none());
}

/// For what simulates the model as it is.
/// @throws std::invalid_argument for a trial that was recorded with something changed on purpose
void mustBeOfTheModelAsItIs(const bio::Trial& trial);

/// A trial's place in time.
bio::SimulationOptions during(const bio::Trial& trial, bio::SimulationOptions options);

void defineSystems(py::module_& module);
/// Also defines what the classes say of themselves.
void defineReviews(py::module_& module, py::class_<bio::Model>& model,
                   py::class_<bio::Trial>& trial);
void defineEmg(py::module_& module);
void definePaths(py::module_& module);
void defineComparisons(py::module_& module);
void defineEnsemble(py::module_& module);
void defineSensitivity(py::module_& module);
void definePrediction(py::module_& module);
void defineCalibration(py::module_& module);
void defineDiscovery(py::module_& module);
void defineStudies(py::module_& module);
void defineDesign(py::module_& module);
void defineDynamometer(py::module_& module);

}  // namespace python
