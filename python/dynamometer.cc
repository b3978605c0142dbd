#include <fmt/format.h>

#include <optional>
#include <set>

#include "arguments/columns.h"
#include "bio/design/dynamometer_question.h"
#include "bio/model/units.h"
#include "bio/skeleton/free_coordinates.h"
#include "docstrings.h"
#include "interruptible.h"
#include "systems.h"
#include "trials/trials.h"

namespace python {
namespace {

using Values = std::vector<double>;

/// The dynamometer moves one coordinate, all others are locked.
SystemChoice dynamometerChoice(const bio::Model& model, const std::string& coordinate,
                               const std::map<std::string, double>& lock,
                               const std::string& integrator, std::optional<double> step) {
  if (lock.contains(coordinate)) {
    throw std::invalid_argument(fmt::format(
        "lock: '{}' is held and turned by the dynamometer, must not be locked", coordinate));
  }
  std::set<std::string> otherwise = {coordinate};
  for (const auto& [name, value] : lock) otherwise.insert(name);
  for (const std::string& name : bio::prescribedByModel(model, otherwise)) {
    throw std::invalid_argument(fmt::format(
        "'{}' is prescribed by the model, which a dynamometer does not take: lock it", name));
  }
  SystemChoice choice = systemChoice(model, {}, coordinate, lock, integrator, step);
  choice.coordinates.clear();
  choice.prescribed = {coordinate};
  return choice;
}

py::object experimentOf(const bio::DynamometerExperiment& experiment, double information,
                        const Eigen::VectorXd& bounds, const bio::Coordinate& coordinate,
                        const bio::Model& model) {
  bio::TrialOptions options;
  if (!experiment.measuresAngle()) options.prescribed = {coordinate.name};
  return results(
      "kind"_a = bio::name(experiment.kind), "start"_a = experiment.from, "end"_a = experiment.to,
      "speed"_a = experiment.speed, "muscles"_a = experiment.group, "effort"_a = experiment.effort,
      "load"_a = experiment.load, "torque"_a = experiment.torque,
      "instruction"_a = bio::instructionOf(experiment, coordinate.isRotation),
      "information"_a = information, "bounds"_a = bounds, "columns"_a = columnsOf(experiment.trial),
      "trial"_a = trialOf(experiment.trial, "dynamometer", model, options));
}

py::object designOnDynamometer(const bio::Model& model, const std::string& coordinate,
                               const std::vector<std::string>& parameters,
                               const std::vector<std::string>& nuisance,
                               const std::vector<std::string>& kinds, const Values& angles,
                               const Values& speeds, const Values& efforts, const Values& releases,
                               std::optional<double> releaseSpeed, const Values& loads,
                               int experiments, double momentNoise, double noise, double rate,
                               double speed, double robustness, int threads,
                               const std::map<std::string, double>& lock,
                               const std::string& integrator, std::optional<double> step) {
  const bio::Coordinate& moved = bio::findCoordinate(model, coordinate);
  const SystemChoice choice = dynamometerChoice(model, coordinate, lock, integrator, step);
  bio::DynamometerQuestion question;
  question.coordinate = coordinate;
  question.kinds.clear();
  for (const std::string& word : kinds) question.kinds.push_back(bio::dynamometerKindNamed(word));
  question.positions = angles;
  question.speeds = speeds;
  question.efforts = efforts;
  question.releases = releases;
  question.loads = loads;
  question.parameters = parameters;
  question.nuisance = nuisance;
  question.count = experiments;
  question.noise = momentNoise;
  question.angleNoise = noise;
  question.rate = rate;
  question.fastest = speed;
  question.robustness = robustness;
  question.threads = threads;
  question = bio::withDefaults(std::move(question), moved, releaseSpeed);
  bio::DynamometerPlan plan;
  interruptible([&](const std::atomic<bool>& goOn) {
    const bio::MusculoskeletalSystem system(model, choice.systemOptions());
    bio::SimulationOptions simulation = choice.simulation();
    simulation.duration = 1;
    simulation.progress = [&](double) { return goOn.load(); };
    plan = bio::planOnDynamometer(model, system, choice.systemOptions(), simulation, question);
  });
  std::vector<std::string> names, units;
  Eigen::VectorXd before(std::ssize(plan.parameters));
  for (const bio::ModelParameter& parameter : plan.parameters) {
    before[std::ssize(names)] = parameter.sd;
    names.push_back(parameter.name);
    units.push_back(parameter.unit);
  }
  py::list chosen;
  for (std::size_t n = 0; n < plan.chosen.size(); ++n) {
    chosen.append(experimentOf(plan.chosen[n], plan.information[n], plan.bounds[n], moved, model));
  }
  return tableResult("DynamometerDesignResult", "names"_a = names, "units"_a = units,
                     "bound_before"_a = before, "bound_after"_a = plan.bounds.back(),
                     "experiments"_a = chosen, "candidates"_a = static_cast<int>(plan.candidates),
                     "candidates_not_simulated"_a = static_cast<int>(plan.failed),
                     "candidates_unsuitable"_a = static_cast<int>(plan.unsuitable));
}

}  // namespace

void defineDynamometer(py::module_& module) {
  module.def("design_on_dynamometer", &designOnDynamometer, docstrings::design_on_dynamometer,
             "model"_a, "coordinate"_a, "parameters"_a, py::kw_only(),
             "nuisance"_a = std::vector<std::string>(), "kinds"_a = std::vector<std::string>(),
             "angles"_a = Values(), "speeds"_a = Values(), "efforts"_a = Values(),
             "releases"_a = Values(), "release_speed"_a = py::none(), "loads"_a = Values(),
             "experiments"_a = 4, "moment_noise"_a = 0.5, "noise"_a = 0.5 * bio::radiansPerDegree,
             "rate"_a = 100.0, "speed"_a = 500 * bio::radiansPerDegree, "surprise"_a = 0.5,
             "threads"_a = 1, "lock"_a = std::map<std::string, double>(), "integrator"_a = "vi",
             "step"_a = py::none());
}

}  // namespace python
