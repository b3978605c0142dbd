#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bio/model/model.h"
#include "bio/simulation/musculoskeletal_system.h"
#include "bio/simulation/simulate.h"
#include "bio/tables/trial.h"
#include "namespace.h"

namespace python {

/// What most functions of arms are given, as keyword arguments.
struct SystemChoice {
  std::vector<std::string> coordinates = {"elbow_flexion"};  ///< free
  std::map<std::string, double> locks;                       ///< [rad] or [m]
  std::string integrator = "vi";
  std::optional<double> step;  ///< [s]; none: the integrator's default

  bio::SystemOptions armOptions() const;
  /// @throws std::invalid_argument for an integrator that there is not
  bio::SimulationOptions simulation() const;
};

/// Reads `coordinate` (a name or a list of them), `lock`, `integrator` and `step`.
/// @throws std::invalid_argument for any other keyword
SystemChoice armChoice(const py::kwargs& keywords);

/// SHA-256 of a bytes object, by which models know trials that they were fitted to.
std::string digestOf(const py::object& bytes);

/// For what simulates the model as it is.
/// @throws std::invalid_argument for a trial that was recorded with something changed on purpose
void mustBeOfTheModelAsItIs(const bio::Trial& trial);

/// A trial's place in time.
bio::SimulationOptions during(const bio::Trial& trial, bio::SimulationOptions options);

void defineSystems(py::module_& module);
void defineSensitivity(py::module_& module);
void defineCalibration(py::module_& module);
void defineDiscovery(py::module_& module);

}  // namespace python
