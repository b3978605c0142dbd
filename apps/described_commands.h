#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace app {

/// An option or argument as a reader of the command line needs to know it.
struct DescribedOption {
  /// What the value after the option is, for a shell that completes it.
  enum class Value { none, anything, choice, file, folder };

  std::vector<std::string> names;  ///< "--out", "-h"; of an argument its place, "MODEL"
  std::string placeholder;         ///< of the value: "DIR"; empty for a flag
  std::string description;
  std::string group;         ///< heading under which --help has it
  std::string defaultValue;  ///< empty: none, or told by the description
  Value value = Value::none;
  std::vector<std::string> choices;  ///< the only values there are, where there are few
  bool required = false;
  bool repeats = false;  ///< may stand, or take values, more than once
};

/// The program, or one of its subcommands.
struct DescribedCommand {
  std::string name, purpose, footer;
  std::vector<DescribedOption> arguments, options;  ///< in the order of --help
  std::vector<DescribedCommand> subcommands;
};

/// Reads a program's tree, so that man page and completions cannot forget anything. It is not
/// changed; CLI11 shows rules of values only to those who might.
DescribedCommand describe(CLI::App& app);

}  // namespace app
