#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace app {

/// The program's exit status.
enum class ExitStatus {
  done = 0,
  answerIsNo = 1,     ///< it ran, but a check failed or there is no solution
  badInput = 2,       ///< wrong use or bad input, explained in one line
  interrupted = 130,  ///< Ctrl-C; finished parts are kept
};

/// How a subcommand was called, and the options that all subcommands share.
struct CommandContext {
  std::string subcommand;
  std::vector<std::string> commandLine;       ///< as typed, program name first
  std::vector<std::filesystem::path> inputs;  ///< files named by options; never overwritten
  std::optional<std::filesystem::path> out;   ///< folder for results; without it nothing is written
  std::optional<std::filesystem::path> figures;  ///< folder for figures as files of their own
  bool force = false;                            ///< overwrite an existing result
  bool json = false;                             ///< print only the summary on standard output
  std::uint64_t seed = 1;                        ///< same seed, same bits
  int threads = 1;                               ///< ≥ 1
  bool quiet = false;                            ///< part of another command: prints errors only
};

}  // namespace app
