#include "discover/effect_list.h"

#include <fmt/format.h>

#include <iostream>

#include "bio/discovery/effect_names.h"
#include "bio/discovery/effects.h"
#include "discover/model_discovery.h"
#include "info/discovery/discover.h"
#include "options/set_parameters.h"
#include "options/system_options.h"
#include "options/trial_input.h"
#include "output/json_text.h"

namespace app {
namespace {

using info::discover::Candidate;

/// "stribeck.torque [N m], stribeck.speed [rad/s]".
std::string parameterList(const bio::discover::EncompassingModel& model, const Candidate& effect) {
  std::string list;
  for (const std::size_t k : effect.quantities) {
    const info::discover::Quantity& quantity = model.quantities()[k];
    const std::string unit = quantity.unit.empty() ? "1" : quantity.unit;
    list += fmt::format("{}{} [{}]", list.empty() ? "" : ", ", quantity.name, unit);
  }
  return list;
}

nlohmann::ordered_json effectJson(const bio::discover::EncompassingModel& model,
                                  const Candidate& effect) {
  nlohmann::ordered_json parameters = nlohmann::ordered_json::array();
  for (const std::size_t k : effect.quantities) {
    const info::discover::Quantity& quantity = model.quantities()[k];
    parameters.push_back({{"name", quantity.name}, {"unit", quantity.unit}});
  }
  return {{"id", effect.id},
          {"long_id", bio::discover::effectLongName(effect.id)},
          {"name", effect.name},
          {"kind", info::discover::name(effect.kind)},
          {"meaning", effect.sentence},
          {"parameters", parameters},
          {"equivalents", effect.equivalents}};
}

}  // namespace

ExitStatus listEffects(const CommandContext& context, const std::string& file,
                       const std::vector<std::string>& own, SimulationOptions simulation) {
  Summary summary(context);
  bio::Model model = readModel(file, summary);
  chooseCoordinates(simulation, model, {});
  model = withSetParameters(std::move(model), simulation, summary);
  movableSystem(model, file, simulation, summary);  // warns and refuses as a search would
  const bio::discover::CoordinateNames coordinates = coordinatesInQuestion(simulation, {});
  const bio::discover::EncompassingModel encompassing = bio::discover::encompassingModel(
      model, systemOptions(simulation), coordinates,
      {.own = bio::discover::readUserEffects(own),
       .drives = bio::discover::possibleCommands(coordinates.all)});
  if (context.json) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Candidate& candidate : encompassing.candidates())
      list.push_back(effectJson(encompassing, candidate));
    std::cout << jsonText(list, 2) << '\n';
    return ExitStatus::done;
  }
  std::string text;
  for (const Candidate& candidate : encompassing.candidates()) {
    text +=
        fmt::format("{:<22} {:<52} {:<10} {}\n", candidate.id, candidate.name,
                    info::discover::name(candidate.kind), parameterList(encompassing, candidate));
  }
  for (const auto& [id, what] : encompassing.present()) {
    text += fmt::format("{:<22} the model has it already: {}\n", id, what);
  }
  std::cout << text;
  return ExitStatus::done;
}

}  // namespace app
