#include "run_program.h"

#include <fmt/format.h>

#include <exception>
#include <filesystem>
#include <new>

#include "command_line.h"
#include "interruption.h"
#include "text.h"

namespace app {
namespace {

constexpr int status(ExitStatus status) {
  return static_cast<int>(status);
}

int fail(const std::string& subcommand, const std::string& message) {
  const std::string who = subcommand.empty() ? "fisherhill" : "fisherhill " + subcommand;
  fmt::print(stderr, "{}: {}\n", who, oneLine(message));
  return status(ExitStatus::badInput);
}

CLI::App* parsedSubcommand(const CLI::App& program) {
  const auto parsed = program.get_subcommands();
  return parsed.empty() ? nullptr : parsed.front();
}

int runCommand(Command& command, const CommandContext& context) {
  try {
    return status(command.run(context));
  } catch (const Interrupted&) {
    const bool kept = context.out && std::filesystem::exists(*context.out);
    fmt::print(stderr, "fisherhill {}: interrupted; {}\n", context.subcommand,
               kept ? "finished parts are in " + context.out->string() : "nothing was written");
    return status(ExitStatus::interrupted);
  } catch (const std::bad_alloc&) {
    return fail(context.subcommand, "not enough memory");
  } catch (const std::exception& error) {
    return fail(context.subcommand, error.what());
  } catch (...) {
    return fail(context.subcommand, "stopped by an error of unknown kind");
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
    return line.program().exit(request);
  } catch (const CLI::ParseError& error) {
    const CLI::App* subcommand = parsedSubcommand(line.program());
    const std::string name = subcommand ? subcommand->get_name() : "";
    return fail(name, fmt::format("{} (see fisherhill {}--help)", oneLine(error.what()),
                                  name.empty() ? "" : name + " "));
  }
  catchInterruption();
  return runCommand(*chosen.command, *chosen.context);
}

}  // namespace app
