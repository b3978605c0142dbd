#include <fmt/format.h>

#include <algorithm>

#include "discovery/effects/effects.h"

// Forces that depend on the position alone. Priors: passive elbows (AIST database after Engin &
// Chen 1987; MacKay et al. 1986), 0.5 to 3 N·m/rad in the middle, stiffer towards the ends. Of the
// exponential law (a double exponential, as models of passive joints usually have) the rate's prior
// is a judgement.

namespace bio::discover {
namespace {

/// What stops the coordinate at its ends in the model already; empty: nothing.
std::string limitOf(const EncompassingModel& model) {
  for (const CoordinateLimitForce& limit : model.base().limitForces) {
    if (!limit.enabled || limit.coordinate != model.coordinate().name) continue;
    const bool dampsOnly = std::max(limit.upperStiffness, limit.lowerStiffness) < 1e-3;
    if (!dampsOnly) return limit.name;
  }
  return {};
}

}  // namespace

void addStiffness(EncompassingModel& model) {
  for (const SpringGeneralizedForce& spring : model.base().springForces) {
    const bool here = spring.enabled && spring.coordinate == model.coordinate().name;
    if (here && spring.stiffness != 0) return model.addPresent("stiffness", spring.name);
  }
  const Coordinate& q = model.coordinate();
  const CoordinateUnits units = unitsOf(model);
  const double size = units.strength / units.length, span = q.rangeMax - q.rangeMin;
  const std::size_t law =
      model.addLaw(SpringGeneralizedForce{lawName(model, "stiffness"), model.coordinate().name});
  const std::size_t k =
      model.add(amplitude("stiffness.stiffness", units.stiffness(), 0, 10 * size, 2 * size),
                {Meaning::Kind::shift, {{model.number(SpringForceTarget{law, 0}, 0)}}});
  const std::size_t rest = model.add(
      shape("stiffness.rest", units.position, model.middle(), q.rangeMin, q.rangeMax, 0.3 * span),
      {Meaning::Kind::shift, {{model.number(SpringForceTarget{law, 1}, 0)}}});
  model.lawFollows({k, rest});
  model.add(candidate(model, "stiffness", "joint stiffness",
                      "A spring pulls the joint towards a rest position.",
                      info::discover::EffectKind::structure, {k, rest},
                      {{0.5 * size, model.middle()},
                       {0.5 * size, q.rangeMin + 0.2 * span},
                       {0.5 * size, q.rangeMax - 0.2 * span}}));
}

void addLimits(EncompassingModel& model) {
  if (const std::string limit = limitOf(model); !limit.empty()) {
    return model.addPresent("limit", limit);
  }
  const Coordinate& q = model.coordinate();
  const CoordinateUnits units = unitsOf(model);
  const double size = units.strength / units.length, span = q.rangeMax - q.rangeMin;
  const std::size_t law =
      model.addLaw(CoordinateLimitForce{lawName(model, "limit"), model.coordinate().name});
  const auto number = [&](int component) {
    return model.number(LimitForceTarget{law, component}, 0);
  };
  const std::size_t K =
      model.add(amplitude("limit.stiffness", units.stiffness(), 0, 100 * size, 10 * size),
                {Meaning::Kind::shift, {{number(1)}, {number(3)}}});
  // tissue leaves the middle fifth of the range free: else this is a stiffness that grows
  const double upperAt = q.rangeMax - 0.2 * span, lowerAt = q.rangeMin + 0.2 * span,
               free = 0.1 * span;
  const std::size_t upper = model.add(
      shape("limit.upper", units.position, upperAt, model.middle() + free, q.rangeMax, 0.15 * span),
      {Meaning::Kind::shift, {{number(0)}}});
  const std::size_t lower = model.add(
      shape("limit.lower", units.position, lowerAt, q.rangeMin, model.middle() - free, 0.15 * span),
      {Meaning::Kind::shift, {{number(2)}}});
  const std::size_t transition = model.add(
      shape("limit.transition", units.position, 0.2 * span, 0.05 * span, span, 0.1 * span),
      {Meaning::Kind::shift, {{number(5)}}});
  model.lawFollows({K, upper, lower, transition});
  std::vector<std::vector<double>> starts;
  for (const double inward : {0.2, 0.3, 0.1}) {
    starts.push_back(
        {3 * size, q.rangeMax - inward * span, q.rangeMin + inward * span, 0.2 * span});
  }
  model.add(candidate(
      model, "limit", "passive joint limits",
      "Passive tissue increasingly resists motion towards both ends of the joint's range.",
      info::discover::EffectKind::structure, {K, upper, lower, transition}, starts));
}

void addExponentialLimits(EncompassingModel& model) {
  if (const std::string limit = limitOf(model); !limit.empty()) {
    return model.addPresent("limit_exp", limit);
  }
  const Coordinate& q = model.coordinate();
  const CoordinateUnits units = unitsOf(model);
  const double size = units.strength, per = 1 / units.length;
  const double span = q.rangeMax - q.rangeMin, middle = model.middle();
  addExpression(
      model,
      {"limit_exp",
       "exponential passive joint limits",
       fmt::format("Passive tissue resists motion with a {} that grows exponentially "
                   "towards both ends of the joint's range.",
                   units.word),
       fmt::format("c*(exp(-k*(q-r+{0}))-exp(k*(q-r-{0})))", 0.5 * span),
       {"c", "k", "r"},
       {amplitude("limit_exp." + units.word, units.force + " half a range from rest", 0, 200 * size,
                  5 * size),
        shape("limit_exp.rate", "1/" + units.position, 6 * per, 2 * per, 25 * per, 3 * per),
        shape("limit_exp.rest", units.position, middle, middle - 0.3 * span, middle + 0.3 * span,
              0.15 * span)},
       {{1 * size, 6 * per, middle}, {2 * size, 4 * per, middle}, {2 * size, 10 * per, middle}}});
}

}  // namespace bio::discover
