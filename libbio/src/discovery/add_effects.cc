#include "bio/discovery/add_effects.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "bio/discovery/effects.h"
#include "bio/forces/coordinate_force.h"

namespace bio::discover {
namespace {

using Eigen::Index;

/// Takes the laws off that were built in and are absent.
template <class Laws>
void dropAbsent(Laws& laws, std::size_t ofBase) {
  const auto built = laws.begin() + static_cast<std::ptrdiff_t>(ofBase);
  laws.erase(std::remove_if(built, laws.end(), [](const auto& law) { return !law.enabled; }),
             laws.end());
}

const info::discover::Candidate& findCandidate(const EncompassingModel& encompassing,
                                               const std::string& id) {
  for (const auto& candidate : encompassing.candidates()) {
    if (candidate.id == id) return candidate;
  }
  const auto present = encompassing.present().find(id);
  if (present != encompassing.present().end()) {
    throw std::invalid_argument(
        fmt::format("effect '{}': the model already has it, as '{}'", id, present->second));
  }
  throw std::invalid_argument(
      fmt::format("effect '{}': must be in the catalogue of this model", id));
}

std::string wordsOf(const EncompassingModel& encompassing,
                    const info::discover::Candidate& candidate, const EffectToAdd& effect) {
  std::string words = fmt::format("; {} ({}):", candidate.name, candidate.id);
  for (std::size_t i = 0; i < candidate.quantities.size(); ++i) {
    const auto k = static_cast<Index>(i);
    const auto& quantity = encompassing.quantities()[candidate.quantities[i]];
    words += fmt::format("{} {} {:.6g}", i ? "," : "", quantity.name, effect.values[k]);
    if (effect.sds.size() > k) words += fmt::format(" ± {:.2g}", effect.sds[k]);
    if (!quantity.unit.empty()) words += " " + quantity.unit;
  }
  if (effect.logBayesFactor != 0)
    words += fmt::format(", log Bayes factor {:.4g} nats", effect.logBayesFactor);
  if (effect.probability != 0) words += fmt::format(", probability {:.4g}", effect.probability);
  return words;
}

}  // namespace

Augmented augmentedModel(const EncompassingModel& encompassing, const Eigen::VectorXd& values) {
  ParameterCatalogue::Setting setting = encompassing.settingAt(values, {});
  Augmented result{std::move(setting.model),
                   std::move(setting.mapping),
                   {},
                   {},
                   encompassing.driveLawsAt(values)};
  for (std::size_t i = 0; i < encompassing.sensors().size(); ++i)
    result.sensors.push_back(encompassing.sensorAt(values, i));
  Model& model = result.model;
  for (std::size_t i = 0; i < model.muscles.size(); ++i) {
    if (!model.muscles[i].enabled) model.muscles[i] = encompassing.base().muscles[i];
  }
  dropAbsent(model.springForces, encompassing.base().springForces.size());
  dropAbsent(model.limitForces, encompassing.base().limitForces.size());
  dropAbsent(model.expressionForces, encompassing.base().expressionForces.size());
  dropAbsent(model.elasticPaths, encompassing.base().elasticPaths.size());
  for (const auto& [muscle, synergists] : encompassing.synergists()) {
    const auto works = [&, name = &muscle](const Muscle& added) {
      return added.name == *name && added.enabled;
    };
    if (std::any_of(model.muscles.begin(), model.muscles.end(), works))
      result.muscles.push_back(muscle);
  }
  for (ExpressionBasedCoordinateForce& force : model.expressionForces) {
    if (force.constants.empty()) continue;
    force.expression = plainExpression(force);
    force.constants.clear();
  }
  return result;
}

std::string effectCredits(const EncompassingModel& encompassing,
                          const std::vector<EffectToAdd>& effects,
                          const EffectProvenance& provenance) {
  std::string credits = "Effects added by " + provenance.tool;
  for (std::size_t i = 0; i < provenance.data.size(); ++i) {
    credits += (i ? ", " : " from ") + provenance.data[i];
  }
  for (const EffectToAdd& effect : effects)
    credits += wordsOf(encompassing, findCandidate(encompassing, effect.id), effect);
  return credits;
}

Augmented addEffects(const EncompassingModel& encompassing, const std::vector<EffectToAdd>& effects,
                     const EffectProvenance& provenance) {
  Eigen::VectorXd values = encompassing.nominal();
  for (const EffectToAdd& effect : effects) {
    const auto& candidate = findCandidate(encompassing, effect.id);
    if (effect.values.size() != static_cast<Index>(candidate.quantities.size())) {
      throw std::invalid_argument(
          fmt::format("effect '{}': {} values for {} quantities, must be as many", effect.id,
                      effect.values.size(), candidate.quantities.size()));
    }
    for (std::size_t i = 0; i < candidate.quantities.size(); ++i) {
      values[static_cast<Index>(candidate.quantities[i])] = effect.values[static_cast<Index>(i)];
    }
  }
  const std::string credits = effectCredits(encompassing, effects, provenance);
  Augmented result = augmentedModel(encompassing, values);
  std::string& text = result.model.credits;
  text += text.empty() ? credits : ". " + credits;
  return result;
}

Augmented addEffects(const Model& model, const SystemOptions& system,
                     const CoordinateNames& coordinates, const std::vector<EffectToAdd>& effects,
                     const EffectProvenance& provenance,
                     const std::vector<info::discover::FormulaTerm>& formula, std::size_t axis) {
  const CatalogueChoice choice{.formula = formula, .formulaAxis = axis};
  return addEffects(encompassingModel(model, system, coordinates, choice), effects, provenance);
}

}  // namespace bio::discover
