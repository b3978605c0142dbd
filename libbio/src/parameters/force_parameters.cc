#include <algorithm>
#include <cmath>

#include "parameters/parameter_collector.h"
#include "parameters/parameter_list.h"

namespace bio {
namespace {

void addForceNumbers(const Model& model, ForceNumberTarget::Of of, std::size_t index,
                     const std::string& force, ParameterList& list) {
  for (int k = 0; k < numForceNumbers(of); ++k) {
    const ForceNumberTarget target{of, index, k};
    const ForceNumberRule rule = forceNumberRule(model, target);
    if (rule.name.empty()) continue;
    list.add(force + "." + rule.name, rule.unit, rule.meaning, forceNumber(model, target),
             {rule.lower, rule.upper, rule.sd}, {target});
  }
}

// Of those of the model that the system has. One of the same name may be switched off.
template <class Given, class Acting>
void addActing(const Model& model, ForceNumberTarget::Of of, const Given& given,
               const Acting& acting, ParameterList& list) {
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (!given[i].enabled) continue;
    const bool acts = std::any_of(acting.begin(), acting.end(),
                                  [&](const auto& one) { return one.name == given[i].name; });
    if (acts) addForceNumbers(model, of, i, given[i].name, list);
  }
}

}  // namespace

double* limitForceValue(CoordinateLimitForce& force, int component) {
  double* const values[] = {&force.upperLimit,     &force.upperStiffness, &force.lowerLimit,
                            &force.lowerStiffness, &force.damping,        &force.transition};
  return values[component];
}
double* springForceValue(SpringGeneralizedForce& force, int component) {
  double* const values[] = {&force.stiffness, &force.restLength, &force.viscosity};
  return values[component];
}

void addForceParameters(const Model& model, const MusculoskeletalSystem& system,
                        ParameterList& list) {
  struct Rule {
    const char* name;
    const char* unit;
    bool isAngle;
  };
  constexpr Rule limitRules[] = {
      {"upper_limit", "rad", true},    {"upper_stiffness", "N m/rad", false},
      {"lower_limit", "rad", true},    {"lower_stiffness", "N m/rad", false},
      {"damping", "N m s/rad", false}, {"transition", "rad", false}};
  constexpr Rule springRules[] = {{"stiffness", "N m/rad", false},
                                  {"rest_length", "rad", true},
                                  {"viscosity", "N m s/rad", false}};
  const auto addForce = [&](const std::string& name, const Rule& rule, double value,
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
    for (int k = 0; k < 6; ++k) {
      addForce(force.name, limitRules[k], *limitForceValue(force, k), LimitForceTarget{i, k});
      if (k == 5) list.last().lower = 0.05 * force.transition;
    }
  }
  for (std::size_t i = 0; i < model.springForces.size(); ++i) {
    SpringGeneralizedForce force = model.springForces[i];
    if (!force.enabled || system.skeleton().indexOf(force.coordinate) < 0) continue;
    for (int k = 0; k < 3; ++k) {
      addForce(force.name, springRules[k], *springForceValue(force, k), SpringForceTarget{i, k});
    }
  }
  using OfForce = ForceNumberTarget::Of;
  for (std::size_t i = 0; i < model.pointSprings.size(); ++i) {
    if (system.bodyForces().hasSpring(i)) {
      addForceNumbers(model, OfForce::pointSpring, i, model.pointSprings[i].name, list);
    }
  }
  for (std::size_t i = 0; i < model.bushings.size(); ++i) {
    if (system.bodyForces().hasBushing(i))
      addForceNumbers(model, OfForce::bushing, i, model.bushings[i].name, list);
  }
  addActing(model, OfForce::elasticPath, model.elasticPaths, system.elasticPaths(), list);
  addActing(model, OfForce::actuator, model.actuators, system.actuators(), list);
}

}  // namespace bio
