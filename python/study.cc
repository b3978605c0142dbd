#include <numbers>

#include "arguments/file_name.h"
#include "bio/skeleton/free_coordinates.h"
#include "bio/tables/study_file.h"
#include "docstrings.h"
#include "systems.h"

namespace python {
namespace {

py::object subjectOf(const bio::StudySubject& subject) {
  py::list recordings;
  for (const bio::StudyRecording& recording : subject.recordings) {
    recordings.append(results("file"_a = recording.file, "config"_a = recording.config,
                              "held_out"_a = recording.isHeldOut));
  }
  return results("name"_a = subject.name, "model"_a = subject.model, "train"_a = subject.train,
                 "hold_out"_a = subject.heldOut, "recordings"_a = recordings,
                 "set"_a = subject.sets);
}

py::object readStudy(const FileName& file) {
  const bio::StudyFile study = bio::readStudy(file.text);
  py::list subjects;
  for (const bio::StudySubject& subject : study.subjects) subjects.append(subjectOf(subject));
  py::object noise = py::none();
  if (study.noise_deg) noise = py::float_(*study.noise_deg * std::numbers::pi / 180);
  return results("title"_a = study.title, "parameters"_a = study.parameters,
                 "own_start"_a = study.ownStart, "priors"_a = study.priors, "noise"_a = noise,
                 "starts"_a = study.starts, "discover"_a = study.discover,
                 "max_effects"_a = study.maxEffects, "without"_a = study.without,
                 "coordinates"_a = study.coordinates, "lock"_a = study.locks, "set"_a = study.sets,
                 "step"_a = study.step_s, "subjects"_a = subjects);
}

/// {coordinate: value [rad] or [m]} at which trials measure the moment of a coordinate that does
/// not move, where load_trial's `hold` has it, as the program holds it.
std::map<std::string, double> heldIn(const bio::Model& model, const std::vector<bio::Trial>& trials,
                                     const std::vector<std::string>& coordinates,
                                     const std::map<std::string, double>& lock) {
  std::set<std::string> moments;
  for (const bio::Trial& trial : trials)
    for (const bio::MeasuredChannel& channel : trial.measured)
      if (channel.what.kind == bio::Observable::Kind::moment) moments.insert(channel.what.object);
  const SystemChoice choice =
      systemChoice(model, trials, coordinates, lock, "vi", {}, !moments.empty());
  std::set<std::string> moving(choice.coordinates.begin(), choice.coordinates.end());
  moving.insert(choice.prescribed.begin(), choice.prescribed.end());
  std::map<std::string, double> held = bio::heldCoordinates(model, moving, lock);
  std::erase_if(held, [&](const auto& one) { return !moments.contains(one.first); });
  return held;
}

}  // namespace

void defineStudies(py::module_& module) {
  module.def("read_study", &readStudy, "file"_a, docstrings::read_study);
  module.def("_held", &heldIn, "model"_a, "trials"_a, "coordinates"_a, "lock"_a);
  module.attr("_study_docstring") = docstrings::study;      // of _study.py
  module.attr("_explore_docstring") = docstrings::explore;  // of _explore.py
}

}  // namespace python
