#include "output/interruption.h"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <string_view>

namespace app {
namespace {

std::atomic<bool> requested = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may set it");

constexpr unsigned patience = 3;  ///< [s] that an orderly end may take

extern "C" void onInterruption(int signal) {
  requested = true;
  std::signal(signal, SIG_DFL);
  alarm(patience);
}

extern "C" void onImpatience(int) {
  constexpr std::string_view words =
      "fisherhill: interrupted during work that cannot be stopped halfway\n";
  [[maybe_unused]] const ssize_t told = write(STDERR_FILENO, words.data(), words.size());
  _exit(130);
}

}  // namespace

void catchInterruption() {
  std::signal(SIGALRM, onImpatience);
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
