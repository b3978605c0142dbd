#include "support/run_program.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <stdexcept>

#include "support/scratch_folder.h"

namespace support {

ProgramResult runProgram(const std::vector<std::string>& command,
                         const std::filesystem::path& folder) {
  const ScratchFolder scratch;
  const std::string outFile = (scratch / "out").string();
  const std::string errFile = (scratch / "err").string();
  std::vector<char*> words;
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);

  const auto begin = std::chrono::steady_clock::now();
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) {
    const auto redirect = [](const char* file, int flags, int descriptor) {
      if (dup2(open(file, flags, 0600), descriptor) < 0) _exit(127);
    };
    redirect("/dev/null", O_RDONLY, STDIN_FILENO);
    redirect(outFile.c_str(), O_WRONLY | O_CREAT, STDOUT_FILENO);
    redirect(errFile.c_str(), O_WRONLY | O_CREAT, STDERR_FILENO);
    if (chdir(folder.c_str()) != 0) _exit(127);
    execvp(words.front(), words.data());
    _exit(127);
  }
  int state = 0;
  if (waitpid(child, &state, 0) != child) throw std::runtime_error("waitpid failed");
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  const int status = WIFEXITED(state) ? WEXITSTATUS(state) : 128 + WTERMSIG(state);
  if (status == 127) throw std::runtime_error(command.front() + " could not be started");
  return {status, contentOf(outFile), contentOf(errFile), taken.count()};
}

ProgramResult runFisherHill(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), FISHERHILL_PROGRAM);
  return runProgram(arguments, FISHERHILL_SOURCE_DIR);
}

}  // namespace support
