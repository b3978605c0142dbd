#include "bio/parameters/with_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>
#include <variant>

#include "bio/parameters/parameters.h"
#include "bio/parameters/sign_of_parameter.h"
#include "bio/skeleton/articulated_tree.h"
#include "bio/skeleton/free_coordinates.h"

namespace bio {
namespace {

bool belongsToTrial(const ModelParameter& parameter) {
  const ParameterTarget& target = parameter.targets.front();
  return std::holds_alternative<EmgTarget>(target) || std::holds_alternative<InitialTarget>(target);
}

void requireSign(const ModelParameter& parameter, double value) {
  if (!(value < 0) || !cannotBeNegative(parameter)) return;
  throw std::invalid_argument(fmt::format("{} = {:.6g}{}{}, must be ≥ 0", parameter.name, value,
                                          parameter.unit.empty() ? "" : " ", parameter.unit));
}

void requireUnit(const ModelParameter& parameter, const NamedValue& typed) {
  // what a parameter of the initial state is follows its coordinate
  if (!typed.isAngle || parameter.unit == "rad" || belongsToTrial(parameter)) return;
  throw std::invalid_argument(
      fmt::format("{} is no angle, must be a number{}", parameter.name,
                  parameter.unit.empty() ? "" : fmt::format(" [{}]", parameter.unit)));
}

}  // namespace

ModelWithParameters withParameters(const Model& model, const SystemOptions& options,
                                   const std::vector<NamedValue>& values) {
  ModelWithParameters set;
  if (values.empty()) {
    set.model = model;
    return set;
  }
  const MusculoskeletalSystem system(model, options);
  const ParameterCatalogue catalogue(model, system, {system.skeleton().defaultValues(), {}});
  std::vector<std::string> all;
  std::vector<std::size_t> selection;
  std::vector<double> ofModel;
  for (const NamedValue& typed : values) {
    const std::size_t index = catalogue.find(typed.name);
    const ModelParameter& parameter = catalogue.parameters()[index];
    if (std::find(all.begin(), all.end(), parameter.name) != all.end())
      throw std::invalid_argument(fmt::format("'{}' is given twice", parameter.name));
    all.push_back(parameter.name);
    requireUnit(parameter, typed);
    requireSign(parameter, typed.value);
    if (belongsToTrial(parameter)) {
      set.ofTrial.push_back({parameter.name, typed.value, typed.isAngle});
      continue;
    }
    set.numbers.push_back({parameter.name, parameter.unit, typed.value, parameter.value});
    selection.push_back(index);
    ofModel.push_back(typed.value);
  }
  (void)catalogue.select(all);  // no group beside its members
  set.model = catalogue
                  .at(selection, Eigen::VectorXd::Map(ofModel.data(),
                                                      static_cast<Eigen::Index>(ofModel.size())))
                  .model;
  (void)MusculoskeletalSystem(set.model, options);  // its rules
  return set;
}

void requireOfModel(const ModelWithParameters& set) {
  if (set.ofTrial.empty()) return;
  throw std::invalid_argument(fmt::format("'{}' belongs to a trial, must be a number of the model",
                                          set.ofTrial.front().name));
}

SystemOptions optionsOfWholeModel(const Model& model, const std::map<std::string, double>& locks) {
  std::set<std::string> locked;
  for (const auto& [name, value] : locks) locked.insert(name);
  SystemOptions options;
  options.skeleton.lockedValues = locks;
  options.prescribed = prescribedByModel(model, locked);
  std::set<std::string> others = locked;
  others.insert(options.prescribed.begin(), options.prescribed.end());
  std::vector<std::string>& free = options.skeleton.freeCoordinates;
  free = freeByDefault(model, others, {}, true);
  if (free.empty() && options.prescribed.empty()) {
    for (const std::string& name : independentCoordinates(model))
      if (!locked.contains(name)) free.push_back(name);
  }
  free.insert(free.end(), options.prescribed.begin(), options.prescribed.end());
  return options;
}

}  // namespace bio
