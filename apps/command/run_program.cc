#include "command/run_program.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>

#include "bio/model/nearest_name.h"
#include "bio/tables/unknown_column.h"
#include "command/command_line.h"
#include "info/parallel_for.h"
#include "output/interruption.h"
#include "output/standard_streams.h"
#include "output/text.h"

namespace app {
namespace {

constexpr int status(ExitStatus status) {
  return static_cast<int>(status);
}

int fail(const std::string& subcommand, const std::string& message) {
  const std::string who = subcommand.empty() ? "fisherhill" : "fisherhill " + subcommand;
  tell(fmt::format("{}: {}\n", who, oneLine(message)));
  return status(ExitStatus::badInput);
}

/// The result once the output has arrived: a full disk behind standard output is no success.
int printed(int result, const std::string& subcommand) {
  std::cout.flush();
  if (std::cout.good() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return result;
  return fail(subcommand, "standard output cannot be written");
}

/// The option or command most similar to the first unknown word, for the error message.
std::string meantBy(const CLI::App& app, const std::vector<std::string>& arguments) {
  std::vector<std::string> options, commands;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
  }
  for (const CLI::App* command : app.get_subcommands({})) commands.push_back(command->get_name());
  for (const std::string& argument : arguments) {
    const std::string word = argument.substr(0, argument.find('='));
    const bool isOption = word.starts_with("--");
    const auto& known = isOption ? options : commands;
    if (known.empty() || std::find(known.begin(), known.end(), word) != known.end()) continue;
    const std::string meant = bio::meantInstead(word, known);
    if (!meant.empty()) return word + meant;
  }
  return "";
}

CLI::App* parsedSubcommand(const CLI::App& program) {
  const auto parsed = program.get_subcommands();
  return parsed.empty() ? nullptr : parsed.front();
}

/// A check of the library names a quantity, "speeds: …": as the option of that name that was given.
std::string namedAsOption(const std::string& message, const CLI::App& options) {
  const std::string name = message.substr(0, message.find(": "));
  const bool isWord =
      !name.empty() && name.find_first_not_of("abcdefghijklmnopqrstuvwxyz-") == std::string::npos;
  const CLI::Option* option = isWord ? options.get_option_no_throw("--" + name) : nullptr;
  return option && option->count() > 0 ? "--" + message : message;
}

/// The message in words. One of the standard library, "stod" or "vector::_M_range_check: …", tells
/// a user nothing: that it could be thrown is a fault of the program.
std::string inWords(const std::string& message, const std::string& subcommand) {
  const auto begins = [&](const char* words) { return message.starts_with(words); };
  const bool isRaw = message.find(' ') == std::string::npos || begins("vector::") ||
                     begins("basic_string") || begins("map::") || begins("_Map_base::") ||
                     begins("array::") || begins("deque::") || begins("std::") ||
                     begins("[json.exception") || message == "bad optional access";
  if (!isRaw) return message;
  return fmt::format(
      "stopped by a fault of the program ({}); nothing was written. Please report it with the "
      "command line and the input of this {}",
      message.empty() ? "no message" : message, subcommand);
}

/// @param options  what the subcommand was parsed by
int runCommand(Command& command, const CommandContext& context, const CLI::App& options) {
  try {
    return status(command.run(context));
  } catch (const Interrupted&) {
    const bool kept = context.out && std::filesystem::exists(*context.out);
    tell(fmt::format(
        "fisherhill {}: interrupted; {}\n", context.subcommand,
        kept ? "finished parts are in " + context.out->string() : "nothing was written"));
    return status(ExitStatus::interrupted);
  } catch (const bio::UnknownColumn& error) {
    const bool canIgnore = options.get_option_no_throw("--ignore-extra") != nullptr;
    return fail(context.subcommand,
                error.what() + std::string(canIgnore ? " (--ignore-extra ignores them)" : ""));
  } catch (const std::bad_alloc&) {
    return fail(context.subcommand, "not enough memory");
  } catch (const std::exception& error) {
    return fail(context.subcommand,
                namedAsOption(inWords(error.what(), context.subcommand), options));
  } catch (...) {
    return fail(context.subcommand, "stopped by an unknown error");
  }
}

}  // namespace

int runProgram(const std::vector<std::string>& arguments,
               std::vector<std::unique_ptr<Command>> commands) {
  CommandLine line(std::move(commands));
  CommandLine::Chosen chosen;
  try {
    chosen = line.parse(arguments);
  } catch (const CLI::Success& request) {  // --help, --version
    return printed(line.program().exit(request), "");
  } catch (const CLI::ParseError& error) {
    const CLI::App* subcommand = parsedSubcommand(line.program());
    const std::string name = subcommand ? subcommand->get_name() : "";
    std::string what = oneLine(error.what());
    const std::vector<std::string> words(arguments.begin() + (arguments.empty() ? 0 : 1),
                                         arguments.end());
    const std::string meant = meantBy(subcommand ? *subcommand : line.program(), words);
    if (!meant.empty()) what += ": " + meant;
    return fail(name,
                fmt::format("{} (see fisherhill {}--help)", what, name.empty() ? "" : name + " "));
  } catch (const std::invalid_argument& error) {
    return fail(parsedSubcommand(line.program())->get_name(), error.what());
  }
  catchInterruption();
  const info::ThreadLimit limit(chosen.context->threads);
  return printed(runCommand(*chosen.command, *chosen.context, *parsedSubcommand(line.program())),
                 chosen.context->subcommand);
}

}  // namespace app
