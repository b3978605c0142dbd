#include <fmt/format.h>

#include <algorithm>

#include "discovery/effects/effects.h"

// Parameters of the base model that may be wrong: as nuisances with their tolerance, as candidates
// beyond it. Tolerances: spread between specimens and scaled models (Arnold et al. 2010 report 10
// to 20 % of F0, a few per cent of the lengths after scaling); judgements, not measurements.

namespace bio::discover {
namespace {

using info::discover::Candidate;
using info::discover::EffectKind;

struct MuscleQuantityRule {
  const char* id;         ///< of the candidate, before the muscle's name
  const char* parameter;  ///< of the catalogue of parameters
  const char* words;
  double lower, upper;  ///< factors
  double tolerance;     ///< of the logarithm, as a nuisance
  double sd;            ///< of the logarithm, as a candidate
};
constexpr MuscleQuantityRule rules[] = {
    {"Fmax_", "max_isometric_force", "maximum isometric force", 0.2, 5, 0.15, 0.6},
    {"lopt_", "optimal_fiber_length", "optimal fibre length", 0.6, 1.6, 0.04, 0.2},
    {"lslack_", "tendon_slack_length", "tendon slack length", 0.8, 1.25, 0.02, 0.1},
};

std::string nuisanceName(const std::string& muscle, const MuscleQuantityRule& rule) {
  return fmt::format("{}.{} factor", muscle, rule.parameter);
}

constexpr const char* massName = "mass factor";
constexpr const char* timeName = "activation time factor";

/// The candidate that a nuisance is off by more than its tolerance.
void addBeyond(EncompassingModel& model, std::size_t quantity, double sd, std::string id,
               std::string name, std::string sentence, std::vector<std::string> equivalents = {}) {
  const double start = 1 + sd / 4;
  Candidate one = candidate(model, std::move(id), std::move(name), std::move(sentence),
                            EffectKind::parameter, {quantity}, {{start}}, std::move(equivalents));
  one.sds = {sd};
  model.add(std::move(one));
}

std::string centreName(const std::string& body) {
  return body + ".mass_center factor";
}
std::string inertiaName(const std::string& body) {
  return body + ".inertia factor";
}

/// Where a body's mass lies: a free swing tells its frequency more exactly than people know that.
/// Tolerances, 2 % of the place and 10 % of the inertia, are judgements
/// (docs/decisions/080-models-without-muscles.md).
void addInertias(EncompassingModel& model, const std::string& body) {
  const auto add = [&](std::string name, std::initializer_list<const char*> numbers, double most,
                       double tolerance) {
    std::vector<Meaning::Part> parts;
    for (const char* number : numbers)
      for (const Meaning::Part& part : model.numbers(body + "." + number))
        if (model.valueOf(part) != 0) parts.push_back(part);
    if (!parts.empty())
      model.addNuisance(model.add(factor(std::move(name), 1 / most, most, tolerance),
                                  {Meaning::Kind::scale, std::move(parts)}));
  };
  add(centreName(body), {"mass_center.x", "mass_center.y", "mass_center.z"}, 2, 0.02);
  add(inertiaName(body),
      {"inertia.xx", "inertia.yy", "inertia.zz", "inertia.xy", "inertia.xz", "inertia.yz"}, 5, 0.1);
}

}  // namespace

void addNuisances(EncompassingModel& model) {
  for (const MuscleQuantityRule& rule : rules) {
    for (const SystemMuscle& muscle : model.system().muscles()) {
      const std::string parameter = fmt::format("{}.{}", muscle.name, rule.parameter);
      Meaning meaning{Meaning::Kind::scale, model.numbers(parameter)};
      meaning.parameter = model.parameters().find(parameter);
      model.addNuisance(
          model.add(factor(nuisanceName(muscle.name, rule), rule.lower, rule.upper, rule.tolerance),
                    std::move(meaning)));
    }
  }
  if (!model.movedBodies().empty()) {
    std::vector<Meaning::Part> parts;
    for (const std::string& body : model.movedBodies()) {
      for (const char* number : {"mass", "inertia.xx", "inertia.yy", "inertia.zz", "inertia.xy",
                                 "inertia.xz", "inertia.yz"}) {
        for (const Meaning::Part& part : model.numbers(body + "." + number)) parts.push_back(part);
      }
    }
    model.addNuisance(model.add(factor(massName, 0.3, 3, 0.05), {Meaning::Kind::scale, parts}));
  }
  if (model.system().numMuscles() > 0) {
    std::vector<Meaning::Part> parts;
    for (const SystemMuscle& muscle : model.system().muscles()) {
      if (muscle.activation.schutte()) {
        // rates, so that the time scale of the fibres' velocity stays as it is
        for (const char* rate : {".activation1", ".activation2"}) {
          for (const auto& part : model.numbers(muscle.name + rate)) {
            parts.push_back({part.number, -1});
          }
        }
      } else if (!muscle.activation.isDirect()) {
        for (const char* time : {".activation_time_constant", ".deactivation_time_constant"}) {
          for (const auto& part : model.numbers(muscle.name + time)) parts.push_back(part);
        }
      }
    }
    model.addNuisance(model.add(factor(timeName, 0.2, 5, 0.2), {Meaning::Kind::scale, parts}));
  } else {
    for (const std::string& body : model.movedBodies()) addInertias(model, body);
  }
}

void addMassError(EncompassingModel& model) {
  if (model.movedBodies().empty()) return;
  const bool hasMuscles = model.system().numMuscles() > 0;
  addBeyond(model, model.find(massName), 0.3, "mass",
            hasMuscles ? "mass of the limb" : "mass of the moving bodies",
            "The moving bodies are heavier or lighter than in the model.", {"payload"});
}

void addInertiaErrors(EncompassingModel& model) {
  if (model.system().numMuscles() > 0) return;
  const auto& quantities = model.quantities();
  const auto offer = [&](const std::string& quantity, double sd, const std::string& id,
                         const std::string& words) {
    const auto at = std::find_if(quantities.begin(), quantities.end(),
                                 [&](const auto& each) { return each.name == quantity; });
    if (at == quantities.end()) return;
    addBeyond(model, static_cast<std::size_t>(at - quantities.begin()), sd, id, words,
              fmt::format("The {} differs from the model's.", words));
  };
  for (const std::string& body : model.movedBodies()) {
    offer(centreName(body), 0.2, "centre_" + body, "centre of mass of " + body);
    offer(inertiaName(body), 0.6, "inertia_" + body, "inertia of " + body);
  }
}

void addActivationError(EncompassingModel& model) {
  if (model.system().numMuscles() == 0) return;
  addBeyond(model, model.find(timeName), 0.8, "tau", "time scale of activation",
            "The muscles' activation is slower or faster than in the model. EMG that a low-pass "
            "filter has smoothed looks the same as slower activation.");
}

void addMuscleErrors(EncompassingModel& model) {
  for (const MuscleQuantityRule& rule : rules) {
    for (const MuscleGroup& group : model.groups()) {
      const bool isForce = &rule == &rules[0];
      if (group.muscles.size() > 1) {
        std::vector<Meaning::Part> parts;
        for (const std::size_t i : group.muscles) {
          const std::string& muscle = model.system().muscles()[i].name;
          for (const auto& part : model.numbers(fmt::format("{}.{}", muscle, rule.parameter))) {
            parts.push_back(part);
          }
        }
        const std::string id = rule.id + group.name;
        const std::size_t x =
            model.add(factor(fmt::format("{} factor", id), rule.lower, rule.upper, rule.sd),
                      {Meaning::Kind::scale, parts});
        addBeyond(
            model, x, rule.sd, id, fmt::format("{} of {}", rule.words, group.name),
            fmt::format("The {} of all heads of {} is wrong.", rule.words, group.name),
            isForce ? std::vector<std::string>{gainId(group.name)} : std::vector<std::string>{});
      }
      for (const std::size_t i : group.muscles) {
        const std::string& muscle = model.system().muscles()[i].name;
        addBeyond(model, model.find(nuisanceName(muscle, rule)), rule.sd, rule.id + muscle,
                  fmt::format("{} of {}", rule.words, muscle),
                  fmt::format("The {} of {} is wrong.", rule.words, muscle),
                  isForce ? std::vector<std::string>{gainId(muscle)} : std::vector<std::string>{});
      }
    }
  }
}

void addTendonCompliance(EncompassingModel& model) {
  std::vector<Meaning::Part> parts;
  for (const SystemMuscle& muscle : model.system().muscles()) {
    const auto names = {".tendon_strain_scale", ".FmaxTendonStrain",
                        ".tendon_strain_at_one_norm_force",
                        ".TendonForceLengthCurve/strain_at_one_norm_force"};
    for (const char* name : names) {
      if (!model.parameters().has(muscle.name + name)) continue;
      for (const auto& part : model.numbers(muscle.name + name)) parts.push_back(part);
    }
  }
  if (parts.empty()) return;
  const std::size_t x =
      model.add(factor("tendon.strain factor", 0.1, 10, 0.5), {Meaning::Kind::scale, parts});
  model.add(candidate(model, "tendon", "tendon compliance",
                      "The tendons stretch more, or less, at the same force.",
                      EffectKind::structure, {x}, {{1.2}, {0.8}}));
}

// What the model already has is offered as its number. The deviation, a factor of two, is a
// judgement.
void addForceErrors(EncompassingModel& model, const MovingCoordinate& at) {
  constexpr double negligible = 1e-6;  // SI; a limit that only damps has a stiffness, too
  const auto offer = [&](const std::string& number, const std::string& words,
                         const std::string& force, const std::vector<const char*>& parameters) {
    std::vector<Meaning::Part> parts;
    for (const char* parameter : parameters)
      for (const Meaning::Part& part : model.numbers(force + "." + parameter))
        if (std::abs(model.valueOf(part)) > negligible) parts.push_back(part);
    if (parts.empty()) return;
    const std::string id = number + "_" + force;
    Meaning meaning{Meaning::Kind::scale, parts};
    if (parameters.size() == 1)
      meaning.parameter = model.parameters().find(force + "." + parameters.front());
    const std::size_t x = model.add(factor(id + " factor", 0.02, 50, 0.7), std::move(meaning));
    model.add(candidate(model, id, fmt::format("{} of {}", words, force),
                        fmt::format("The {} of the model's {} is wrong.", words, force),
                        EffectKind::parameter, {x}, {{1.2}, {0.8}}));
  };
  for (const SpringGeneralizedForce& spring : model.base().springForces) {
    if (!spring.enabled || spring.coordinate != at.coordinate.name) continue;
    offer("viscosity", "viscosity", spring.name, {"viscosity"});
    offer("stiffness", "stiffness", spring.name, {"stiffness"});
  }
  for (const CoordinateLimitForce& limit : model.base().limitForces) {
    if (!limit.enabled || limit.coordinate != at.coordinate.name) continue;
    offer("damping", "damping", limit.name, {"damping"});
    offer("stiffness", "stiffness", limit.name, {"upper_stiffness", "lower_stiffness"});
  }
}

void addWrapErrors(EncompassingModel& model) {
  for (const ModelParameter& parameter : model.parameters().parameters()) {
    const auto* wrap = std::get_if<WrapTarget>(&parameter.targets.front());
    if (!wrap || wrap->quantity != WrapTarget::Quantity::radius) continue;
    const std::string& name = model.base().wrapObjects[wrap->wrap].name;
    const double lower = std::max(-0.5 * parameter.value, parameter.lower - parameter.value);
    const double upper = std::min(parameter.value, parameter.upper - parameter.value);
    const std::size_t r =
        model.add(amplitude(fmt::format("wrap_{}.radius", name), "m", lower, upper, 0.006),
                  {Meaning::Kind::shift, model.numbers(parameter.name)});
    // near a path point the lengths turn so quickly that each start sees only what is next to it
    std::vector<std::vector<double>> starts;
    const auto startAt = [&](double share) {
      const double shift = share * parameter.value;
      if (shift > lower && shift < upper) starts.push_back({shift});
    };
    for (const double share : {0.06, -0.06, -0.36, -0.26, -0.15, 0.13, 0.19}) startAt(share);
    for (double share = 0.25; share < 0.4; share += 0.0125) startAt(share);
    if (starts.empty()) starts.push_back({std::clamp(0.001, lower, upper)});
    model.add(
        candidate(model, "wrap_" + name, "radius of wrap object " + name,
                  fmt::format("The muscles that wrap over {} have different moment arms.", name),
                  EffectKind::geometry, {r}, starts));
  }
}

namespace {

/// Usual errors of a sensor: bound, prior sd and start of a fit, for its bias and its drift per
/// second. Judgements: a few degrees, millimetres or N m.
struct SensorSizes {
  double biasBound, biasSd, biasStart, driftBound, driftSd, driftStart;
  SensorSizes scaled(double by) const {
    return {by * biasBound,  by * biasSd,  by * biasStart,
            by * driftBound, by * driftSd, by * driftStart};
  }
};

SensorSizes sizesOf(const Observable& what, const std::string& unit) {
  constexpr SensorSizes angle{0.5, 0.1, 0.02, 0.1, 0.02, 0.003};
  constexpr SensorSizes shift{0.2, 0.02, 0.005, 0.02, 0.004, 0.0006};
  if (what.kind == Observable::Kind::fibreLength) return shift.scaled(0.25);
  if (what.kind == Observable::Kind::tendonForce) return angle.scaled(256);
  if (unit == "rad") return angle;
  if (unit == "m") return shift;
  if (unit == "rad/s") return angle.scaled(4);
  if (unit == "m/s") return shift.scaled(4);
  if (unit == "N·m") return angle.scaled(8);
  if (unit == "N") return angle.scaled(64);
  return angle;  // an activation
}

/// By what a model without muscles is larger than an elbow, in the unit of what is measured.
double largerThanAnElbow(const EncompassingModel& model, const Observable& what) {
  using Kind = Observable::Kind;
  if (model.system().numMuscles() > 0) return 1;
  for (const MovingCoordinate& at : model.coordinates()) {
    if (at.coordinate.name != what.object) continue;
    const CoordinateUnits units = unitsOf(model, at);
    const double shift = at.coordinate.isRotation ? 1 : 0.125;  // [m] that stand for 1 rad
    if (what.kind == Kind::coordinate) return units.length / shift;
    if (what.kind == Kind::speed) return units.speedSize / shift;
    if (what.kind == Kind::moment) return units.strength;
  }
  return 1;
}

}  // namespace

void addSensorErrors(EncompassingModel& model, std::size_t sensor) {
  const Observable& what = model.sensors()[sensor];
  const bool isOne = model.sensors().size() == 1;
  const std::string unit = unitOf(what, model.base());
  const auto add = [&](const char* id, std::string name, std::string sentence,
                       const std::string& of, double bound, double sd, double start,
                       Meaning::Kind kind, std::vector<std::string> equivalents = {}) {
    const double lowest = kind == Meaning::Kind::lag ? 0 : -bound;
    const std::string full = model.idOf(sensor, id);
    const std::size_t x =
        model.add(amplitude(full + ".value", of, lowest, bound, sd), {kind, {}, sensor});
    if (!isOne) {
      name += " of " + nameOf(what);
      sentence = nameOf(what) + ": " + sentence;
    }
    model.add(candidate(model, full, std::move(name), std::move(sentence), EffectKind::sensor, {x},
                        {{start}}, std::move(equivalents)));
  };
  const SensorSizes sizes = sizesOf(what, unit).scaled(largerThanAnElbow(model, what));
  const std::string thing = what.isCoordinate() ? "coordinate" : "true value";
  add("bias", "sensor bias", "The sensor's reading is off by a constant.", unit, sizes.biasBound,
      sizes.biasSd, sizes.biasStart, Meaning::Kind::bias);
  add("gain", "sensor gain", fmt::format("The sensor's reading is a multiple of the {}.", thing),
      "", 0.5, 0.1, 0.02, Meaning::Kind::gain);
  const bool hasMuscles = model.system().numMuscles() > 0;
  const std::string other = hasMuscles               ? "that of the EMG"
                            : model.drives().empty() ? "the trial's"
                                                     : "that of the commands";
  add("clock", "clock offset", "The sensor's clock is behind " + other + ".", "s", 0.2, 0.05, 0.01,
      Meaning::Kind::clock,
      isOne && hasMuscles ? std::vector<std::string>{"delay"} : std::vector<std::string>{});
  add("clock_rate", "clock rate",
      "The sensor's clock is slow relative to " + other +
          " (fast if negative): a sample with time stamp t was measured at (1 + rate) t.",
      "", 0.2, 0.03, 0.01, Meaning::Kind::rate);
  add("lag", "sensor lag", fmt::format("The sensor follows the {} with a first-order lag.", thing),
      "s", 0.3, 0.05, 0.01, Meaning::Kind::lag);
  add("drift", "sensor drift", "The sensor's reading drifts at a constant rate.",
      unit.empty() ? "1/s" : unit + "/s", sizes.driftBound, sizes.driftSd, sizes.driftStart,
      Meaning::Kind::drift);
}

}  // namespace bio::discover
