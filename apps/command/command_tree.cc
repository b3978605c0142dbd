#include "command/command_tree.h"

namespace app {

using nlohmann::ordered_json;

namespace {

ordered_json optionTree(const DescribedOption& option) {
  return {{"names", option.names},
          {"value", option.placeholder},
          {"description", option.description},
          {"group", option.group},
          {"default", option.defaultValue},
          {"choices", option.choices},
          {"required", option.required},
          {"repeats", option.repeats}};
}

ordered_json optionTrees(const std::vector<DescribedOption>& options) {
  ordered_json all = ordered_json::array();
  for (const DescribedOption& option : options) all.push_back(optionTree(option));
  return all;
}

}  // namespace

ordered_json commandTree(const DescribedCommand& command) {
  ordered_json subcommands = ordered_json::array();
  for (const DescribedCommand& one : command.subcommands) subcommands.push_back(commandTree(one));
  return {{"name", command.name},
          {"purpose", command.purpose},
          {"example", CLI::detail::trim_copy(command.footer)},
          {"arguments", optionTrees(command.arguments)},
          {"options", optionTrees(command.options)},
          {"subcommands", subcommands}};
}

}  // namespace app
