#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace bio::view {

/// A program that runs beside this one and never outlives it: it is ended by the destructor, and by
/// the kernel if this program is killed. Ctrl-C in the terminal does not reach it.
class ChildProcess {
 public:
  /// @param command    program, looked for in PATH, and its arguments
  /// @param descriptors  pairs (ours, the child's number for it); its standard streams are
  ///   /dev/null unless named here
  /// @throws std::runtime_error if no process can be made; a program that cannot be started ends
  ///   with status 127
  ChildProcess(const std::vector<std::string>& command,
               const std::vector<std::pair<int, int>>& descriptors);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t id() const { return id_; }

  /// Waits until it ends by itself: exit status, or 128 + the signal that ended it.
  int wait();

 private:
  pid_t id_ = -1;  ///< −1: has ended
};

/// Full name of a program in PATH.
std::optional<std::string> findProgram(const std::string& name);

}  // namespace bio::view
