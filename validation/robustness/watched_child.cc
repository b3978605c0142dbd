#include "watched_child.h"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <fstream>
#include <stdexcept>

namespace robustness {
namespace {

long addressSpace_KiB() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmSize:")) return std::stol(line.substr(7));
  }
  return 0;
}

// The child's side: one answer a line.
[[noreturn]] void answer(int pipe, long first, long count,
                         const std::function<std::string(long)>& work, long limit_MiB) {
  const auto most = static_cast<rlim_t>((addressSpace_KiB() + 1024 * limit_MiB) * 1024);
  const rlimit limit = {most, most}, none = {0, 0};
  setrlimit(RLIMIT_AS, &limit);
  setrlimit(RLIMIT_CORE, &none);
  for (long i = first; i < count; ++i) {
    const std::string line = work(i) + "\n";
    if (::write(pipe, line.data(), line.size()) != static_cast<ssize_t>(line.size())) ::_exit(1);
  }
  ::_exit(0);
}

}  // namespace

void runWatched(long count, const std::function<std::string(long)>& work,
                const std::function<void(long, const WatchedEnd&)>& ended, int limit_s,
                long limit_MiB) {
  for (long next = 0; next < count;) {
    int ends[2];
    if (::pipe(ends) != 0) throw std::runtime_error("no pipe");
    const pid_t child = ::fork();
    if (child < 0) throw std::runtime_error("no child process");
    if (child == 0) {
      ::close(ends[0]);
      answer(ends[1], next, count, work, limit_MiB);
    }
    ::close(ends[1]);
    bool late = false;
    for (std::string text; !late;) {
      pollfd waiting = {ends[0], POLLIN, 0};
      late = ::poll(&waiting, 1, 1000 * limit_s) == 0;
      if (late) break;
      char piece[4096];
      const ssize_t size = ::read(ends[0], piece, sizeof piece);
      if (size <= 0) break;
      text.append(piece, static_cast<std::size_t>(size));
      for (auto end = text.find('\n'); end != text.npos; end = text.find('\n')) {
        ended(next++, {true, text.substr(0, end)});
        text.erase(0, end + 1);
      }
    }
    if (late) ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    ::close(ends[0]);
    if (next == count) return;
    ended(next++,
          {false, late                  ? fmt::format("no answer within {} s", limit_s)
                  : WIFSIGNALED(status) ? fmt::format("ended by signal {} ({})", WTERMSIG(status),
                                                      ::strsignal(WTERMSIG(status)))
                                        : fmt::format("left with status {}", WEXITSTATUS(status))});
  }
}

}  // namespace robustness
