#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "bio/discovery/effect_names.h"
#include "bio/discovery/end_of_limb.h"
#include "discovery/effects/effects.h"

namespace bio::discover {

using Eigen::Index;
using info::discover::Candidate;

// One line here and one below for each effect, or small family of them, of a file in this folder.
void addViscousDamping(EncompassingModel& model, const MovingCoordinate& at);
void addCoulombFriction(EncompassingModel& model, const MovingCoordinate& at);
void addStribeckFriction(EncompassingModel& model, const MovingCoordinate& at);
void addQuadraticDrag(EncompassingModel& model, const MovingCoordinate& at);
void addPowerDamping(EncompassingModel& model, const MovingCoordinate& at);
void addStiffness(EncompassingModel& model, const MovingCoordinate& at);
void addCubicStiffness(EncompassingModel& model, const MovingCoordinate& at);
void addLimits(EncompassingModel& model, const MovingCoordinate& at);
void addExponentialLimits(EncompassingModel& model, const MovingCoordinate& at);
void addLeverWeight(EncompassingModel& model, const MovingCoordinate& at);
void addLeverInertia(EncompassingModel& model, const MovingCoordinate& at);
void addPayload(EncompassingModel& model);
void addTilt(EncompassingModel& model);
void addConstantTorque(EncompassingModel& model, const MovingCoordinate& at);
void addElasticBand(EncompassingModel& model);
void addBiarticularSprings(EncompassingModel& model);
void addTimedTorques(EncompassingModel& model, const MovingCoordinate& at);
void addTimedMasses(EncompassingModel& model);
void addMissingMuscles(EncompassingModel& model);
void addDelay(EncompassingModel& model);
void addShape(EncompassingModel& model);
void addDriveGain(EncompassingModel& model, const MovingCoordinate& at);
void addDriveDelay(EncompassingModel& model, const MovingCoordinate& at);
void addDriveLag(EncompassingModel& model, const MovingCoordinate& at);
void addDriveSaturation(EncompassingModel& model, const MovingCoordinate& at);
void addFatigue(EncompassingModel& model);
void addCrosstalk(EncompassingModel& model);
void addExchangedChannels(EncompassingModel& model);
void addSaturation(EncompassingModel& model);
void addElectrodeGains(EncompassingModel& model);
void addBaselines(EncompassingModel& model);
void addMassError(EncompassingModel& model);
void addInertiaErrors(EncompassingModel& model);
void addActivationError(EncompassingModel& model);
void addMuscleErrors(EncompassingModel& model);
void addTendonCompliance(EncompassingModel& model);
void addForceErrors(EncompassingModel& model, const MovingCoordinate& at);
void addWrapErrors(EncompassingModel& model);
void addSensorErrors(EncompassingModel& model, std::size_t sensor);

const std::vector<EffectEntry>& effectEntries() {
  static const std::vector<EffectEntry> entries = {
      {"visc", addViscousDamping},
      {"coulomb", addCoulombFriction},
      {"stribeck", addStribeckFriction},
      {"drag", addQuadraticDrag},
      {"powerdamp", addPowerDamping},
      {"stiffness", addStiffness},
      {"cubic", addCubicStiffness},
      {"limit", addLimits},
      {"limit_exp", addExponentialLimits},
      {"lever_weight", addLeverWeight},
      {"lever_inertia", addLeverInertia},
      {"payload", addPayload},
      {"tilt", addTilt},
      {"const", addConstantTorque},
      {"handforce", addHandForce},
      {"spring", addElasticBand},
      {"biarticular", addBiarticularSprings},
      {"timed", addTimedTorques},
      {"timed", addTimedMasses},
      {"drive_gain", addDriveGain},
      {"drive_delay", addDriveDelay},
      {"drive_lag", addDriveLag},
      {"drive_saturation", addDriveSaturation},
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
      {"inertias", addInertiaErrors},
      {"tau", addActivationError},
      {"muscles", addMuscleErrors},
      {"tendon", addTendonCompliance},
      {"forces", addForceErrors},
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
    for (const Candidate& candidate : encompassing.candidates()) known.push_back(candidate.id);
    throw std::invalid_argument(
        fmt::format("no effect is called '{}'; the catalogue has {}", id, fmt::join(known, ", ")));
  }
}

void addUserEffect(EncompassingModel& model, const UserEffect& effect) {
  const auto& all = effectEntries();
  bool isThere = false, isTaken = model.knows(effect.id);
  for (const EffectEntry& entry : all) isTaken = isTaken || effect.id == entry.id;
  for (const MovingCoordinate& at : model.coordinates()) {
    if (!effect.coordinate.empty() && effect.coordinate != at.coordinate.name) continue;
    isThere = true;
    isTaken = isTaken || model.present().count(model.idAt(at, effect.id)) > 0;
  }
  if (isTaken)
    throw std::invalid_argument(fmt::format("{}: id = \"{}\", there is another effect of this name",
                                            effect.file, effect.id));
  for (const MovingCoordinate& at : model.coordinates())
    if (effect.coordinate.empty() || effect.coordinate == at.coordinate.name)
      addExpression(model, at, effect);
  if (isThere) return;
  throw std::invalid_argument(fmt::format("{}: coordinate = \"{}\", which is not in question",
                                          effect.file, effect.coordinate));
}

}  // namespace

