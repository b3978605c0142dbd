#pragma once

#include <atomic>
#include <functional>

#include "namespace.h"

namespace python {

/// Does work that needs no Python on another thread, without the interpreter's lock, and asks for
/// Ctrl-C meanwhile. The work ends early when `goOn` becomes false; what it then returns is dropped
/// and KeyboardInterrupt is raised.
/// @throws what the work throws; py::error_already_set after Ctrl-C
void interruptible(const std::function<void(const std::atomic<bool>& goOn)>& work);

/// The argument `progress` of a function of that name: None, False, True (a bar of tqdm) or what is
/// called with the fraction of the work done.
struct Progress {
  py::object asked;
  const char* name;
};

/// As above, and its progress is told from the calling thread, whenever `done` (0 to 1) has grown
/// and at the end; what the callback raises ends the work.
/// @throws as above; py::type_error for another argument, ImportError of Python without tqdm
void interruptible(
    const Progress& progress,
    const std::function<void(const std::atomic<bool>& goOn, std::atomic<double>& done)>& work);

/// A callback as most computations take it: notes the fraction done, and whether to go on.
inline auto noting(const std::atomic<bool>& goOn, std::atomic<double>& done) {
  return [&goOn, &done](double fraction) {
    done = fraction;
    return goOn.load();
  };
}

}  // namespace python
