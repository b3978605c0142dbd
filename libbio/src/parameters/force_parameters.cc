#include <algorithm>
#include <cmath>

#include "parameters/parameter_collector.h"
#include "parameters/parameter_list.h"

namespace bio {
namespace {

void addForceNumbers(const Model& model, ForceNumberTarget::Kind kind, std::size_t index,
                     const std::string& force, ParameterList& list) {
  for (int k = 0; k < numForceNumbers(kind); ++k) {
    const ForceNumberTarget target{kind, index, k};
    const ForceNumberRule rule = forceNumberRule(model, target);
    if (rule.name.empty()) continue;
    list.add(force + "." + rule.name, rule.unit, rule.meaning, forceNumber(model, target),
             {rule.lower, rule.upper, rule.sd}, {target});
  }
}

// Of those of the model that the system has. One of the same name may be switched off.
template <class Given, class Acting>
void addActing(const Model& model, ForceNumberTarget::Kind kind, const Given& given,
               const Acting& acting, ParameterList& list) {
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (!given[i].enabled) continue;
    const bool acts = std::any_of(acting.begin(), acting.end(),
                                  [&](const auto& one) { return one.name == given[i].name; });
    if (acts) addForceNumbers(model, kind, i, given[i].name, list);
  }
}

/// OpenSim's name of a number of a coordinate's passive force.
template <class Quantity>
struct Rule {
  Quantity quantity;
  const char* name;
  const char* unit;
  bool isAngle;
};

}  // namespace

double& limitForceNumber(CoordinateLimitForce& force, LimitForceTarget::Quantity quantity) {
  double* const numbers[] = {&force.upperLimit,     &force.upperStiffness, &force.lowerLimit,
                             &force.lowerStiffness, &force.damping,        &force.transition};
  return *numbers[static_cast<std::size_t>(quantity)];
}
double& springForceNumber(SpringGeneralizedForce& force, SpringForceTarget::Quantity quantity) {
  double* const numbers[] = {&force.stiffness, &force.restLength, &force.viscosity};
  return *numbers[static_cast<std::size_t>(quantity)];
}

void addForceParameters(const Model& model, const MusculoskeletalSystem& system,
                        ParameterList& list) {
  using Limit = LimitForceTarget::Quantity;
  using Spring = SpringForceTarget::Quantity;
  constexpr Rule<Limit> limitRules[] = {
      {Limit::upperLimit, "upper_limit", "rad", true},
      {Limit::upperStiffness, "upper_stiffness", "N m/rad", false},
      {Limit::lowerLimit, "lower_limit", "rad", true},
      {Limit::lowerStiffness, "lower_stiffness", "N m/rad", false},
      {Limit::damping, "damping", "N m s/rad", false},
      {Limit::transition, "transition", "rad", false}};
  constexpr Rule<Spring> springRules[] = {{Spring::stiffness, "stiffness", "N m/rad", false},
                                          {Spring::restLength, "rest_length", "rad", true},
                                          {Spring::viscosity, "viscosity", "N m s/rad", false}};
  const auto addForce = [&](const std::string& name, const auto& rule, double value,
                            ParameterTarget target) {
    const double spread = std::max(std::abs(value), 1e-6);
    const DefaultPrior prior = rule.isAngle ? DefaultPrior{value - 1.5, value + 1.5, 0.1}
                                            : DefaultPrior{0, 10 * spread, 0.5 * spread};
    list.add(name + "." + rule.name, rule.unit, "constant of the coordinate's passive force", value,
             prior, {target});
  };
  for (std::size_t i = 0; i < model.limitForces.size(); ++i) {
    CoordinateLimitForce force = model.limitForces[i];
    if (!force.enabled || system.skeleton().indexOf(force.coordinate) < 0) continue;
    for (const auto& rule : limitRules) {
      addForce(force.name, rule, limitForceNumber(force, rule.quantity),
               LimitForceTarget{i, rule.quantity});
      if (rule.quantity == Limit::transition) list.last().lower = 0.05 * force.transition;
    }
  }
  for (std::size_t i = 0; i < model.springForces.size(); ++i) {
    SpringGeneralizedForce force = model.springForces[i];
    if (!force.enabled || system.skeleton().indexOf(force.coordinate) < 0) continue;
    for (const auto& rule : springRules) {
      addForce(force.name, rule, springForceNumber(force, rule.quantity),
               SpringForceTarget{i, rule.quantity});
    }
  }
  using Kind = ForceNumberTarget::Kind;
  for (std::size_t i = 0; i < model.pointSprings.size(); ++i) {
    if (system.bodyForces().hasSpring(i)) {
      addForceNumbers(model, Kind::pointSpring, i, model.pointSprings[i].name, list);
    }
  }
  for (std::size_t i = 0; i < model.bushings.size(); ++i) {
    if (system.bodyForces().hasBushing(i))
      addForceNumbers(model, Kind::bushing, i, model.bushings[i].name, list);
  }
  addActing(model, Kind::elasticPath, model.elasticPaths, system.elasticPaths(), list);
  addActing(model, Kind::actuator, model.actuators, system.actuators(), list);
}

}  // namespace bio
