#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace support {

/// What a finished program left.
struct ProgramResult {
  int status = -1;     ///< exit status, or 128 + the signal that ended it
  std::string out;     ///< standard output
  std::string err;     ///< standard error
  double seconds = 0;  ///< from its start to its end
};

/// Runs a program without a shell, standard input closed, and waits for it.
/// @param folder working directory
/// @throws std::runtime_error if it cannot be started
ProgramResult runProgram(const std::vector<std::string>& command,
                         const std::filesystem::path& folder = std::filesystem::current_path());

/// The same for the built `fisherhill`, in the top folder of the source tree.
ProgramResult runFisherHill(std::vector<std::string> arguments);

}  // namespace support
