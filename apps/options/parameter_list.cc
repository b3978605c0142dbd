#include "options/parameter_list.h"

#include <fmt/format.h>

#include <iostream>

#include "bio/parameters/parameters.h"
#include "output/json_text.h"

namespace app {

void addListParameters(CLI::App& options, bool& list) {
  options.add_flag("--list-parameters", list, "list every parameter of the model and exit");
}

ExitStatus listParameters(const CommandContext& context, const bio::Model& model,
                          const bio::MusculoskeletalSystem& system) {
  const bio::ParameterCatalogue catalogue(model, system, {system.skeleton().defaultValues(), {}});
  if (context.json) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const bio::ModelParameter& p : catalogue.parameters()) {
      list.push_back({{"name", p.name},
                      {"value", p.value},
                      {"unit", p.unit},
                      {"lower", p.lower},
                      {"upper", p.upper},
                      {"meaning", p.meaning},
                      {"is_group", p.isGroup}});
    }
    std::cout << jsonText(list, 2) << '\n';
    return ExitStatus::done;
  }
  std::string text;
  for (const bio::ModelParameter& p : catalogue.parameters()) {
    text += fmt::format("{:<44} {:>12.6g} {:<10} {}{}\n", p.name, p.value, p.unit, p.meaning,
                        p.isGroup ? " (group)" : "");
  }
  std::cout << text;
  return ExitStatus::done;
}

}  // namespace app
