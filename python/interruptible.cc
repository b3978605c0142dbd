#include "interruptible.h"

#include <pybind11/pybind11.h>

#include <chrono>
#include <exception>
#include <future>

namespace python {

namespace {

/// @param meanwhile  called every few milliseconds with the interpreter's lock
void supervise(const std::function<void(const std::atomic<bool>&)>& work,
               const std::function<void()>& meanwhile) {
  std::atomic<bool> goOn = true;
  std::exception_ptr stopped;  // by Python
  {
    const py::gil_scoped_release unlocked;
    auto worker = std::async(std::launch::async, [&] { work(goOn); });
    while (worker.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready) {
      if (stopped) continue;
      const py::gil_scoped_acquire locked;
      try {
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        meanwhile();
      } catch (...) {
        stopped = std::current_exception();
        goOn = false;
      }
    }
    if (!stopped) worker.get();
  }
  if (stopped) std::rethrow_exception(stopped);
}

/// Who is told; closed at the end, whatever happens.
class Listener {
 public:
  explicit Listener(const Progress& progress)
      : told_(py::module_::import("fisherhill._progress")
                  .attr("listener")(progress.asked, progress.name)) {}
  ~Listener() {
    try {
      if (!told_.is_none()) told_.attr("close")();
    } catch (const py::error_already_set&) {
      // a bar that cannot be closed is no error of the computation
    }
  }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  void tell(double fraction) {
    if (told_.is_none() || fraction <= last_) return;
    last_ = fraction;
    told_(fraction);
  }

 private:
  py::object told_;
  double last_ = 0;
};

}  // namespace

void interruptible(const std::function<void(const std::atomic<bool>&)>& work) {
  supervise(work, [] {});
}

void interruptible(
    const Progress& progress,
    const std::function<void(const std::atomic<bool>&, std::atomic<double>&)>& work) {
  Listener listener(progress);
  std::atomic<double> done = 0;
  supervise([&](const std::atomic<bool>& goOn) { work(goOn, done); },
            [&] { listener.tell(std::min(done.load(), 1.0)); });
  listener.tell(1);
}

}  // namespace python
