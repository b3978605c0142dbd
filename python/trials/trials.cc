#include "trials/trials.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "arguments/columns.h"
#include "arguments/file_name.h"
#include "bio/analysis/replay.h"
#include "bio/tables/trial_table.h"
#include "docstrings.h"

namespace python {
namespace {

bio::Trial trialOfColumns(const bio::Model& model, const py::object& columns,
                          const std::string& name, bool ignoreExtra, double knownMassInHand,
                          double knownArmTurn, const std::vector<std::string>& prescribe,
                          const std::map<std::string, double>& hold,
                          std::optional<double> prescribeCutoff,
                          const std::string& latentExcitation) {
  bio::Table table = tableOf(columns, name);
  table.metadata = bio::headerOf({knownMassInHand, knownArmTurn});
  if (!latentExcitation.empty()) table.metadata["latent_excitation"] = latentExcitation;
  bio::Trial trial = trialOf(table, name, model,
                             {.ignoreExtra = ignoreExtra,
                              .experimentalConditions = true,
                              .prescribed = prescribe,
                              .held = hold});
  if (prescribeCutoff) bio::smoothPrescribed(trial, *prescribeCutoff);
  return trial;
}

bio::Trial loadTrial(const FileName& file, const bio::Model& model, bool ignoreExtra,
                     const std::vector<std::string>& prescribe,
                     const std::map<std::string, double>& hold,
                     std::optional<double> prescribeCutoff) {
  bio::Trial trial = bio::readTrial(file.text, model,
                                    {.ignoreExtra = ignoreExtra,
                                     .experimentalConditions = true,
                                     .prescribed = prescribe,
                                     .held = hold});
  trial.sha256 =
      digestOf(py::module_::import("pathlib").attr("Path")(file.text).attr("read_bytes")());
  if (prescribeCutoff) bio::smoothPrescribed(trial, *prescribeCutoff);
  return trial;
}

/// A copy, known as the recording that it is of.
bio::Trial withExcitations(bio::Trial trial, const Eigen::MatrixXd& excitations) {
  const Eigen::MatrixXd& now = trial.excitations;
  if (excitations.rows() != now.rows() || excitations.cols() != now.cols()) {
    throw std::invalid_argument(
        fmt::format("{}: excitations: {} x {} numbers, must be {} x {}, times x muscles",
                    trial.file, excitations.rows(), excitations.cols(), now.rows(), now.cols()));
  }
  for (Eigen::Index m = 0; m < now.cols(); ++m) {
    for (Eigen::Index row = 0; row < now.rows(); ++row) {
      const double value = excitations(row, m);
      if (value >= 0 && value <= 1) continue;
      throw std::invalid_argument(
          fmt::format("{}: excitation of {} at {} s = {}, must be 0 to 1", trial.file,
                      trial.muscles[static_cast<std::size_t>(m)], trial.times[row], value));
    }
  }
  trial.excitations = excitations;
  return trial;
}

/// At the rows of the trial; NaN where there is no sample.
Eigen::VectorXd atRows(const bio::Trial& trial, const bio::MeasuredChannel& channel) {
  Eigen::VectorXd values = Eigen::VectorXd::Constant(trial.times.size(), NAN);
  Eigen::Index row = 0;
  for (Eigen::Index i = 0; i < channel.times.size(); ++i) {
    while (row < trial.times.size() && trial.times[row] < channel.times[i]) ++row;
    if (row < trial.times.size() && trial.times[row] == channel.times[i]) {
      values[row] = channel.values[i];
    }
  }
  return values;
}

/// A prescribed motion, which a cutoff has given times of its own.
Eigen::VectorXd courseAtRows(const bio::Trial& trial, const bio::MeasuredChannel& channel) {
  const Eigen::VectorXd values = atRows(trial, channel);
  if (values.allFinite()) return values;
  Eigen::VectorXd course(trial.times.size());
  Eigen::Index i = 0;
  for (Eigen::Index row = 0; row < course.size(); ++row) {
    while (i + 2 < channel.times.size() && channel.times[i + 1] < trial.times[row]) ++i;
    const double part =
        (trial.times[row] - channel.times[i]) / (channel.times[i + 1] - channel.times[i]);
    course[row] = std::lerp(channel.values[i], channel.values[i + 1], part);
  }
  return course;
}

/// As make_trial takes them.
py::dict columnsOfTrial(const bio::Trial& trial, const bio::Model& model) {
  py::dict columns;
  columns["time"] = trial.times;
  for (std::size_t m = 0; m < trial.muscles.size(); ++m) {
    columns[trial.muscles[m].c_str()] =
        Eigen::VectorXd(trial.excitations.col(static_cast<Eigen::Index>(m)));
  }
  for (const bio::AppliedForce& force : trial.applied) {
    if (!force.actuator.empty()) {
      columns[force.actuator.c_str()] = force.control;
      continue;
    }
    const bool turns = bio::findCoordinate(model, force.coordinate).isRotation;
    columns[(force.coordinate + (turns ? ".torque" : ".force")).c_str()] = force.values;
  }
  for (const bio::MeasuredChannel& channel : trial.measured) {
    columns[bio::nameOf(channel.what).c_str()] = atRows(trial, channel);
  }
  for (const bio::MeasuredChannel& channel : trial.prescribed) {
    if (channel.times.size() < 2) continue;  // held
    columns[bio::nameOf(channel.what).c_str()] = courseAtRows(trial, channel);
  }
  return columns;
}

py::dict coursesOf(const std::vector<bio::MeasuredChannel>& motions) {
  py::dict courses;
  for (const bio::MeasuredChannel& channel : motions) {
    if (!channel.what.isCoordinate()) continue;
    courses[channel.what.object.c_str()] = py::make_tuple(channel.times, channel.values);
  }
  return courses;
}

py::dict channelsOf(const bio::Trial& trial) {
  py::dict channels;
  for (const bio::MeasuredChannel& channel : trial.measured) {
    if (channel.what.isCoordinate()) continue;
    channels[bio::nameOf(channel.what).c_str()] = py::make_tuple(channel.times, channel.values);
  }
  return channels;
}

}  // namespace

bio::Trial trialOf(const bio::Table& table, const std::string& name, const bio::Model& model,
                   const bio::TrialOptions& options) {
  bio::Trial trial = bio::trialFrom(table, name, model, options);
  trial.sha256 = digestOf(
      py::repr(py::make_tuple(
                   name, py::bytes(reinterpret_cast<const char*>(table.values.data()),
                                   sizeof(double) * static_cast<std::size_t>(table.values.size()))))
          .attr("encode")());
  return trial;
}

std::string digestOf(const py::object& bytes) {
  return py::module_::import("hashlib")
      .attr("sha256")(bytes)
      .attr("hexdigest")()
      .cast<std::string>();
}

py::class_<bio::Trial> defineTrials(py::module_& module) {
  py::class_<bio::Trial> trial(module, "Trial", docstrings::Trial);
  trial.attr("__module__") = packageName;
  trial.def_readonly("name", &bio::Trial::file, docstrings::Trial_name)
      .def_readonly("times", &bio::Trial::times, docstrings::Trial_times)
      .def_readonly("muscles", &bio::Trial::muscles, docstrings::Trial_muscles)
      .def_readonly("excitations", &bio::Trial::excitations, docstrings::Trial_excitations)
      .def_property_readonly(
          "measured", [](const bio::Trial& self) { return coursesOf(self.measured); },
          docstrings::Trial_measured)
      .def_property_readonly(
          "prescribed", [](const bio::Trial& self) { return coursesOf(self.prescribed); },
          docstrings::Trial_prescribed)
      .def_property_readonly("channels", &channelsOf, docstrings::Trial_channels)
      .def_property_readonly(
          "known_mass_in_hand", [](const bio::Trial& self) { return self.conditions.massInHand; },
          docstrings::Trial_known_mass_in_hand)
      .def_property_readonly(
          "known_arm_turn", [](const bio::Trial& self) { return self.conditions.armTurn; },
          docstrings::Trial_known_arm_turn)
      .def_readonly("warnings", &bio::Trial::warnings, docstrings::Trial_warnings)
      .def("columns", &columnsOfTrial, "model"_a, docstrings::Trial_columns)
      .def("with_excitations", &withExcitations, "excitations"_a,
           docstrings::Trial_with_excitations)
      .def("__repr__", [](const bio::Trial& self) {
        return fmt::format("<fisherhill.Trial '{}', {} rows>", self.file, self.times.size());
      });
  module.def("load_trial", &loadTrial, "file"_a, "model"_a, py::kw_only(), "ignore_extra"_a = false,
             "prescribe"_a = std::vector<std::string>(), "hold"_a = std::map<std::string, double>(),
             "prescribe_cutoff"_a = py::none(), docstrings::load_trial);
  module.def("make_trial", &trialOfColumns, "model"_a, "columns"_a, py::kw_only(),
             "name"_a = "trial", "ignore_extra"_a = false, "known_mass_in_hand"_a = 0.0,
             "known_arm_turn"_a = 0.0, "prescribe"_a = std::vector<std::string>(),
             "hold"_a = std::map<std::string, double>(), "prescribe_cutoff"_a = py::none(),
             "latent_excitation"_a = "", docstrings::make_trial);
  return trial;
}

}  // namespace python
