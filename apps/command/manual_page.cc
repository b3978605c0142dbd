#include "command/manual_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "output/text.h"

namespace app {
namespace {

/// Text as roff prints it: a minus that can be copied, backslashes kept, no line that looks like a
/// request.
std::string roff(const std::string& text) {
  std::string out;
  bool lineBegins = true;
  for (const char c : text) {
    if (lineBegins && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else {
      out += c;
    }
    if (c == ',') out += "\\:";  // a long list may be broken here
    lineBegins = c == '\n';
  }
  return out;
}

std::string bold(const std::string& text) {
  return "\\fB" + roff(text) + "\\fR";
}

std::string italic(const std::string& text) {
  return "\\fI" + roff(text) + "\\fR";
}

/// A placeholder in italics; words to be typed as they are in bold.
std::string valueOf(const DescribedOption& option) {
  return option.choices.empty() ? italic(option.placeholder)
                                : bold(CLI::detail::join(option.choices, "|"));
}

std::string signature(const DescribedOption& option) {
  std::string text;
  for (const std::string& name : option.names) text += (text.empty() ? "" : ", ") + bold(name);
  if (option.value != DescribedOption::Value::none && option.names.front().starts_with("-")) {
    text += " " + valueOf(option);
  }
  return text;
}

std::string entry(const DescribedOption& option) {
  std::string text = ".TP\n" + signature(option) + "\n" + roff(option.description);
  if (!option.choices.empty() && !option.names.front().starts_with("-")) {
    text += "; one of " + bold(CLI::detail::join(option.choices, ", "));
  }
  if (!option.defaultValue.empty()) text += "; default " + roff(option.defaultValue);
  if (option.required && option.names.front().starts_with("-")) text += "; required";
  return text + "\n";
}

bool sameOption(const DescribedOption& a, const DescribedOption& b) {
  return a.names == b.names && a.description == b.description && a.placeholder == b.placeholder;
}

bool isShared(const DescribedCommand& program, const DescribedOption& option) {
  return std::all_of(
      program.subcommands.begin(), program.subcommands.end(), [&](const auto& subcommand) {
        return std::any_of(subcommand.options.begin(), subcommand.options.end(),
                           [&](const auto& other) { return sameOption(option, other); });
      });
}

std::string synopsis(const DescribedCommand& command, const std::string& name = "fisherhill") {
  std::string text = bold(name + " " + command.name);
  for (const DescribedOption& argument : command.arguments) {
    const std::string shown = italic(argument.names.front()) + (argument.repeats ? "..." : "");
    text += " " + (argument.required ? shown : "[" + shown + "]");
  }
  for (const DescribedOption& option : command.options) {
    if (option.required) text += " " + signature(option);
  }
  return text + " [" + italic("options") + "]";
}

std::string withoutPeriod(const std::string& sentence) {
  return sentence.ends_with('.') ? sentence.substr(0, sentence.size() - 1) : sentence;
}

/// "\nExample:\n  fisherhill …" of the footer as a literal block.
std::string exampleBlock(const std::string& footer) {
  const std::string example = CLI::detail::trim_copy(footer);
  const std::size_t lineEnd = example.find('\n');
  if (lineEnd == example.npos) return "";
  return ".PP\n" + roff(example.substr(0, lineEnd)) + "\n.PP\n.RS 4\n.nf\n" +
         roff(CLI::detail::trim_copy(example.substr(lineEnd))) + "\n.fi\n.RE\n";
}

std::string subcommandSection(const DescribedCommand& program, const DescribedCommand& command) {
  std::string text = fmt::format(".SS {}\n{}\n.PP\n{}.\n", roff(command.name), synopsis(command),
                                 roff(withoutPeriod(command.purpose)));
  for (const DescribedOption& argument : command.arguments) text += entry(argument);
  // each group once, wherever its options stand; those of none come first, without a heading
  std::vector<std::pair<std::string, std::string>> groups = {{"Options", ""}};
  for (const DescribedOption& option : command.options) {
    if (isShared(program, option)) continue;
    auto group = std::find_if(groups.begin(), groups.end(),
                              [&](const auto& named) { return named.first == option.group; });
    if (group == groups.end()) {
      group = groups.insert(group, {option.group, ".PP\n" + italic(option.group) + "\n"});
    }
    group->second += entry(option);
  }
  for (const auto& [name, entries] : groups) text += entries;
  return text + exampleBlock(command.footer);
}

std::string beginning(const std::string& name, const std::string& version,
                      const std::string& purpose) {
  std::string capital = name;
  for (char& c : capital) c = static_cast<char>(std::toupper(c));
  return fmt::format(
      ".TH {} 1 \"\" \"FisherHill {}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n",
      roff(capital), roff(version), roff(name),
      roff(static_cast<char>(std::tolower(purpose[0])) + purpose.substr(1)));
}

const char* const exitStatus =
    ".SH EXIT STATUS\n.TP\n0\ndone\n.TP\n1\nthe program ran, but the answer is \\(lqno\\(rq: a "
    "check found an error, a simulation has no solution\n.TP\n2\nwrong use or bad input, explained "
    "in one line on standard error\n.TP\n130\nstopped by Ctrl\\-C; finished parts are kept\n";

}  // namespace

std::string helperPage(const DescribedCommand& program, const std::string& version,
                       const std::string& name, const std::string& command, const std::string& when,
                       const std::string& before) {
  const auto at = std::find_if(program.subcommands.begin(), program.subcommands.end(),
                               [&](const DescribedCommand& one) { return one.name == command; });
  if (at == program.subcommands.end()) {
    throw std::invalid_argument(fmt::format("man page of {}: no subcommand {}", name, command));
  }
  std::string text = beginning(name, version, withoutPeriod(at->purpose));
  if (!before.empty()) text += bold(before) + " ";
  text += synopsis(*at, name) + "\n.SH DESCRIPTION\n" + roff(when) +
          " It takes the same arguments and is seldom started by hand.\n.SH OPTIONS\n";
  for (const DescribedOption& argument : at->arguments) text += entry(argument);
  for (const DescribedOption& option : at->options) text += entry(option);
  return text + exitStatus + ".SH SEE ALSO\n.BR fisherhill (1)\n";
}

std::string manualPage(const DescribedCommand& program, const std::string& version) {
  std::string text = beginning("fisherhill", version, withoutPeriod(program.purpose));
  for (const DescribedCommand& command : program.subcommands) {
    text += synopsis(command) + "\n.br\n";
  }
  for (const DescribedOption& option : program.options) {
    text += bold("fisherhill") + " " + signature(option) + "\n.br\n";
  }
  text +=
      ".SH DESCRIPTION\nReads a musculoskeletal model (OpenSim's .osim; robots in URDF or MJCF) "
      "and recorded muscle excitations, predicts how the limb moves, and determines what the "
      "measured motion says about the model. Everything is in SI units and radians; angles on the "
      "command line are "
      "degrees when they end in \\(lqdeg\\(rq.\n.SH SUBCOMMANDS\n";
  for (const DescribedCommand& command : program.subcommands) {
    text += subcommandSection(program, command);
  }
  text += ".SH COMMON OPTIONS\nAll subcommands have these options.\n";
  if (!program.subcommands.empty()) {
    for (const DescribedOption& option : program.subcommands.front().options) {
      if (isShared(program, option)) text += entry(option);
    }
  }
  text += ".SH OPTIONS\nOptions of the program itself.\n";
  for (const DescribedOption& option : program.options) text += entry(option);
  text += exitStatus;
  text +=
      ".SH FILES\n.TP\n.I summary.json, report.html\nin the folder that \\fB\\-\\-out\\fR names, "
      "beside the subcommand's own files; they appear all together when a run succeeds\n";
  return text;
}

}  // namespace app
