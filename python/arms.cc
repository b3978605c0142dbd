#include "arms.h"

#include <fmt/format.h>

#include <stdexcept>

#include "bio/analysis/replay.h"
#include "bio/discovery/with_experimental_conditions.h"
#include "bio/model/integrator_names.h"
#include "bio/opensim/osim_file.h"
#include "bio/tables/trial_table.h"
#include "interruptible.h"

namespace python {
namespace {

bio::Trial trialOf(const bio::Model& model, const py::dict& columns, const std::string& name,
                   bool ignoreExtra, double knownMassInHand, double knownArmTurn) {
  bio::Table table;
  table.metadata = bio::headerOf({knownMassInHand, knownArmTurn});
  for (const auto& [key, values] : columns) {
    const auto column = values.cast<Eigen::VectorXd>();
    const auto index = static_cast<Eigen::Index>(table.columns.size());
    if (index == 0) table.values.resize(column.size(), static_cast<Eigen::Index>(columns.size()));
    table.columns.push_back(key.cast<std::string>());
    if (column.size() != table.values.rows()) {
      throw std::invalid_argument(fmt::format("{}: column '{}' has {} rows, must be {} as '{}' has",
                                              name, table.columns.back(), column.size(),
                                              table.values.rows(), table.columns.front()));
    }
    table.values.col(index) = column;
  }
  bio::Trial trial = bio::trialFrom(table, name, model,
                                    {.ignoreExtra = ignoreExtra, .experimentalConditions = true});
  trial.sha256 = digestOf(
      py::repr(py::make_tuple(
                   name, py::bytes(reinterpret_cast<const char*>(table.values.data()),
                                   sizeof(double) * static_cast<std::size_t>(table.values.size()))))
          .attr("encode")());
  return trial;
}

py::dict measuredOf(const bio::Trial& trial) {
  py::dict measured;
  for (const bio::MeasuredMotion& one : trial.measured) {
    measured[one.coordinate.c_str()] = py::make_tuple(one.times, one.values);
  }
  return measured;
}

std::vector<std::string> coordinatesOf(const bio::Model& model) {
  std::vector<std::string> names;
  for (const bio::Joint& joint : model.joints) {
    for (const bio::Coordinate& one : joint.coordinates) names.push_back(one.name);
  }
  return names;
}

std::vector<std::string> musclesOf(const bio::Model& model) {
  std::vector<std::string> names;
  for (const bio::Muscle& one : model.muscles) {
    if (one.enabled) names.push_back(one.name);
  }
  return names;
}

/// Root mean square error against what was measured, by coordinate.
py::dict errorsOf(const bio::MusculoskeletalSystem& arm, const bio::Trial& trial,
                  const bio::Trajectory& motion) {
  py::dict errors;
  for (const bio::MeasuredMotion& measured : trial.measured) {
    const auto& free = arm.skeleton().coordinates();
    const bool isFree = std::any_of(free.begin(), free.end(), [&](const bio::Coordinate& one) {
      return one.name == measured.coordinate;
    });
    if (isFree && motion.time.back() >= measured.times[0]) {
      errors[measured.coordinate.c_str()] = bio::compareWithMeasured(arm, motion, measured).rms;
    }
  }
  return errors;
}

py::object replay(const bio::Model& given, const bio::Trial& trial,
                  const std::map<std::string, double>& initial, const py::kwargs& keywords) {
  const SystemChoice choice = armChoice(keywords);
  bio::TrialReplay replayed;
  const bio::Trajectory& motion = replayed.motion;
  bio::MuscleReport muscles;
  double energyError = 0;
  std::unique_ptr<bio::MusculoskeletalSystem> arm;
  interruptible([&](const std::atomic<bool>& goOn) {
    const bio::Model model =
        trial.known.any() ? bio::discover::withExperimentalConditions(
                                given, choice.armOptions(),
                                choice.coordinates.empty() ? "" : choice.coordinates.front(), trial)
                          : given;
    arm = std::make_unique<bio::MusculoskeletalSystem>(model, choice.armOptions());
    bio::SimulationOptions options = choice.simulation();
    options.step = bio::stepOf(model, options.integrator, choice.step);
    options = during(trial, options);
    options.progress = [&](double) { return goOn.load(); };
    replayed =
        bio::replayTrial(*arm, trial, options, bio::beginningOf(trial, model, *arm, initial));
    muscles = bio::reportMuscles(*arm, motion);
    energyError = bio::energyError(*arm, motion);
  });
  std::vector<std::string> coordinates, names;
  for (const auto& one : arm->skeleton().coordinates()) coordinates.push_back(one.name);
  for (const auto& one : arm->muscles()) names.push_back(one.name);
  return results("time"_a = py::array_t<double>(py::cast(motion.time)),
                 "coordinates"_a = coordinates, "muscles"_a = names,
                 "q"_a = motion.q.transpose().eval(), "q_dot"_a = motion.qDot.transpose().eval(),
                 "activation"_a = motion.activation.transpose().eval(),
                 "fibre_length"_a = motion.fibreLength.transpose().eval(),
                 "tendon_force"_a = muscles.tendonForce.transpose().eval(),
                 "moment_arm"_a = muscles.momentArm.transpose().eval(),
                 "rms_error"_a = errorsOf(*arm, trial, motion), "energy_error"_a = energyError,
                 "outcome"_a = bio::name(motion.outcome), "why"_a = motion.why,
                 "start_from"_a = bio::name(replayed.beginning.from),
                 "step"_a = replayed.options.step, "steps"_a = motion.steps,
                 "newton_iterations"_a = motion.newtonIterations, "warnings"_a = arm->warnings());
}

}  // namespace

bio::SystemOptions SystemChoice::armOptions() const {
  bio::SystemOptions options;
  options.skeleton.freeCoordinates = coordinates;
  options.skeleton.lockedValues = locks;
  return options;
}

bio::SimulationOptions SystemChoice::simulation() const {
  const auto found = bio::integratorNamed(integrator);
  if (!found) {
    throw std::invalid_argument(
        fmt::format("integrator '{}', must be vi, vi-left, rk4 or cvode", integrator));
  }
  bio::SimulationOptions options;
  options.integrator = *found;
  options.step = step.value_or(bio::defaultStep(*found));
  return options;
}

SystemChoice armChoice(const py::kwargs& keywords) {
  SystemChoice choice;
  for (const auto& [key, value] : keywords) {
    const auto name = key.cast<std::string>();
    if (name == "coordinate") {
      choice.coordinates = py::isinstance<py::str>(value)
                               ? std::vector<std::string>{value.cast<std::string>()}
                               : value.cast<std::vector<std::string>>();
    } else if (name == "lock") {
      choice.locks = value.cast<std::map<std::string, double>>();
    } else if (name == "integrator") {
      choice.integrator = value.cast<std::string>();
    } else if (name == "step") {
      choice.step = value.cast<double>();
      if (!(*choice.step > 0)) {
        throw std::invalid_argument(fmt::format("step = {} s, must be > 0", *choice.step));
      }
    } else {
      throw std::invalid_argument(fmt::format("unknown argument '{}'", name));
    }
  }
  return choice;
}

std::string digestOf(const py::object& bytes) {
  return py::module_::import("hashlib")
      .attr("sha256")(bytes)
      .attr("hexdigest")()
      .cast<std::string>();
}

void mustBeOfTheModelAsItIs(const bio::Trial& trial) {
  if (!trial.known.any()) return;
  throw std::invalid_argument(
      fmt::format("{}: recorded {}, which only discover and replay take into account", trial.file,
                  bio::inWords(trial.known)));
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
  py::class_<bio::Model>(module, "Model", "A musculoskeletal model.")
      .def_readonly("name", &bio::Model::name)
      .def_readonly("warnings", &bio::Model::warnings, "what was read but is not simulated")
      .def_property_readonly("coordinates", &coordinatesOf)
      .def_property_readonly("muscles", &musclesOf, "enabled muscles")
      .def(
          "write",
          [](const bio::Model& model, const std::string& file) { bio::writeOsim(model, file); },
          "file"_a, "Writes the model as an .osim file.")
      .def("__repr__", [](const bio::Model& model) {
        return fmt::format("<fisherhill.Model '{}', {} muscles>", model.name,
                           musclesOf(model).size());
      });
  py::class_<bio::Trial>(module, "Trial",
                         "Excitations, measured coordinates and loads of one recording.")
      .def_readonly("name", &bio::Trial::file)
      .def_readonly("times", &bio::Trial::times, "[s]")
      .def_readonly("muscles", &bio::Trial::muscles)
      .def_readonly("excitations", &bio::Trial::excitations, "0 to 1; times × muscles")
      .def_property_readonly("measured", &measuredOf,
                             "{coordinate: (times [s], values [rad] or [m])}")
      .def_property_readonly(
          "known_mass_in_hand", [](const bio::Trial& trial) { return trial.known.massInHand; },
          "mass held by design [kg]; only discover and replay take it into account")
      .def_property_readonly(
          "known_arm_turn", [](const bio::Trial& trial) { return trial.known.armTurn; },
          "angle by which the whole limb was turned [rad]; only discover and replay take it into "
          "account")
      .def_readonly("warnings", &bio::Trial::warnings)
      .def("__repr__", [](const bio::Trial& trial) {
        return fmt::format("<fisherhill.Trial '{}', {} rows>", trial.file, trial.times.size());
      });
  module.def(
      "load_model", [](const std::string& file) { return bio::readOsim(file); }, "file"_a,
      "Reads an OpenSim 3 or 4 model (.osim).");
  module.def(
      "load_trial",
      [](const std::string& file, const bio::Model& model, bool ignoreExtra) {
        bio::Trial trial = bio::readTrial(
            file, model, {.ignoreExtra = ignoreExtra, .experimentalConditions = true});
        trial.sha256 =
            digestOf(py::module_::import("pathlib").attr("Path")(file).attr("read_bytes")());
        return trial;
      },
      "file"_a, "model"_a, py::kw_only(), "ignore_extra"_a = false,
      R"doc(Reads a trial of the model (.sto, .mot or .csv).

Header lines known_mass_in_hand_kg=1 and known_arm_turn_deg=-45 state the experimental conditions.)doc");
  module.def("make_trial", &trialOf, "model"_a, "columns"_a, py::kw_only(), "name"_a = "trial",
             "ignore_extra"_a = false, "known_mass_in_hand"_a = 0.0, "known_arm_turn"_a = 0.0,
             R"doc(Makes a trial from arrays.

Parameters
----------
model : Model
columns : dict
    {column: values}, named as in a file: 'time' [s]; muscles (excitation, 0 to 1); 'elbow_flexion'
    [rad] or 'elbow_flexion_deg', NaN where it was not measured; 'elbow_flexion.torque' [N m], an
    external load.
known_mass_in_hand : float
    Mass that the subject held by design [kg].
known_arm_turn : float
    Angle by which the whole limb was turned against the ground [rad], positive as the coordinate
    rises.)doc");
  module.def("replay", &replay, "model"_a, "trial"_a, py::kw_only(),
             "initial"_a = std::map<std::string, double>(),
             R"doc(Simulates the motion produced by a trial's excitations.

Parameters
----------
model : Model
trial : Trial
initial : dict
    {coordinate: initial value in rad or m}; default: the fitted or first measured value, else the
    model's default value.

Other keywords: coordinate='elbow_flexion' (the free coordinate, or a list of them),
lock={name: value} in rad or m, integrator='vi' ('vi-left', 'rk4' or 'cvode'), step [s].
The default step is the one that the model was fitted with, else 0.01 s (rk4: 0.0002 s).

Returns
-------
time : array
    [s]
q, q_dot : array, times x coordinates
    [rad] and [rad/s], or [m] and [m/s].
activation, fibre_length, tendon_force, moment_arm : array, times x muscles
    [1], [m], [N], [m].
coordinates, muscles : list of str
    Names of the columns.
rms_error : dict
    {coordinate: RMS error in rad or m}, where it was measured.
energy_error : float
    [J]
outcome : str
    'ok', 'unstable' or 'no solution'; `why` gives the reason.
start_from : str
    'given', 'model' (fitted by discover or calibrate for this trial), 'measured' or 'default'.
step : float
    Time step [s].)doc");
}

}  // namespace python
