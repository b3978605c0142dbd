#include "command/completion.h"

#include <fmt/format.h>

#include "output/text.h"

namespace app {
namespace {

using Value = DescribedOption::Value;

std::string words(const std::vector<std::string>& list) {
  return CLI::detail::join(list, " ");
}

std::vector<std::string> namesOf(const std::vector<DescribedOption>& options) {
  std::vector<std::string> names;
  for (const DescribedOption& option : options) {
    names.insert(names.end(), option.names.begin(), option.names.end());
  }
  return names;
}

/// Choices where no option is being typed: words of arguments, and files.
std::string argumentChoices(const DescribedCommand& command) {
  std::vector<std::string> choices;
  for (const DescribedOption& argument : command.arguments) {
    choices.insert(choices.end(), argument.choices.begin(), argument.choices.end());
  }
  return words(choices);
}

bool takesFiles(const DescribedCommand& command) {
  for (const DescribedOption& argument : command.arguments) {
    if (argument.value == Value::file) return true;
  }
  return false;
}

/// The case lines that say how a value is completed.
std::string bashValueCases(const DescribedCommand& command) {
  std::string text;
  for (const DescribedOption& option : command.options) {
    if (option.value == Value::none) continue;
    for (const std::string& name : option.names) {
      const char* action = option.value == Value::file     ? "kind=file"
                           : option.value == Value::folder ? "kind=folder"
                           : option.value == Value::choice ? "kind=words"
                                                           : "kind=nothing";
      text += fmt::format("    '{} {}') {} values='{}' ;;\n", command.name, name, action,
                          words(option.choices));
    }
  }
  return text;
}

/// Inside a zsh argument specification: its brackets, colons and quotes are not ours.
std::string zshText(const std::string& text) {
  std::string out;
  for (const char c : oneLine(text)) {
    if (c == '\'') {
      out += "'\\''";
      continue;
    }
    if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

std::string zshAction(const DescribedOption& option) {
  switch (option.value) {
    case Value::choice:
      return "(" + words(option.choices) + ")";
    case Value::file:
      return "_files";
    case Value::folder:
      return "_files -/";
    case Value::none:
    case Value::anything:
      break;
  }
  return " ";
}

std::string zshOption(const DescribedOption& option) {
  std::string text;
  for (const std::string& name : option.names) {
    text += fmt::format("        '{}{}{}[{}]", option.repeats ? "*" : "", name,
                        option.value == Value::none || !name.starts_with("--") ? "" : "=",
                        zshText(option.description));
    if (option.value != Value::none) {
      text += fmt::format(":{}:{}", zshText(option.placeholder), zshAction(option));
    }
    text += "' \\\n";
  }
  return text;
}

std::string zshArguments(const DescribedCommand& command) {
  std::string text;
  for (const DescribedOption& option : command.options) text += zshOption(option);
  for (const DescribedOption& argument : command.arguments) {
    text += fmt::format("        '{}:{}:{}' \\\n", argument.repeats ? "*" : "",
                        zshText(argument.names.front()), zshAction(argument));
  }
  return text;
}

}  // namespace

std::string bashCompletion(const DescribedCommand& program) {
  std::vector<std::string> subcommands;
  std::string options, values, arguments;
  for (const DescribedCommand& command : program.subcommands) {
    subcommands.push_back(command.name);
    options +=
        fmt::format("    {}) options='{}' ;;\n", command.name, words(namesOf(command.options)));
    values += bashValueCases(command);
    arguments += fmt::format("      {}) kind={} values='{}' ;;\n", command.name,
                             takesFiles(command) ? "file" : "words", argumentChoices(command));
  }
  const std::string top = words(subcommands) + " " + words(namesOf(program.options));
  return "# bash completion for fisherhill; written by describe_commands, do not edit\n"
         "_fisherhill() {\n"
         "  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]}\n"
         "  local command= word options= kind= values=\n"
         "  COMPREPLY=()\n"
         "  # bash cuts --name=value at the equals sign\n"
         "  if [[ $current == = ]]; then\n"
         "    current=\n"
         "  elif [[ $previous == = ]]; then\n"
         "    previous=${COMP_WORDS[COMP_CWORD-2]}\n"
         "  fi\n"
         "  for word in \"${COMP_WORDS[@]:1:COMP_CWORD-1}\"; do\n"
         "    if [[ $word != -* ]]; then command=$word; break; fi\n"
         "  done\n"
         "  case $command in\n" +
         options +
         "    *)\n"
         "      COMPREPLY=($(compgen -W '" +
         top +
         "' -- \"$current\"))\n"
         "      return ;;\n"
         "  esac\n"
         "  case \"$command $previous\" in\n" +
         values + "    *) case $command in\n" + arguments +
         "    esac\n"
         "    if [[ $current == -* ]]; then kind=words values=$options; fi ;;\n"
         "  esac\n"
         "  [[ $kind == nothing ]] || COMPREPLY=($(compgen -W \"$values\" -- \"$current\"))\n"
         "  if [[ $kind == file || $kind == folder ]]; then\n"
         "    local IFS=$'\\n'\n"
         "    compopt -o filenames 2>/dev/null\n"
         "    [[ $kind == file ]] && COMPREPLY+=($(compgen -f -- \"$current\"))\n"
         "    [[ $kind == folder ]] && COMPREPLY+=($(compgen -d -- \"$current\"))\n"
         "  fi\n"
         "  return 0\n"
         "}\n"
         "complete -F _fisherhill fisherhill\n";
}

std::string zshCompletion(const DescribedCommand& program) {
  std::string names, cases;
  for (const DescribedCommand& command : program.subcommands) {
    names += fmt::format("    '{}:{}'\n", command.name, zshText(command.purpose));
    cases += fmt::format("    {})\n      _arguments -s \\\n{}        && return ;;\n", command.name,
                         zshArguments(command));
  }
  std::string options;
  for (const DescribedOption& option : program.options) options += zshOption(option);
  return "#compdef fisherhill\n"
         "# written by describe_commands, do not edit\n"
         "_fisherhill() {\n"
         "  local context state state_descr line\n"
         "  typeset -A opt_args\n"
         "  local -a subcommands\n"
         "  subcommands=(\n" +
         names +
         "  )\n"
         "  _arguments -C \\\n" +
         options +
         "        '1:subcommand:->subcommand' \\\n"
         "        '*::argument:->argument' && return\n"
         "  if [[ $state == subcommand ]]; then\n"
         "    _describe -t subcommands subcommand subcommands\n"
         "    return\n"
         "  fi\n"
         "  case $words[1] in\n" +
         cases +
         "  esac\n"
         "}\n"
         "_fisherhill \"$@\"\n";
}

}  // namespace app
