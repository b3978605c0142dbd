#include "command_line.h"

#include <fmt/format.h>

#include "info/version.h"

namespace app {

CommandLine::CommandLine(std::vector<std::unique_ptr<Command>> commands)
    : program_("Simulate, identify and explain how muscles move limbs.", "fisherhill"),
      commands_(std::move(commands)),
      contexts_(commands_.size()) {
  program_.set_version_flag("--version", fmt::format("fisherhill {}", info::version()));
  program_.require_subcommand(1);
  program_.footer("\n`fisherhill SUBCOMMAND --help` shows its options and an example.");
  for (std::size_t i = 0; i < commands_.size(); ++i) {
    const Command::About about = commands_[i]->about();
    CLI::App* subcommand = program_.add_subcommand(about.name, about.purpose);
    subcommand->footer("\nExample:\n  " + about.example);
    commands_[i]->addOptions(*subcommand);
    contexts_[i].subcommand = about.name;
    addCommonOptions(*subcommand, contexts_[i]);
    subcommands_.push_back(subcommand);
  }
}

CommandLine::Chosen CommandLine::parse(const std::vector<std::string>& arguments) {
  for (CommandContext& context : contexts_) context.commandLine = arguments;
  std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
  if (!reversed.empty()) reversed.pop_back();
  program_.parse(reversed);
  for (std::size_t i = 0; i < commands_.size(); ++i) {
    if (subcommands_[i]->parsed()) return {commands_[i].get(), &contexts_[i]};
  }
  throw CLI::RequiredError("a subcommand");
}

}  // namespace app
