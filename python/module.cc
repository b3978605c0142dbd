#include <pybind11/pybind11.h>

#include <exception>
#include <stdexcept>
#include <string>

#include "bio/tables/file_error.h"
#include "info/version.h"
#include "python_system.h"
#include "robots/robots.h"
#include "systems.h"

namespace python {
namespace {

/// As the program says it: one line.
std::string lineOf(const char* text) {
  std::string line;
  for (const char* c = text; *c != '\0'; ++c) {
    if (*c == '\n') {
      line += line.empty() || line.ends_with("; ") ? "" : "; ";
    } else if (*c != ' ' || !line.ends_with(' ')) {
      line += *c;
    }
  }
  while (line.ends_with(' ') || line.ends_with(';')) line.pop_back();
  return line;
}

/// Wrong use and bad files are ValueError, an object of another type is TypeError, all else
/// RuntimeError.
void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const py::error_already_set&) {
    throw;
  } catch (const py::cast_error& error) {
    PyErr_SetString(PyExc_TypeError, lineOf(error.what()).c_str());
  } catch (const py::builtin_exception&) {
    throw;
  } catch (const bio::FileError& error) {
    PyErr_SetString(PyExc_ValueError, lineOf(error.what()).c_str());
  } catch (const std::logic_error& error) {  // invalid_argument, domain_error, out_of_range
    PyErr_SetString(PyExc_ValueError, lineOf(error.what()).c_str());
  } catch (const std::runtime_error& error) {
    PyErr_SetString(PyExc_RuntimeError, lineOf(error.what()).c_str());
  }
}

}  // namespace
}  // namespace python

PYBIND11_MODULE(_fisherhill, module) {
  module.doc() = "The compiled part of the package fisherhill.";
  module.attr("__version__") = info::version();
  pybind11::register_exception_translator(&python::translate);
  python::defineSystems(module);
  python::defineEmg(module);
  python::definePaths(module);
  python::defineSensitivity(module);
  python::definePrediction(module);
  python::defineComparisons(module);
  python::defineEnsemble(module);
  python::defineCalibration(module);
  python::defineDiscovery(module);
  python::defineRobotDiscovery(module);
  python::defineRobotMotions(module);
  python::defineStringLength(module);
  python::defineStudies(module);
  python::defineDesign(module);
  python::defineDynamometer(module);
  python::defineSystem(module);
  python::defineEstimation(module);
}
