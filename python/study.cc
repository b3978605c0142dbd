#include <numbers>

#include "arms.h"
#include "bio/tables/study_file.h"
#include "docstrings.h"

namespace python {
namespace {

py::object subjectOf(const bio::StudySubject& subject) {
  py::list recordings;
  for (const bio::StudyRecording& one : subject.recordings) {
    recordings.append(
        results("file"_a = one.file, "config"_a = one.config, "held_out"_a = one.isHeldOut));
  }
  return results("name"_a = subject.name, "model"_a = subject.model, "train"_a = subject.train,
                 "hold_out"_a = subject.heldOut, "recordings"_a = recordings);
}

py::object readStudy(const std::string& file) {
  const bio::StudyFile study = bio::readStudy(file);
  py::list subjects;
  for (const bio::StudySubject& subject : study.subjects) subjects.append(subjectOf(subject));
  py::object noise = py::none();
  if (study.noise_deg) noise = py::float_(*study.noise_deg * std::numbers::pi / 180);
  return results("title"_a = study.title, "parameters"_a = study.parameters,
                 "own_start"_a = study.ownStart, "priors"_a = study.priors, "noise"_a = noise,
                 "starts"_a = study.starts, "discover"_a = study.discover,
                 "max_effects"_a = study.maxEffects, "without"_a = study.without,
                 "coordinates"_a = study.coordinates, "lock"_a = study.locks,
                 "step"_a = study.step_s, "subjects"_a = subjects);
}

}  // namespace

void defineStudies(py::module_& module) {
  module.def("read_study", &readStudy, "file"_a, docstrings::read_study);
  module.attr("_study_docstring") = docstrings::study;  // of _study.py
}

}  // namespace python
