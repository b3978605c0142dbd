#include "command/command_line.h"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "command/common_options.h"
#include "info/version.h"
#include "report/figure_files.h"

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

namespace {

namespace fs = std::filesystem;

/// Every file that an option names, but for folders of results.
std::vector<fs::path> inputsNamed(const CLI::App& subcommand) {
  std::vector<fs::path> inputs;
  for (const CLI::Option* option : subcommand.get_options()) {
    if (option->check_lname("out") || option->check_lname("figures")) continue;
    for (const std::string& word : option->results()) {
      std::error_code failed;
      const fs::file_status status = fs::status(word, failed);
      if (failed || !fs::exists(status) || fs::is_directory(status)) continue;
      if (!fs::is_regular_file(status)) {
        throw std::invalid_argument(
            fmt::format("{}: is a {}, must be a regular file: it is read more than once", word,
                        fs::is_fifo(status) || fs::is_socket(status) ? "pipe" : "device"));
      }
      inputs.emplace_back(word);
    }
  }
  return inputs;
}

}  // namespace

CommandLine::Chosen CommandLine::parse(const std::vector<std::string>& arguments) {
  for (CommandContext& context : contexts_) context.commandLine = arguments;
  std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
  if (!reversed.empty()) reversed.pop_back();
  program_.parse(reversed);
  for (std::size_t i = 0; i < commands_.size(); ++i) {
    if (!subcommands_[i]->parsed()) continue;
    contexts_[i].inputs = inputsNamed(*subcommands_[i]);
    if (contexts_[i].figures) requireSvgConverter("--figures");
    return {commands_[i].get(), &contexts_[i]};
  }
  throw CLI::RequiredError("a subcommand");
}

}  // namespace app
