#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bio/discovery/effect_names.h"
#include "bio/discovery/end_of_limb.h"
#include "discovery/effects/effects.h"

namespace bio::discover {

using Eigen::Index;
using info::discover::Candidate;

// One line here and one below for each effect, or small family of them, of a file in this folder.
void addViscousDamping(EncompassingModel& model);
void addCoulombFriction(EncompassingModel& model);
void addStribeckFriction(EncompassingModel& model);
void addQuadraticDrag(EncompassingModel& model);
void addPowerDamping(EncompassingModel& model);
void addStiffness(EncompassingModel& model);
void addLimits(EncompassingModel& model);
void addExponentialLimits(EncompassingModel& model);
void addPayload(EncompassingModel& model);
void addTilt(EncompassingModel& model);
void addConstantTorque(EncompassingModel& model);
void addElasticBand(EncompassingModel& model);
void addTimedForces(EncompassingModel& model);
void addMissingMuscles(EncompassingModel& model);
void addDelay(EncompassingModel& model);
void addShape(EncompassingModel& model);
void addFatigue(EncompassingModel& model);
void addCrosstalk(EncompassingModel& model);
void addExchangedChannels(EncompassingModel& model);
void addSaturation(EncompassingModel& model);
void addElectrodeGains(EncompassingModel& model);
void addBaselines(EncompassingModel& model);
void addMassError(EncompassingModel& model);
void addActivationError(EncompassingModel& model);
void addMuscleErrors(EncompassingModel& model);
void addTendonCompliance(EncompassingModel& model);
void addWrapErrors(EncompassingModel& model);
void addSensorErrors(EncompassingModel& model);

const std::vector<EffectEntry>& effectEntries() {
  static const std::vector<EffectEntry> entries = {
      {"visc", addViscousDamping},
      {"coulomb", addCoulombFriction},
      {"stribeck", addStribeckFriction},
      {"drag", addQuadraticDrag},
      {"powerdamp", addPowerDamping},
      {"stiffness", addStiffness},
      {"limit", addLimits},
      {"limit_exp", addExponentialLimits},
      {"payload", addPayload},
      {"tilt", addTilt},
      {"const", addConstantTorque},
      {"handforce", addHandForce},
      {"spring", addElasticBand},
      {"timed", addTimedForces},
      {"fatigue", addFatigue},
      {"missing", addMissingMuscles},
      {"delay", addDelay},
      {"shape", addShape},
      {"crosstalk", addCrosstalk},
      {"swaps", addExchangedChannels},
      {"saturation", addSaturation},
      {"electrodes", addElectrodeGains},
      {"baselines", addBaselines},
      {"mass", addMassError},
      {"tau", addActivationError},
      {"muscles", addMuscleErrors},
      {"tendon", addTendonCompliance},
      {"wraps", addWrapErrors},
      {"sensor", addSensorErrors},
  };
  return entries;
}

namespace {

/// Every excluded id must be an entry, a candidate, or present in the model.
void mustBeKnown(const EncompassingModel& encompassing, const std::vector<std::string>& ids) {
  const auto& entries = effectEntries();
  for (const std::string& id : ids) {
    const bool isEntry = std::any_of(entries.begin(), entries.end(),
                                     [&](const EffectEntry& entry) { return id == entry.id; });
    if (isEntry || encompassing.knows(id) || encompassing.present().count(id) > 0) continue;
    std::vector<std::string> known;
    for (const Candidate& one : encompassing.candidates()) known.push_back(one.id);
    throw std::invalid_argument(
        fmt::format("no effect is called '{}'; the catalogue has {}", id, fmt::join(known, ", ")));
  }
}

}  // namespace

EncompassingModel encompassingModel(const Model& model, const SystemOptions& arm,
                                    const std::string& coordinate,
                                    const std::vector<std::string>& leftOut,
                                    const std::vector<info::discover::FormulaTerm>& formula) {
  const std::vector<std::string> without = effectIds(leftOut);
  EncompassingModel encompassing(model, arm, coordinate);
  addNuisances(encompassing);
  addExperimentalConditions(encompassing);
  for (const EffectEntry& entry : effectEntries()) {
    if (std::find(without.begin(), without.end(), entry.id) == without.end())
      entry.add(encompassing);
  }
  mustBeKnown(encompassing, without);
  encompassing.forget(without);
  if (!formula.empty()) addFormula(encompassing, formula);
  return encompassing;
}

Candidate candidate(const EncompassingModel& model, std::string id, std::string name,
                    std::string sentence, info::discover::EffectKind kind,
                    std::vector<std::size_t> quantities,
                    const std::vector<std::vector<double>>& starts,
                    std::vector<std::string> equivalents) {
  Candidate one{std::move(id),
                std::move(name),
                std::move(sentence),
                kind,
                std::move(quantities),
                {},
                {},
                std::move(equivalents)};
  for (const std::size_t quantity : one.quantities) {
    one.sds.push_back(model.quantities()[quantity].sd);
  }
  for (const std::vector<double>& start : starts) {
    one.starts.push_back(Eigen::VectorXd::Map(start.data(), static_cast<Index>(start.size())));
  }
  return one;
}

namespace {

/// F0 [N]
double maxIsometricForce(const Muscle& muscle) {
  if (muscle.schutte) return muscle.schutte->maxIsometricForce;
  return std::visit([](auto p) { return p.at(p, muscles::common::maxIsometricForce); },
                    *muscle.hill);
}

}  // namespace

std::string endOfLimb(const EncompassingModel& model) {
  if (model.movedBodies().empty()) return "the limb";
  const std::string& last = model.movedBodies().back();
  return last.find("hand") != std::string::npos ? "the hand" : last;
}

std::string placeOfMass(const EncompassingModel& model) {
  const std::string end = endOfLimb(model);
  return (end == "the hand" ? "in " : "on ") + end;
}

CoordinateUnits unitsOf(const EncompassingModel& model) {
  if (model.coordinate().isRotation) return {"rad", "rad/s", "N m", "torque"};
  double up = 0, down = 0;
  for (const MuscleGroup& group : model.groups()) {
    for (const std::size_t i : group.muscles) {
      const double most =
          maxIsometricForce(findMuscle(model.base(), model.arm().muscles()[i].name));
      (group.momentArm > 0 ? up : down) += std::abs(group.momentArm) * most;
    }
  }
  const double strongest = std::max(up, down);
  const double strength = strongest > 0 ? std::exp2(std::round(std::log2(strongest / 64))) : 1;
  return {"m", "m/s", "N", "force", 0.125, strength};
}

std::string lawName(const EncompassingModel& model, const std::string& id) {
  return model.coordinate().name + "_" + id;
}

void addFormula(EncompassingModel& model, const std::vector<info::discover::FormulaTerm>& terms) {
  ExpressionEffect effect{"formula",
                          "free-form force",
                          "A force outside the catalogue, as a formula of the state.",
                          "",
                          {},
                          {},
                          {{}}};
  std::string sum;
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const std::string name = k == 0 ? "c" : fmt::format("r{}", k + 1);
    const double sd = terms[k].sd;
    sum += k == 0 ? terms[k].expression : fmt::format("+{}*({})", name, terms[k].expression);
    effect.constants.push_back(name);
    // bounds only keep fits from running away
    effect.quantities.push_back(shape("formula." + name, "", 0, -20 * sd, 20 * sd, sd));
    effect.starts[0].push_back(terms[k].start);
  }
  effect.expression = fmt::format("c*({})", sum);
  addExpression(model, effect);
}

std::optional<std::size_t> addExpression(EncompassingModel& model, const ExpressionEffect& effect) {
  const std::string law = lawName(model, effect.id);
  for (const ExpressionBasedCoordinateForce& force : model.base().expressionForces) {
    if (force.name != law || !force.enabled) continue;
    model.addPresent(effect.id, law);
    return {};
  }
  std::vector<NamedConstant> constants;
  for (const std::string& name : effect.constants) constants.push_back({name, 0});
  const std::size_t force =
      model.addLaw({law, model.coordinate().name, effect.expression, true, constants});
  std::vector<std::size_t> quantities;
  for (std::size_t i = 0; i < effect.quantities.size(); ++i) {
    const std::size_t number = model.number(ExpressionTarget{force, i}, 0);
    quantities.push_back(model.add(effect.quantities[i], {Meaning::Kind::shift, {{number}}}));
  }
  model.lawFollows(quantities);
  model.add(candidate(model, effect.id, effect.name, effect.sentence,
                      info::discover::EffectKind::structure, quantities, effect.starts,
                      effect.equivalents));
  return force;
}

}  // namespace bio::discover