EncompassingModel encompassingModel(const Model& model, const SystemOptions& system,
                                    const CoordinateNames& coordinates,
                                    const CatalogueChoice& choice) {
  const std::vector<std::string> without = effectIds(choice.without);
  EncompassingModel encompassing(model, system, coordinates, choice.sensors);
  encompassing.setMotions(choice.motions);
  if (choice.drives && encompassing.system().numMuscles() == 0)
    encompassing.setCommands(*choice.drives);
  addNuisances(encompassing);
  addExperimentalConditions(encompassing);
  for (const EffectEntry& entry : effectEntries()) {
    if (std::find(without.begin(), without.end(), entry.id) != without.end()) continue;
    if (const auto* ofSystem = std::get_if<OfSystem>(&entry.add)) (*ofSystem)(encompassing);
    if (const auto* ofCoordinate = std::get_if<OfCoordinate>(&entry.add)) {
      for (const MovingCoordinate& at : encompassing.coordinates())
        (*ofCoordinate)(encompassing, at);
    }
    if (const auto* ofSensor = std::get_if<OfSensor>(&entry.add)) {
      for (std::size_t i = 0; i < encompassing.sensors().size(); ++i) (*ofSensor)(encompassing, i);
    }
  }
  for (const UserEffect& effect : choice.own) addUserEffect(encompassing, effect);
  mustBeKnown(encompassing, without);
  encompassing.forget(without);
  if (!choice.formula.empty())
    addFormula(encompassing, encompassing.coordinates().at(choice.formulaAxis), choice.formula);
  return encompassing;
}

