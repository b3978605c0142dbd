#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "command/command.h"

namespace app {

/// The program's command line: every subcommand with its own options and the common ones, in
/// CLI11's tree. --help, the man page and the completions are generated from it.
class CommandLine {
 public:
  explicit CommandLine(std::vector<std::unique_ptr<Command>> commands);
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  CLI::App& program() { return program_; }
  const CLI::App& program() const { return program_; }

  /// The command named by the words that were parsed.
  struct Chosen {
    Command* command;
    const CommandContext* context;  ///< its `inputs` are the files that options name
  };
  /// Reads the words after the program's name; --help and --version are thrown as CLI::Success.
  /// @param arguments as given to main, program name first
  /// @throws CLI::ParseError, std::invalid_argument for an input that is a pipe or a device
  Chosen parse(const std::vector<std::string>& arguments);

 private:
  CLI::App program_;
  std::vector<std::unique_ptr<Command>> commands_;
  std::vector<CommandContext> contexts_;  ///< one per command; options point into them
  std::vector<CLI::App*> subcommands_;
};

}  // namespace app
