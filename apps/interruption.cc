#include "interruption.h"

#include <atomic>
#include <csignal>

namespace app {
namespace {

std::atomic<bool> requested = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may set it");

extern "C" void onInterruption(int signal) {
  requested = true;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void catchInterruption() {
  std::signal(SIGINT, onInterruption);
  std::signal(SIGTERM, onInterruption);
}

bool interruptionRequested() {
  return requested;
}

void stopIfInterrupted() {
  if (interruptionRequested()) throw Interrupted{};
}

}  // namespace app
