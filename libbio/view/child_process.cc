#include "view/child_process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

namespace bio::view {
namespace {

/// Only calls that are safe between fork and exec.
[[noreturn]] void becomeChild(char* const* words, const std::vector<std::pair<int, int>>& open,
                              pid_t parent) {
  setsid();
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(127);
  struct sigaction standard = {};
  standard.sa_handler = SIG_DFL;
  for (const int signal : {SIGINT, SIGTERM, SIGPIPE}) sigaction(signal, &standard, nullptr);
  const int nothing = ::open("/dev/null", O_RDWR);
  for (int stream = 0; stream <= 2; ++stream) dup2(nothing, stream);
  for (const auto& [ours, theirs] : open) {
    if (ours == theirs) {
      fcntl(ours, F_SETFD, 0);  // dup2 onto itself would leave close-on-exec set
    } else if (dup2(ours, theirs) < 0) {
      _exit(127);
    }
  }
  execvp(words[0], words);
  _exit(127);
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& command,
                           const std::vector<std::pair<int, int>>& descriptors) {
  std::vector<char*> words;
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  const pid_t parent = getpid();
  id_ = fork();
  if (id_ < 0) throw std::runtime_error(command.front() + ": a new process cannot be created");
  if (id_ == 0) becomeChild(words.data(), descriptors, parent);
}

ChildProcess::~ChildProcess() {
  if (id_ < 0) return;
  // A display server removes its lock file when it is asked to end; killed, it could not.
  kill(id_, SIGTERM);
  for (int waited = 0; waited < 200; ++waited) {
    if (waitpid(id_, nullptr, WNOHANG) != 0) return;
    usleep(10'000);
  }
  kill(id_, SIGKILL);
  while (waitpid(id_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

int ChildProcess::wait() {
  if (id_ < 0) throw std::logic_error("this process has already ended");
  int state = 0;
  while (waitpid(id_, &state, 0) < 0 && errno == EINTR) {
  }
  id_ = -1;
  return WIFEXITED(state) ? WEXITSTATUS(state) : 128 + WTERMSIG(state);
}

std::optional<std::string> findProgram(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string file = (folder.empty() ? "." : folder) + "/" + name;
    if (access(file.c_str(), X_OK) == 0) return file;
  }
  return std::nullopt;
}

}  // namespace bio::view
