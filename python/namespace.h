#pragma once

#include <pybind11/eigen.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <map>
#include <string>
#include <utility>

/// Results of the module's functions: a types.SimpleNamespace, whose members are NumPy arrays,
/// numbers, strings, lists and dictionaries.
namespace python {

namespace py = pybind11;
using namespace py::literals;

/// The package that the compiled module `_fisherhill` is part of, by which its classes are called.
inline constexpr char packageName[] = "fisherhill";

/// Two numbers by name: bounds (low, high), priors (mean, sd).
using Pairs = std::map<std::string, std::pair<double, double>>;

/// One of a class of src/fisherhill/_results.py, which has tables and drawings; else as results().
template <class... Members>
py::object tableResult(const char* kind, Members&&... members) {
  return py::module_::import("fisherhill._results").attr(kind)(std::forward<Members>(members)...);
}

/// A list of results as a table.
inline py::object tableOfRows(const py::list& list) {
  return py::module_::import("fisherhill._results").attr("Rows")(list);
}

template <class... Members>
py::object results(Members&&... members) {
  return py::module_::import("types").attr("SimpleNamespace")(std::forward<Members>(members)...);
}

}  // namespace python
