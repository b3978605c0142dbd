#include "options/set_parameters.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <stdexcept>
#include <utility>

#include "options/system_options.h"
#include "output/text.h"

namespace app {
namespace {

void tellSet(const bio::ModelWithParameters& set, Summary& summary) {
  if (set.numbers.empty()) return;
  nlohmann::ordered_json told = nlohmann::ordered_json::object();
  std::vector<std::string> words;
  for (const bio::SetNumber& number : set.numbers) {
    told[number.name] = {
        {"value", number.value}, {"unit", number.unit}, {"in_model", number.before}};
    words.push_back(fmt::format("{} = {} (in the file {})", number.name,
                                withUnit(number.value, number.unit), numberText(number.before)));
  }
  summary.set("set_parameters", told);
  summary.methods().say(
      Methods::Part::model,
      fmt::format("{} the model {} set to other values than its file has: {}.",
                  words.size() == 1 ? "One number of" : fmt::format("{} numbers of", words.size()),
                  words.size() == 1 ? "was" : "were", fmt::join(words, ", ")));
}

[[noreturn]] void refuse(const std::exception& error) {
  throw std::invalid_argument(fmt::format("--set: {}", error.what()));
}

bio::Model ofModelAlone(bio::ModelWithParameters changed) {
  refuseValuesOfTrial(changed);
  return std::move(changed.model);
}

}  // namespace

CLI::Option* addSetOption(CLI::App& subcommand, std::vector<Assignment>& set) {
  return addAssignments(
      subcommand, "--set", set,
      "another value of a parameter than MODEL has, in its unit (an angle also as 34deg), as "
      "TRI.radius=0.018; if it is estimated or drawn, its start and the mean of its prior; may be "
      "repeated; `sensitivity MODEL --list-parameters` lists them");
}

bio::ModelWithParameters withSetParameters(bio::Model model, const bio::SystemOptions& options,
                                           const std::vector<Assignment>& set, Summary& summary) {
  bio::ModelWithParameters changed;
  if (set.empty()) {
    changed.model = std::move(model);
    return changed;
  }
  std::vector<bio::NamedValue> values;
  for (const Assignment& one : set) values.push_back({one.name, one.value, one.isAngle});
  try {
    changed = bio::withParameters(model, options, values);
  } catch (const std::invalid_argument& error) {
    refuse(error);
  } catch (const std::domain_error& error) {
    refuse(error);
  }
  tellSet(changed, summary);
  return changed;
}

void refuseValuesOfTrial(const bio::ModelWithParameters& changed) {
  try {
    bio::requireOfModel(changed);
  } catch (const std::invalid_argument& error) {
    refuse(error);
  }
}

bio::Model withSetParameters(bio::Model model, const SimulationOptions& options, Summary& summary) {
  return ofModelAlone(
      withSetParameters(std::move(model), systemOptions(options), options.set, summary));
}

bio::Model withSetInWholeModel(bio::Model model, const SimulationOptions& options,
                               Summary& summary) {
  if (options.set.empty() || !options.coordinates.empty())
    return withSetParameters(std::move(model), options, summary);
  const bio::SystemOptions whole = bio::optionsOfWholeModel(model, byName(options.locks));
  return ofModelAlone(withSetParameters(std::move(model), whole, options.set, summary));
}

std::string setWords(const SimulationOptions& options) {
  std::string text;
  for (const Assignment& one : options.set)
    text += " --set " + shellWord(fmt::format("{}={}", one.name, one.value));
  return text;
}

}  // namespace app
