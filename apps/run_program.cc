#include "run_program.h"

#include <fmt/format.h>

#include <exception>
#include <filesystem>
#include <new>

#include "info/version.h"
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
  CLI::App program("Simulate, identify and explain how muscles move limbs.", "fisherhill");
  program.set_version_flag("--version", fmt::format("fisherhill {}", info::version()));
  program.require_subcommand(1);
  program.footer("\n`fisherhill SUBCOMMAND --help` shows its options and an example.");

  std::vector<CommandContext> contexts(commands.size());
  std::vector<CLI::App*> subcommands;
  for (std::size_t i = 0; i < commands.size(); ++i) {
    const Command::About about = commands[i]->about();
    CLI::App* subcommand = program.add_subcommand(about.name, about.purpose);
    subcommand->footer("\nExample:\n  " + about.example);
    commands[i]->addOptions(*subcommand);
    contexts[i].subcommand = about.name;
    contexts[i].commandLine = arguments;
    addCommonOptions(*subcommand, contexts[i]);
    subcommands.push_back(subcommand);
  }

  try {
    std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
    if (!reversed.empty()) reversed.pop_back();
    program.parse(reversed);
  } catch (const CLI::Success& request) {  // --help, --version
    return program.exit(request);
  } catch (const CLI::ParseError& error) {
    const CLI::App* subcommand = parsedSubcommand(program);
    const std::string name = subcommand ? subcommand->get_name() : "";
    return fail(name, fmt::format("{} (see fisherhill {}--help)", oneLine(error.what()),
                                  name.empty() ? "" : name + " "));
  }

  catchInterruption();
  for (std::size_t i = 0; i < commands.size(); ++i) {
    if (subcommands[i]->parsed()) return runCommand(*commands[i], contexts[i]);
  }
  return fail("", "no subcommand was given");
}

}  // namespace app
