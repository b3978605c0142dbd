#include "command/described_commands.h"

namespace app {
namespace {

using Value = DescribedOption::Value;

/// The rules of a value in CLI11's words: "{a,b}", "FILE", "POSITIVE".
std::vector<std::string> rulesOf(CLI::Option& option) {
  std::vector<std::string> rules;
  try {
    for (int i = 0;; ++i) rules.push_back(option.get_validator(i)->get_description());
  } catch (const CLI::OptionNotFound&) {  // behind the last one
  }
  return rules;
}

/// The type's name, behind which CLI11 puts ":rule" for every rule.
std::string placeholderOf(const CLI::Option& option, const std::vector<std::string>& rules) {
  std::string type = option.get_type_name();
  for (auto rule = rules.rbegin(); rule != rules.rend(); ++rule) {
    if (!rule->empty() && type.ends_with(":" + *rule)) type.resize(type.size() - rule->size() - 1);
  }
  return type;
}

void describeValue(CLI::Option& option, DescribedOption& one) {
  if (option.get_items_expected_max() == 0) return;
  const std::vector<std::string> rules = rulesOf(option);
  one.placeholder = placeholderOf(option, rules);
  one.value = Value::anything;
  if (one.placeholder == "DIR") one.value = Value::folder;
  for (const std::string& rule : rules) {
    if (rule == "FILE") one.value = Value::file;
    if (rule == "DIR") one.value = Value::folder;
    if (!rule.starts_with('{')) continue;
    one.value = Value::choice;
    one.choices = CLI::detail::split(rule.substr(1, rule.size() - 2), ',');
  }
}

/// CLI11 writes a list as "[a,b]".
std::string withoutBrackets(const std::string& text) {
  return text.starts_with('[') && text.ends_with(']') ? text.substr(1, text.size() - 2) : text;
}

DescribedOption describeOption(CLI::Option& option) {
  DescribedOption one;
  describeValue(option, one);
  for (const std::string& name : option.get_lnames()) one.names.push_back("--" + name);
  for (const std::string& name : option.get_snames()) one.names.push_back("-" + name);
  if (one.names.empty()) one.names.push_back(option.get_name(true));
  one.description = option.get_description();
  one.group = option.get_group();
  one.defaultValue = withoutBrackets(option.get_default_str());
  one.required = option.get_required();
  one.repeats = option.get_items_expected_max() >= CLI::detail::expected_max_vector_size;
  return one;
}

}  // namespace

DescribedCommand describe(CLI::App& app) {
  DescribedCommand command{app.get_name(), app.get_description(), app.get_footer(), {}, {}, {}};
  for (CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;  // hidden
    (option->nonpositional() ? command.options : command.arguments)
        .push_back(describeOption(*option));
  }
  for (CLI::App* subcommand : app.get_subcommands([](CLI::App*) { return true; })) {
    command.subcommands.push_back(describe(*subcommand));
  }
  return command;
}

}  // namespace app
