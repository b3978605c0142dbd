#include "bio/review/model_review.h"

#include "arguments/file_name.h"
#include "bio/analysis/muscle_states.h"
#include "bio/analysis/opensim_paths.h"
#include "bio/path/length_jumps.h"
#include "bio/review/trial_review.h"
#include "docstrings.h"
#include "interruptible.h"
#include "systems.h"

namespace python {
namespace {

const char* nameOf(bio::Weight weight) {
  switch (weight) {
    case bio::Weight::error:
      return "error";
    case bio::Weight::warning:
      return "warning";
    case bio::Weight::unusual:
      break;
  }
  return "unusual";
}

py::object listOf(const std::vector<bio::Remark>& remarks) {
  py::list list;
  for (const bio::Remark& remark : remarks) {
    list.append(results("weight"_a = nameOf(remark.weight), "subject"_a = remark.subject,
                        "message"_a = remark.message));
  }
  return tableOfRows(list);
}

py::object lengthJumps(const bio::Model& model) {
  std::vector<bio::LengthJump> jumps;
  interruptible([&](const std::atomic<bool>&) { jumps = bio::lengthJumps(model); });
  py::list list;
  for (const bio::LengthJump& jump : jumps) {
    list.append(results("muscle"_a = jump.muscle, "coordinate"_a = jump.coordinate,
                        "value"_a = jump.value, "length"_a = jump.size, "moment_arm"_a = jump.arm,
                        "conditional"_a = jump.conditional, "text"_a = bio::describe(jump)));
  }
  return tableOfRows(list);
}

py::object openSimDifferences(const bio::Model& model) {
  std::vector<bio::OpenSimDifference> differences;
  interruptible([&](const std::atomic<bool>&) { differences = bio::openSimDifferences(model); });
  py::list list;
  for (const bio::OpenSimDifference& difference : differences) {
    std::vector<std::pair<double, double>> apart, jumps;
    for (const auto& range : difference.apart) apart.emplace_back(range.from, range.to);
    for (const auto& jump : difference.jumps) jumps.emplace_back(jump.at, jump.size);
    list.append(results("muscle"_a = difference.muscle, "coordinate"_a = difference.coordinate,
                        "ellipsoids"_a = difference.ellipsoids, "length"_a = difference.length,
                        "length_at"_a = difference.lengthAt, "moment_arm"_a = difference.arm,
                        "moment_arm_at"_a = difference.armAt, "apart"_a = apart, "jumps"_a = jumps,
                        "text"_a = bio::describe(difference)));
  }
  return tableOfRows(list);
}

py::object muscleStates(const FileName& file) {
  const std::vector<bio::MuscleState> states = bio::muscleStates(file.text);
  const auto column = [&](double bio::MuscleState::*member) {
    Eigen::VectorXd values(std::ssize(states));
    for (std::size_t i = 0; i < states.size(); ++i) {
      values[static_cast<Eigen::Index>(i)] = states[i].*member;
    }
    return values;
  };
  std::vector<std::string> classes;
  for (const bio::MuscleState& state : states) classes.push_back(state.className);
  return tableResult("MuscleStatesResult", "muscle_class"_a = classes,
                     "fibre_velocity"_a = column(&bio::MuscleState::fibreVelocity),
                     "tendon_force"_a = column(&bio::MuscleState::tendonForce),
                     "static_fibre_length"_a = column(&bio::MuscleState::staticFibreLength),
                     "static_tendon_force"_a = column(&bio::MuscleState::staticTendonForce));
}

}  // namespace

void defineReviews(py::module_& module, py::class_<bio::Model>& model,
                   py::class_<bio::Trial>& trial) {
  model.def_readonly("remarks", &bio::Model::remarks, docstrings::Model_remarks)
      .def(
          "review", [](const bio::Model& self) { return listOf(bio::reviewModel(self)); },
          docstrings::Model_review);
  trial.def(
      "review",
      [](const bio::Trial& self, const bio::Model& readFor) {
        return listOf(bio::reviewTrial(self, readFor));
      },
      "model"_a, docstrings::Trial_review);
  module.def("length_jumps", &lengthJumps, "model"_a, docstrings::length_jumps);
  module.def("opensim_differences", &openSimDifferences, "model"_a,
             docstrings::opensim_differences);
  module.def("muscle_states", &muscleStates, "file"_a, docstrings::muscle_states);
}

}  // namespace python
