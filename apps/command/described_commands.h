#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace app {

/// An option or argument, described for man page and completions.
struct DescribedOption {
  /// Kind of the option's value, for completion by a shell.
  enum class Value { none, anything, choice, file, folder };

  std::vector<std::string> names;  ///< "--out", "-h"; for an argument its placeholder, "MODEL"
  std::string placeholder;         ///< of the value: "DIR"; empty for a flag
  std::string description;
  std::string group;         ///< heading in --help
  std::string defaultValue;  ///< empty: none, or given in the description
  Value value = Value::none;
  std::vector<std::string> choices;  ///< the permitted values, if they are few
  bool required = false;
  bool repeats = false;  ///< may be repeated
};

/// The program, or one of its subcommands.
struct DescribedCommand {
  std::string name, purpose, footer;
  std::vector<DescribedOption> arguments, options;  ///< in the order of --help
  std::vector<DescribedCommand> subcommands;
};

/// Describes all commands of a program, so that man page and completions are complete. The program
/// is not changed; it is passed by non-const reference only because CLI11 requires this to read the
/// rules of values.
DescribedCommand describe(CLI::App& app);

}  // namespace app
