#pragma once

#include "namespace.h"

/// The robots of libinfo/robots.
namespace python {

void defineRobotDiscovery(py::module_& module);
void defineRobotMotions(py::module_& module);
void defineStringLength(py::module_& module);

}  // namespace python
