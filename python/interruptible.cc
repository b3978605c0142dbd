#include "interruptible.h"

#include <pybind11/pybind11.h>

#include <chrono>
#include <future>

namespace python {

namespace py = pybind11;

void interruptible(const std::function<void(const std::atomic<bool>&)>& work) {
  std::atomic<bool> goOn = true;
  bool interrupted = false;
  {
    const py::gil_scoped_release unlocked;
    auto worker = std::async(std::launch::async, [&] { work(goOn); });
    while (worker.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready) {
      const py::gil_scoped_acquire locked;
      if (!interrupted && PyErr_CheckSignals() != 0) {
        interrupted = true;
        goOn = false;
        PyErr_Clear();
      }
    }
    if (!interrupted) worker.get();
  }
  if (!interrupted) return;
  PyErr_SetNone(PyExc_KeyboardInterrupt);
  throw py::error_already_set();
}

}  // namespace python
