#pragma once

#include <atomic>
#include <functional>

namespace python {

/// Does work that needs no Python on another thread, without the interpreter's lock, and asks for
/// Ctrl-C meanwhile. The work ends early when `goOn` becomes false; what it then returns is dropped
/// and KeyboardInterrupt is raised.
/// @throws what the work throws; py::error_already_set after Ctrl-C
void interruptible(const std::function<void(const std::atomic<bool>& goOn)>& work);

}  // namespace python