Candidate candidate(const EncompassingModel& model, std::string id, std::string name,
                    std::string sentence, info::discover::EffectKind kind,
                    std::vector<std::size_t> quantities,
                    const std::vector<std::vector<double>>& starts,
                    std::vector<std::string> equivalents) {
  Candidate candidate{std::move(id),
                      std::move(name),
                      std::move(sentence),
                      kind,
                      std::move(quantities),
                      {},
                      {},
                      std::move(equivalents)};
  for (const std::size_t quantity : candidate.quantities) {
    candidate.sds.push_back(model.quantities()[quantity].sd);
  }
  for (const std::vector<double>& start : starts) {
    candidate.starts.push_back(
        Eigen::VectorXd::Map(start.data(), static_cast<Index>(start.size())));
  }
  return candidate;
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

namespace {

/// To three digits, which is how a formula tells it.
double roundedSize(double size) {
  const std::string text = fmt::format("{:.2e}", size);
  double rounded = size;
  std::from_chars(text.data(), text.data() + text.size(), rounded);  // whatever the locale
  return rounded;
}

}  // namespace

CoordinateUnits unitsOf(const EncompassingModel& model, const MovingCoordinate& at) {
  const bool turns = at.coordinate.isRotation;
  CoordinateUnits units =
      turns ? CoordinateUnits{"rad", "rad/s", "N m", "torque"}
            : CoordinateUnits{"m", "m/s", "N", "force", 0.125, 0.125, 0.05 * 0.125};
  if (model.system().numMuscles() == 0) {
    constexpr double forearm = 4, cart = 16;  // [N m] and [N] that count as 1
    const double pull = model.base().gravity.norm(), gravity = pull > 0 ? pull : 9.81;
    constexpr double dry = 1.0 / 80;  // of the speed that was seen
    if (at.massMoment > 0) units.strength = gravity * at.massMoment / (turns ? forearm : cart);
    if (at.seen.speed == 0) return units;
    units.speedSize = roundedSize(at.seen.speed);
    units.frictionWidth = roundedSize(dry * at.seen.speed);
    if (!turns) units.length = roundedSize(at.seen.spread);
    return units;
  }
  if (turns) return units;
  const auto k = &at - model.coordinates().data();
  double up = 0, down = 0;
  for (const MuscleGroup& group : model.groups()) {
    for (const std::size_t i : group.muscles) {
      const double most =
          maxIsometricForce(findMuscle(model.base(), model.system().muscles()[i].name));
      (group.momentArms[k] > 0 ? up : down) += std::abs(group.momentArms[k]) * most;
    }
  }
  const double strongest = std::max(up, down);
  if (strongest > 0) units.strength = std::exp2(std::round(std::log2(strongest / 64)));
  return units;
}

double heaviness(const EncompassingModel& model) {
  if (model.system().numMuscles() > 0) return 1;
  double mass = 0;
  for (const std::string& body : model.movedBodies()) mass += findBody(model.base(), body).mass;
  return mass > 0 ? mass / 2 : 1;
}

Candidate candidateAt(const EncompassingModel& model, const MovingCoordinate& at,
                      const std::string& id, std::string name, std::string sentence,
                      std::vector<std::size_t> quantities,
                      const std::vector<std::vector<double>>& starts) {
  if (!model.hasOneCoordinate()) {
    name += " of " + at.coordinate.name;
    sentence = at.coordinate.name + ": " + sentence;
  }
  return candidate(model, model.idAt(at, id), std::move(name), std::move(sentence),
                   info::discover::EffectKind::structure, std::move(quantities), starts);
}

std::string lawName(const MovingCoordinate& at, const std::string& id) {
  return at.coordinate.name + "_" + id;
}

void addFormula(EncompassingModel& model, const MovingCoordinate& at,
                const std::vector<info::discover::FormulaTerm>& terms) {
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
  addExpression(model, at, effect);
}

std::optional<std::size_t> addExpression(EncompassingModel& model, const MovingCoordinate& at,
                                         const ExpressionEffect& effect) {
  const std::string law = lawName(at, effect.id);
  for (const ExpressionBasedCoordinateForce& force : model.base().expressionForces) {
    if (force.name != law || !force.enabled) continue;
    model.addPresent(model.idAt(at, effect.id), law);
    return {};
  }
  std::vector<NamedConstant> constants;
  for (const std::string& name : effect.constants) constants.push_back({name, 0});
  const std::size_t force =
      model.addLaw({law, at.coordinate.name, effect.expression, true, constants});
  std::vector<std::size_t> quantities;
  for (std::size_t i = 0; i < effect.quantities.size(); ++i) {
    const std::size_t number = model.number(ExpressionTarget{force, i}, 0);
    info::discover::Quantity quantity = effect.quantities[i];
    quantity.name = model.idAt(at, quantity.name);
    quantities.push_back(model.add(std::move(quantity), {Meaning::Kind::shift, {{number}}}));
  }
  model.lawFollows(quantities);
  Candidate candidate =
      candidateAt(model, at, effect.id, effect.name, effect.sentence, quantities, effect.starts);
  candidate.equivalents = effect.equivalents;
  model.add(std::move(candidate));
  return force;
}

}  // namespace bio::discover
