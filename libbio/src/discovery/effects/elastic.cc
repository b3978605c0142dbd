#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "discovery/effects/effects.h"

// Forces that depend on the position alone. Priors: passive elbows (AIST database after Engin &
// Chen 1987; MacKay et al. 1986), 0.5 to 3 N·m/rad in the middle, stiffer towards the ends. Of the
// exponential law (a double exponential, as models of passive joints usually have) the rate's prior
// is a judgement. Engin & Chen fit a cubic of the extension angle; 2 N·m/rad³ are as stiff as
// 3 N·m/rad at 0.7 rad from rest.

namespace bio::discover {
namespace {

/// Name of the limit force that already stops the coordinate at its ends; empty: none.
std::string limitOf(const EncompassingModel& model, const MovingCoordinate& at) {
  for (const CoordinateLimitForce& limit : model.base().limitForces) {
    if (!limit.enabled || limit.coordinate != at.coordinate.name) continue;
    const bool dampsOnly = std::max(limit.upperStiffness, limit.lowerStiffness) < 1e-3;
    if (!dampsOnly) return limit.name;
  }
  return {};
}

/// Without muscles a range is often a reader's default, and a spring is mounted for its middle as a
/// rule: half of the prior is there.
info::discover::Quantity restOf(const EncompassingModel& model, info::discover::Quantity rest) {
  if (model.system().numMuscles() == 0) rest.nominalShare = 0.5;
  return rest;
}

std::string resistingPart(const EncompassingModel& model) {
  return model.system().numMuscles() > 0 ? "Passive tissue" : "Something passive";
}

}  // namespace

void addStiffness(EncompassingModel& model, const MovingCoordinate& at) {
  for (const SpringGeneralizedForce& spring : model.base().springForces) {
    const bool here = spring.enabled && spring.coordinate == at.coordinate.name;
    if (here && spring.stiffness != 0)
      return model.addPresent(model.idAt(at, "stiffness"), spring.name);
  }
  const Coordinate& q = at.coordinate;
  const CoordinateUnits units = unitsOf(model, at);
  const double size = units.strength / units.length, span = q.rangeMax - q.rangeMin;
  const std::size_t law =
      model.addLaw(SpringGeneralizedForce{lawName(at, "stiffness"), at.coordinate.name});
  const std::size_t k = model.add(
      amplitude(model.idAt(at, "stiffness.stiffness"), units.stiffness(), 0, 10 * size, 2 * size),
      {Meaning::Kind::shift,
       {{model.number(SpringForceTarget{law, SpringForceTarget::Quantity::stiffness}, 0)}}});
  const std::size_t rest = model.add(
      restOf(model, shape(model.idAt(at, "stiffness.rest"), units.position, at.middle(), q.rangeMin,
                          q.rangeMax, 0.3 * span)),
      {Meaning::Kind::shift,
       {{model.number(SpringForceTarget{law, SpringForceTarget::Quantity::restLength}, 0)}}});
  model.lawFollows({k, rest});
  model.add(candidateAt(model, at, "stiffness", "joint stiffness",
                        "A spring pulls the joint towards a rest position.", {k, rest},
                        {{0.5 * size, at.middle()},
                         {0.5 * size, q.rangeMin + 0.2 * span},
                         {0.5 * size, q.rangeMax - 0.2 * span}}));
}

void addCubicStiffness(EncompassingModel& model, const MovingCoordinate& at) {
  const Coordinate& q = at.coordinate;
  const CoordinateUnits units = unitsOf(model, at);
  const double size = units.strength / std::pow(units.length, 3);
  const double span = q.rangeMax - q.rangeMin, middle = at.middle();
  addExpression(model, at,
                {"cubic",
                 "cubic joint stiffness",
                 fmt::format("A passive {} pulls the joint towards a rest position and grows with "
                             "the cube of the distance from it.",
                             units.word),
                 "-k*(q-r)^3",
                 {"k", "r"},
                 {amplitude("cubic.stiffness", fmt::format("{}/{}^3", units.force, units.position),
                            0, 20 * size, 2 * size),
                  restOf(model, shape("cubic.rest", units.position, middle, middle - 0.3 * span,
                                      middle + 0.3 * span, 0.15 * span))},
                 {{0.5 * size, middle},
                  {0.5 * size, middle - 0.15 * span},
                  {0.5 * size, middle + 0.15 * span}}});
}

void addLimits(EncompassingModel& model, const MovingCoordinate& at) {
  if (const std::string limit = limitOf(model, at); !limit.empty()) {
    return model.addPresent(model.idAt(at, "limit"), limit);
  }
  const Coordinate& q = at.coordinate;
  const CoordinateUnits units = unitsOf(model, at);
  const double size = units.strength / units.length, span = q.rangeMax - q.rangeMin;
  const std::size_t law =
      model.addLaw(CoordinateLimitForce{lawName(at, "limit"), at.coordinate.name});
  using Quantity = LimitForceTarget::Quantity;
  const auto number = [&](Quantity quantity) {
    return model.number(LimitForceTarget{law, quantity}, 0);
  };
  const std::size_t K = model.add(
      amplitude(model.idAt(at, "limit.stiffness"), units.stiffness(), 0, 100 * size, 10 * size),
      {Meaning::Kind::shift,
       {{number(Quantity::upperStiffness)}, {number(Quantity::lowerStiffness)}}});
  // tissue leaves the middle fifth of the range free: else this is a stiffness that grows
  const double upperAt = q.rangeMax - 0.2 * span, lowerAt = q.rangeMin + 0.2 * span,
               free = 0.1 * span;
  const std::size_t upper = model.add(shape(model.idAt(at, "limit.upper"), units.position, upperAt,
                                            at.middle() + free, q.rangeMax, 0.15 * span),
                                      {Meaning::Kind::shift, {{number(Quantity::upperLimit)}}});
  const std::size_t lower = model.add(shape(model.idAt(at, "limit.lower"), units.position, lowerAt,
                                            q.rangeMin, at.middle() - free, 0.15 * span),
                                      {Meaning::Kind::shift, {{number(Quantity::lowerLimit)}}});
  const std::size_t transition =
      model.add(shape(model.idAt(at, "limit.transition"), units.position, 0.2 * span, 0.05 * span,
                      span, 0.1 * span),
                {Meaning::Kind::shift, {{number(Quantity::transition)}}});
  model.lawFollows({K, upper, lower, transition});
  std::vector<std::vector<double>> starts;
  for (const double inward : {0.2, 0.3, 0.1}) {
    starts.push_back(
        {3 * size, q.rangeMax - inward * span, q.rangeMin + inward * span, 0.2 * span});
  }
  model.add(candidateAt(
      model, at, "limit", "passive joint limits",
      resistingPart(model) + " increasingly resists motion towards both ends of the joint's range.",
      {K, upper, lower, transition}, starts));
}

void addExponentialLimits(EncompassingModel& model, const MovingCoordinate& at) {
  if (const std::string limit = limitOf(model, at); !limit.empty()) {
    return model.addPresent(model.idAt(at, "limit_exp"), limit);
  }
  const Coordinate& q = at.coordinate;
  const CoordinateUnits units = unitsOf(model, at);
  const double size = units.strength, per = 1 / units.length;
  const double span = q.rangeMax - q.rangeMin, middle = at.middle();
  addExpression(
      model, at,
      {"limit_exp",
       "exponential passive joint limits",
       fmt::format("{} resists motion with a {} that grows exponentially "
                   "towards both ends of the joint's range.",
                   resistingPart(model), units.word),
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
