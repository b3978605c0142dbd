#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "output/command_context.h"

namespace app {

/// One subcommand. Its options are its members, so that they live as long as it does.
class Command {
 public:
  struct About {
    std::string name;
    std::string purpose;  ///< one line
    std::string example;  ///< a command line that works from the top of the source tree
  };

  virtual ~Command() = default;
  virtual About about() const = 0;
  virtual void addOptions(CLI::App& options) = 0;

  /// Runs the subcommand. Bad input is thrown as an exception with a one-line message; a negative
  /// answer is returned as ExitStatus::answerIsNo.
  virtual ExitStatus run(const CommandContext& context) = 0;
};

}  // namespace app
