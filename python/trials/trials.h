#pragma once

#include <string>

#include "bio/model/model.h"
#include "bio/tables/table_file.h"
#include "bio/tables/trial.h"
#include "namespace.h"

namespace python {

/// SHA-256 of a bytes object, by which models know trials that they were fitted to.
std::string digestOf(const py::object& bytes);

/// bio::trialFrom, known by its numbers as trials of files are by theirs.
bio::Trial trialOf(const bio::Table& table, const std::string& name, const bio::Model& model,
                   const bio::TrialOptions& options);

/// The class Trial, load_trial and make_trial.
py::class_<bio::Trial> defineTrials(py::module_& module);

}  // namespace python
