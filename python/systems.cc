#include "systems.h"

#include <fmt/format.h>

#include <stdexcept>

#include "arguments/file_name.h"
#include "bio/analysis/replay.h"
#include "bio/analysis/step_effect.h"
#include "bio/discovery/with_experimental_conditions.h"
#include "bio/model/convert_muscles.h"
#include "bio/opensim/external_loads.h"
#include "bio/opensim/osim_file.h"
#include "bio/parameters/with_parameters.h"
#include "bio/path/with_cylinders.h"
#include "bio/simulation/integrator_names.h"
#include "bio/skeleton/articulated_tree.h"
#include "bio/skeleton/free_coordinates.h"
#include "docstrings.h"
#include "interruptible.h"
#include "trials/trials.h"

namespace python {
namespace {

/// Copies: a model that others hold stays as it is.
bio::Model withMuscles(bio::Model model, const std::string& className) {
  const std::vector<std::string> lost = bio::convertMuscles(model, className).lost;
  for (const std::string& one : lost)
    model.warnings.push_back(fmt::format("muscles as {}: lost is {}", className, one));
  return model;
}

bio::Model withExternalLoads(bio::Model model, const FileName& file) {
  model.externalLoads = bio::readExternalLoads(file.text, model, model.warnings);
  return model;
}

bio::NamedValue namedValue(const py::handle& name, const py::handle& value) {
  if (!py::isinstance<py::str>(name)) {
    throw py::type_error(fmt::format("a parameter's name is a {}, must be a str",
                                     py::type::of(name).attr("__name__").cast<std::string>()));
  }
  const double number = PyFloat_AsDouble(value.ptr());
  if (PyErr_Occurred() != nullptr) {
    PyErr_Clear();
    throw py::type_error(fmt::format("{}: a {}, must be a number", name.cast<std::string>(),
                                     py::type::of(value).attr("__name__").cast<std::string>()));
  }
  return {name.cast<std::string>(), number};
}

/// Copies, too.
bio::Model withParameters(const bio::Model& model, const py::object& values,
                          const Names& coordinate, const std::map<std::string, double>& lock,
                          const py::kwargs& named) {
  std::vector<bio::NamedValue> asked;
  if (!values.is_none()) {
    if (!py::hasattr(values, "items")) {
      throw py::type_error(fmt::format("values: a {}, must be a dict of numbers by name",
                                       py::type::of(values).attr("__name__").cast<std::string>()));
    }
    for (const auto& [name, value] : py::dict(values)) asked.push_back(namedValue(name, value));
  }
  for (const auto& [name, value] : named) asked.push_back(namedValue(name, value));
  if (asked.empty()) return model;
  const auto* names = std::get_if<std::vector<std::string>>(&coordinate);
  const bool chooses = names == nullptr || !names->empty();
  const bio::SystemOptions options =
      chooses ? systemChoice(model, {}, coordinate, lock, "vi", {}, true).systemOptions()
              : bio::optionsOfWholeModel(model, lock);
  bio::ModelWithParameters changed = bio::withParameters(model, options, asked);
  bio::requireOfModel(changed);
  return std::move(changed.model);
}

std::vector<std::string> coordinatesOf(const bio::Model& model) {
  std::vector<std::string> names;
  for (const bio::Joint& joint : model.joints) {
    for (const bio::Coordinate& coordinate : joint.coordinates) names.push_back(coordinate.name);
  }
  return names;
}

std::vector<std::string> musclesOf(const bio::Model& model) {
  std::vector<std::string> names;
  for (const bio::Muscle& muscle : model.muscles) {
    if (muscle.enabled) names.push_back(muscle.name);
  }
  return names;
}

/// Root mean square error against what was measured, by coordinate.
py::dict errorsOf(const bio::MusculoskeletalSystem& system, const bio::Trial& trial,
                  const bio::Trajectory& motion) {
  py::dict errors;
  for (const bio::MeasuredChannel& measured : trial.measured) {
    if (!measured.what.isCoordinate()) continue;
    const bool isFree = system.skeleton().indexOf(measured.what.object) >= 0;
    if (isFree && motion.time.back() >= measured.times[0]) {
      errors[measured.what.object.c_str()] = bio::compareWithMeasured(system, motion, measured).rms;
    }
  }
  return errors;
}

py::dict channelErrorsOf(const bio::TrialReplay& replay) {
  py::dict errors;
  for (const bio::ChannelError& error : replay.channelErrors) {
    errors[bio::nameOf(error.what).c_str()] = error.error.rms;
  }
  return errors;
}

py::dict reactionsOf(const bio::MusculoskeletalSystem& system, const bio::Trajectory& motion) {
  py::dict reactions;
  for (const int k : system.prescribed()) {
    const std::string& name = system.skeleton().coordinates()[static_cast<std::size_t>(k)].name;
    reactions[name.c_str()] = Eigen::VectorXd(motion.reaction.row(k));
  }
  return reactions;
}

py::object replay(const bio::Model& given, const bio::Trial& trial,
                  const std::map<std::string, double>& initial, bool strict,
                  const Names& coordinate, const std::map<std::string, double>& lock,
                  const std::string& integrator, std::optional<double> step) {
  const SystemChoice choice = systemChoice(given, {trial}, coordinate, lock, integrator, step);
  bio::requireLoadsCover(given.externalLoads, trial.times[0], trial.times[0] + trial.duration());
  bio::TrialReplay replayed;
  const bio::Trajectory& motion = replayed.motion;
  bio::MuscleReport muscles;
  double energyError = 0;
  std::optional<bio::LeftRange> left;
  std::optional<bio::StepEffect> ofStep;
  std::unique_ptr<bio::MusculoskeletalSystem> system;
  interruptible([&](const std::atomic<bool>& goOn) {
    const bio::Model model = trial.conditions.any()
                                 ? bio::discover::withExperimentalConditions(
                                       given, choice.systemOptions(), choice.coordinates, trial)
                                 : given;
    system = std::make_unique<bio::MusculoskeletalSystem>(model, choice.systemOptions());
    bio::SimulationOptions options = choice.simulation();
    options.step = bio::stepOf(model, options.integrator, choice.step);
    options = during(trial, options);
    options.progress = [&](double) { return goOn.load(); };
    replayed =
        bio::replayTrial(*system, trial, options, bio::beginningOf(trial, model, *system, initial));
    muscles = bio::reportMuscles(*system, motion);
    energyError = bio::energyError(*system, motion);
    left = bio::leftRange(*system, motion);
    ofStep = bio::effectOfDoubtfulStep(*system, trial, replayed, choice.step.has_value());
  });
  if (strict && left) throw std::runtime_error(left->what);
  std::vector<std::string> coordinates, names;
  for (const auto& free : system->skeleton().coordinates()) coordinates.push_back(free.name);
  for (const auto& muscle : system->muscles()) names.push_back(muscle.name);
  return tableResult(
      "ReplayResult", "time"_a = py::array_t<double>(py::cast(motion.time)),
      "coordinates"_a = coordinates, "muscles"_a = names, "q"_a = motion.q.transpose().eval(),
      "q_dot"_a = motion.qDot.transpose().eval(),
      "activation"_a = motion.activation.transpose().eval(),
      "fibre_length"_a = motion.fibreLength.transpose().eval(),
      "tendon_force"_a = muscles.tendonForce.transpose().eval(),
      "moment_arm"_a = muscles.momentArm.transpose().eval(),
      "reaction"_a = reactionsOf(*system, motion), "rms_error"_a = errorsOf(*system, trial, motion),
      "channel_rms_error"_a = channelErrorsOf(replayed), "energy_error"_a = energyError,
      "outcome"_a = bio::name(motion.outcome), "why"_a = motion.why,
      "left_range"_a = left ? left->what : "", "start_from"_a = bio::name(replayed.beginning.from),
      "step"_a = replayed.options.step, "step_too_long"_a = ofStep ? bio::describe(*ofStep) : "",
      "steps"_a = motion.steps, "newton_iterations"_a = motion.newtonIterations,
      "warnings"_a = system->warnings());
}

}  // namespace

bio::SystemOptions SystemChoice::systemOptions() const {
  bio::SystemOptions options;
  options.skeleton.freeCoordinates = coordinates;
  options.skeleton.freeCoordinates.insert(options.skeleton.freeCoordinates.end(),
                                          prescribed.begin(), prescribed.end());
  options.prescribed = prescribed;
  options.skeleton.lockedValues = locks;
  return options;
}

bio::SimulationOptions SystemChoice::simulation() const {
  const auto found = bio::integratorNamed(integrator);
  if (!found) {
    throw std::invalid_argument(
        fmt::format("integrator '{}', must be vi, vi-left, vi-adaptive, rk4 or cvode", integrator));
  }
  bio::SimulationOptions options;
  options.integrator = *found;
  options.step = step.value_or(bio::defaultStep(*found));
  return options;
}

SystemChoice systemChoice(const bio::Model& model, const std::vector<bio::Trial>& trials,
                          const Names& coordinate, const std::map<std::string, double>& lock,
                          const std::string& integrator, std::optional<double> step,
                          bool mayBeNone) {
  if (step && !(*step > 0)) {
    throw std::invalid_argument(fmt::format("step = {} s, must be > 0", *step));
  }
  const auto* one = std::get_if<std::string>(&coordinate);
  std::vector<std::string> free =
      one ? std::vector<std::string>{*one} : std::get<std::vector<std::string>>(coordinate);
  std::set<std::string> given;
  for (const bio::Trial& trial : trials)
    for (const bio::MeasuredChannel& course : trial.prescribed) given.insert(course.what.object);
  std::set<std::string> otherwise = given;
  otherwise.insert(free.begin(), free.end());
  for (const auto& [name, value] : lock) otherwise.insert(name);
  for (const std::string& name : bio::prescribedByModel(model, otherwise)) given.insert(name);
  const std::vector<std::string> prescribed(given.begin(), given.end());
  if (free.empty()) {
    std::set<std::string> locked = given, measured;
    for (const auto& [name, value] : lock) locked.insert(name);
    for (const bio::Trial& trial : trials)
      for (const bio::MeasuredChannel& channel : trial.measured)
        if (channel.what.isCoordinate()) measured.insert(channel.what.object);
    free = bio::freeByDefault(model, locked, measured, mayBeNone || !prescribed.empty());
  }
  return {.coordinates = std::move(free),
          .prescribed = prescribed,
          .locks = lock,
          .integrator = integrator,
          .step = step};
}

void mustBeOfTheModelAsItIs(const bio::Trial& trial) {
  if (!trial.conditions.any()) return;
  throw std::invalid_argument(
      fmt::format("{}: recorded {}, which only discover and replay take into account", trial.file,
                  bio::inWords(trial.conditions)));
}

bio::SimulationOptions during(const bio::Trial& trial, bio::SimulationOptions options) {
  options.startTime = trial.times[0];
  options.duration = trial.duration();
  if (options.step > options.duration) {
    throw std::invalid_argument(fmt::format("{}: lasts {} s, step {} s must not be longer",
                                            trial.file, options.duration, options.step));
  }
  return options;
}

void defineSystems(py::module_& module) {
  py::class_<bio::Model> model(module, "Model", docstrings::Model);
  model.attr("__module__") = packageName;
  const auto readModel = [](const FileName& file) { return bio::readOsim(file.text); };
  model.def(py::init(readModel), "file"_a)
      .def_readonly("name", &bio::Model::name, docstrings::Model_name)
      .def_readonly("warnings", &bio::Model::warnings, docstrings::Model_warnings)
      .def_property_readonly("coordinates", &coordinatesOf, docstrings::Model_coordinates)
      .def_property_readonly("muscles", &musclesOf, docstrings::Model_muscles)
      .def(
          "write",
          [](const bio::Model& self, const FileName& file) { bio::writeOsim(self, file.text); },
          "file"_a, docstrings::Model_write)
      .def("with_muscles", &withMuscles, "muscle_class"_a, docstrings::Model_with_muscles)
      .def("with_cylinders", &bio::withCylinders, "names"_a, docstrings::Model_with_cylinders)
      .def("with_parameters", &withParameters, "values"_a = py::none(), py::kw_only(),
           "coordinate"_a = std::vector<std::string>(), "lock"_a = std::map<std::string, double>(),
           docstrings::Model_with_parameters)
      .def("with_external_loads", &withExternalLoads, "file"_a,
           docstrings::Model_with_external_loads)
      .def("__repr__", [](const bio::Model& self) {
        return fmt::format("<fisherhill.Model '{}', {} muscles>", self.name,
                           musclesOf(self).size());
      });
  module.def("load_model", readModel, "file"_a, docstrings::load_model);
  py::class_<bio::Trial> trial = defineTrials(module);
  defineReviews(module, model, trial);
  defineWithChoice(module, "replay", &replay, docstrings::replay, "model"_a, "trial"_a,
                   py::kw_only(), "initial"_a = std::map<std::string, double>(),
                   "strict"_a = false);
}

}  // namespace python
