#pragma once

#include <atomic>

#include "namespace.h"
#include "robots/robot_work.h"

/// The robots of libinfo/robots.
namespace python {

/// Ends the work when `goOn`, which must outlive it, becomes false; interruptible() drops the
/// exception.
info::robot::WorkProgress whileTrue(const std::atomic<bool>& goOn);

void defineRobotDiscovery(py::module_& module);
void defineRobotMotions(py::module_& module);
void defineStringLength(py::module_& module);

}  // namespace python
