#include "parameters/parameter_collector.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "bio/path/path_gradient.h"
#include "bio/path/posture_samples.h"
#include "bio/path/radius_limit.h"
#include "parameters/hill_prior.h"
#include "parameters/muscle_rules.h"

namespace bio {
namespace {

using std::numbers::pi;

/// What is taken for granted about a kind of quantity: bounds, and how well it is known beforehand.
struct DefaultPrior {
  double lower, upper, sd;
};
/// A positive quantity: bounds and deviation as fractions of its value.
DefaultPrior around(double value, double lower, double upper, double sd) {
  return {value * lower, value * upper, value * sd};
}
/// A position [m].
DefaultPrior position(double value, double sd = 0.005) {
  return {value - 0.03, value + 0.03, sd};
}

const char* axisName(int axis) {
  constexpr const char* names[] = {"x", "y", "z"};
  return names[axis];
}

class Collector {
 public:
  Collector(const Model& model, const MusculoskeletalSystem& arm, const StartPoint& start,
            const EmgMapping& mapping)
      : model_(model), arm_(arm), start_(start), mapping_(mapping) {}

  std::vector<ModelParameter> collect() {
    for (std::size_t i = 0; i < arm_.numMuscles(); ++i) addMuscle(arm_.muscles()[i]);
    for (std::size_t i = 0; i < arm_.numMuscles(); ++i) addPoints(arm_.muscles()[i]);
    addWraps();
    addBodies();
    addForces();
    addEmg();
    addStart();
    addGroups();
    addLatent();  // last: their number differs between trials
    return std::move(parameters_);
  }

 private:
  void add(std::string name, const char* unit, std::string meaning, double value,
           DefaultPrior habit, std::vector<ParameterTarget> targets, bool isGroup = false) {
    parameters_.push_back({std::move(name), unit, std::move(meaning), value,
                           std::min(habit.lower, value), std::max(habit.upper, value), habit.sd,
                           std::move(targets), isGroup});
  }

  std::size_t indexOf(const std::string& muscle) const {
    for (std::size_t i = 0; i < model_.muscles.size(); ++i) {
      if (model_.muscles[i].name == muscle) return i;
    }
    throw std::invalid_argument(fmt::format("the model has no muscle called '{}'", muscle));
  }

  void addMuscle(const SystemMuscle& muscle) {
    const std::size_t index = indexOf(muscle.name);
    if (!model_.muscles[index].schutte) return addHill(index);
    const SchutteParameters& schutte = *model_.muscles[index].schutte;
    for (const MuscleRule& rule : muscleRules) {
      if (rule.quantity == MuscleQuantity::passiveForceScale && !schutte.passiveForceLength) {
        continue;  // a law without numbers
      }
      const double value = rule.member ? schutte.*rule.member : 1.0;
      const DefaultPrior habit = rule.quantity == MuscleQuantity::pennation
                                     ? DefaultPrior{0, 1.2, 0.05}
                                     : around(value, rule.lower, rule.upper, rule.sd);
      add(muscle.name + "." + rule.name, rule.unit, rule.meaning, value, habit,
          {MuscleTarget{index, rule.quantity}});
    }
  }

  // A muscle of another class, by the table of its class.
  void addHill(std::size_t index) {
    const Muscle& muscle = model_.muscles[index];
    std::visit(
        [&]<class Parameters>(const Parameters& p) {
          for (std::size_t i = 0; i < Parameters::count; ++i) {
            const HillPrior known = hillPrior(p, i);
            if (!known.counts) continue;
            const auto& property = Parameters::properties[i];
            const bool isPennation = i == muscles::common::pennation;
            add(fmt::format("{}.{}", muscle.name, isPennation ? "pennation_angle" : property.name),
                property.unit.data(), fmt::format("of a {}", muscle.className), p.at(p, i),
                {known.lower, known.upper, known.sd}, {MuscleNumberTarget{index, i}});
          }
        },
        *muscle.hill);
  }

  void addPoints(const SystemMuscle& muscle) {
    const std::size_t index = indexOf(muscle.name);
    const PathGradients gradients(model_, arm_.skeleton(), model_.muscles[index], muscle.path);
    const auto& points = model_.muscles[index].path.points;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!gradients.isUsed(i)) continue;
      for (int axis = 0; axis < 3; ++axis) {
        const double value = muscle.path.parameters().points[i][axis];
        add(fmt::format("{}.point{}.{}", muscle.name, i + 1, axisName(axis)), "m",
            fmt::format("path point {} in {}", points[i].name, points[i].body), value,
            position(value), {PointTarget{index, i, axis}});
      }
    }
    const auto& wraps = model_.muscles[index].path.wraps;
    for (std::size_t i = 0; i < wraps.size(); ++i) {
      if (!gradients.mayTouch(i)) continue;
      const auto known = [&](const TouchedWrap& wrap) { return wrap.name == wraps[i].wrapObject; };
      if (std::any_of(touched_.begin(), touched_.end(), known)) continue;
      const auto& surfaces = muscle.path.compiled().surfaces;
      const auto surface = std::find_if(surfaces.begin(), surfaces.end(),
                                        [&](const PathSurface& each) { return each.wrap == i; });
      touched_.push_back(
          {wraps[i].wrapObject, muscle.path.parameters().radii[i], surface->general});
    }
  }

  // A radius ends where a point of a path over the wrap object comes inside.
  void limitRadius(ModelParameter& radius, const std::string& wrapObject, int number = 0) {
    for (const SystemMuscle& muscle : arm_.muscles()) {
      const Muscle& given = model_.muscles[indexOf(muscle.name)];
      const Path& path = given.path;
      for (std::size_t i = 0; i < path.wraps.size(); ++i) {
        if (path.wraps[i].wrapObject != wrapObject) continue;
        const RadiusLimit limit =
            radiusLimit(muscle.path.compiled(), i, postures_.of(given), number);
        if (!(limit.radius < radius.limit)) continue;
        radius.limit = limit.radius;
        radius.whyLimited =
            fmt::format("{}'s {}", muscle.name, describe(limit, path, arm_.skeleton()));
      }
    }
    constexpr double margin = 0.005;
    radius.upper = std::max(radius.value, std::min(radius.upper, (1 - margin) * radius.limit));
  }

  void addWraps() {
    for (const TouchedWrap& touched : touched_) {
      std::size_t index = 0;
      while (model_.wrapObjects[index].name != touched.name) ++index;
      const WrapObject& wrap = model_.wrapObjects[index];
      const double radius = touched.radius;
      if (touched.general) {
        addNumbers(index, *touched.general);
      } else {
        add(wrap.name + ".radius", "m", fmt::format("radius of the wrap object in {}", wrap.body),
            radius, around(radius, 0.3, 2, 0.15), {WrapTarget{index, 0}});
        limitRadius(parameters_.back(), wrap.name);
      }
      for (int axis = 0; axis < 3; ++axis) {
        const double value = wrap.frame.translation[axis];
        add(fmt::format("{}.translation.{}", wrap.name, axisName(axis)), "m",
            fmt::format("position of the wrap object in {}", wrap.body), value, position(value),
            {WrapTarget{index, 1 + axis}});
      }
      const bool isSphere = wrap.shape == WrapShape::sphere ||
                            (wrap.shape == WrapShape::ellipsoid && !touched.general &&
                             (wrap.semiAxes.array() - radius).abs().maxCoeff() <= 1e-9 * radius);
      for (int axis = 0; axis < 3 && !isSphere; ++axis) {
        const double value = wrap.frame.orientation[axis];
        add(fmt::format("{}.rotation.{}", wrap.name, axisName(axis)), "rad",
            fmt::format("orientation of the wrap object in {} (body-fixed x-y-z)", wrap.body),
            value, {value - 0.6, value + 0.6, 0.1}, {WrapTarget{index, 4 + axis}});
      }
    }
  }

  // The semi-axes of an ellipsoid, the radii of a torus.
  void addNumbers(std::size_t index, const Surface& surface) {
    const WrapObject& wrap = model_.wrapObjects[index];
    const bool isTorus = wrap.shape == WrapShape::torus;
    constexpr const char* ofTorus[] = {"outer_radius", "inner_radius"};
    for (int n = 0; n < numNumbersOf(surface); ++n) {
      const double value = std::visit([&](const auto& each) { return each.number(n); }, surface);
      const std::string name = isTorus ? ofTorus[n] : fmt::format("semi_axis.{}", axisName(n));
      add(fmt::format("{}.{}", wrap.name, name), "m",
          fmt::format("{} of the wrap object in {}", isTorus ? "radius" : "semi-axis", wrap.body),
          value, around(value, 0.3, 2, 0.15), {WrapTarget{index, 7 + n}});
      ModelParameter& number = parameters_.back();
      limitRadius(number, wrap.name, n);
      if (!isTorus) continue;
      // a torus keeps its hole
      constexpr double hole = 1.05;
      if (n == 0) number.lower = std::max(number.lower, hole * wrap.radius);
      if (n == 1) number.upper = std::max(value, std::min(number.upper, wrap.outerRadius / hole));
    }
  }

  void addBodies() {
    for (std::size_t i = 0; i < model_.bodies.size(); ++i) {
      const Body& body = model_.bodies[i];
      if (arm_.skeleton().placeOf(body.name).segment == 0) continue;
      const double large = body.mass > 0 ? 5 * body.mass : 1;
      add(body.name + ".mass", "kg", "mass", body.mass,
          {0, large, std::max(0.15 * body.mass, 1e-3)}, {BodyTarget{i, 0}});
      for (int axis = 0; axis < 3; ++axis) {
        const double value = body.massCenter[axis];
        add(fmt::format("{}.mass_center.{}", body.name, axisName(axis)), "m",
            "mass centre in the body", value, {value - 0.1, value + 0.1, 0.01},
            {BodyTarget{i, 1 + axis}});
      }
      constexpr const char* names[] = {"xx", "yy", "zz", "xy", "xz", "yz"};
      const double largest = std::max({body.inertia[0], body.inertia[1], body.inertia[2], 1e-6});
      for (int k = 0; k < 6; ++k) {
        const double value = body.inertia[static_cast<std::size_t>(k)];
        const DefaultPrior habit =
            k < 3 ? DefaultPrior{0, value + 4 * largest, 0.3 * largest}
                  : DefaultPrior{value - largest, value + largest, 0.1 * largest};
        add(fmt::format("{}.inertia.{}", body.name, names[k]), "kg m²",
            "inertia about the mass centre, body axes", value, habit, {BodyTarget{i, 4 + k}});
      }
    }
  }

  void addForces() {
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
      const DefaultPrior habit = rule.isAngle ? DefaultPrior{value - 1.5, value + 1.5, 0.1}
                                              : DefaultPrior{0, 10 * spread, 0.5 * spread};
      add(name + "." + rule.name, rule.unit, "constant of the coordinate's passive force", value,
          habit, {target});
    };
    for (std::size_t i = 0; i < model_.limitForces.size(); ++i) {
      CoordinateLimitForce force = model_.limitForces[i];
      if (!force.enabled || arm_.skeleton().indexOf(force.coordinate) < 0) continue;
      for (int k = 0; k < 6; ++k) {
        addForce(force.name, limitRules[k], *limitForceValue(force, k), LimitForceTarget{i, k});
        if (k == 5) parameters_.back().lower = 0.05 * force.transition;
      }
    }
    for (std::size_t i = 0; i < model_.springForces.size(); ++i) {
      SpringGeneralizedForce force = model_.springForces[i];
      if (!force.enabled || arm_.skeleton().indexOf(force.coordinate) < 0) continue;
      for (int k = 0; k < 3; ++k) {
        addForce(force.name, springRules[k], *springForceValue(force, k), SpringForceTarget{i, k});
      }
    }
    using OfForce = ForceNumberTarget::Of;
    for (std::size_t i = 0; i < model_.pointSprings.size(); ++i) {
      if (arm_.bodyForces().hasSpring(i)) {
        addNumbersOf(OfForce::pointSpring, i, model_.pointSprings[i].name);
      }
    }
    for (std::size_t i = 0; i < model_.bushings.size(); ++i) {
      if (arm_.bodyForces().hasBushing(i))
        addNumbersOf(OfForce::bushing, i, model_.bushings[i].name);
    }
    addNamed(OfForce::elasticPath, model_.elasticPaths, arm_.elasticPaths());
    addNamed(OfForce::actuator, model_.actuators, arm_.actuators());
  }

  // Of those of the model that the system has. One of the same name may be switched off.
  template <class Given, class Acting>
  void addNamed(ForceNumberTarget::Of of, const Given& given, const Acting& acting) {
    for (std::size_t i = 0; i < given.size(); ++i) {
      if (!given[i].enabled) continue;
      const bool acts = std::any_of(acting.begin(), acting.end(),
                                    [&](const auto& one) { return one.name == given[i].name; });
      if (acts) addNumbersOf(of, i, given[i].name);
    }
  }

  void addNumbersOf(ForceNumberTarget::Of of, std::size_t index, const std::string& force) {
    for (int k = 0; k < numForceNumbers(of); ++k) {
      const ForceNumberTarget target{of, index, k};
      const ForceNumberRule rule = forceNumberRule(model_, target);
      if (rule.name.empty()) continue;
      add(force + "." + rule.name, rule.unit, rule.meaning, forceNumber(model_, target),
          {rule.lower, rule.upper, rule.sd}, {target});
    }
  }

  void addEmg() {
    for (const SystemMuscle& muscle : arm_.muscles()) {
      const auto at = mapping_.gain.find(muscle.name);
      const double gain = at == mapping_.gain.end() ? 1.0 : at->second;
      add(fmt::format("emg.{}.gain", muscle.name), "", "factor on the trial's excitation", gain,
          {0, 5, 0.2}, {EmgTarget{EmgTarget::What::gain, muscle.name}});
    }
    add("emg.delay", "s", "electromechanical delay", mapping_.delay, {0, 0.2, 0.02},
        {EmgTarget{EmgTarget::What::delay, ""}});
    add("emg.nonlinearity", "", "shape A of the EMG–excitation relation; 0: linear",
        mapping_.nonlinearity, {-3, 0, 1}, {EmgTarget{EmgTarget::What::nonlinearity, ""}});
  }

  void addLatent() {
    constexpr double most = 10;
    for (const auto& [muscle, latent] : mapping_.latent) {
      for (std::size_t k = 0; k < latent.knots.size(); ++k) {
        add(fmt::format("emg.{}.latent{}", muscle, k + 1), "",
            fmt::format("correction of the excitation's log-odds at {:.4g} s", latent.knots[k]),
            latent.values[static_cast<Eigen::Index>(k)], {-most, most, latent.sd},
            {EmgTarget{EmgTarget::What::latent, muscle, "", k}});
      }
    }
  }

  void addStart() {
    const auto& coordinates = arm_.skeleton().coordinates();
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      if (arm_.isPrescribed(static_cast<int>(i))) continue;
      const bool turns = coordinates[i].isRotation;
      const double value = start_.q[k];
      const double wide = turns ? pi : 1;
      add("initial." + coordinates[i].name, turns ? "rad" : "m", "coordinate at the start", value,
          {std::max(coordinates[i].rangeMin, value - wide),
           std::min(coordinates[i].rangeMax, value + wide), turns ? 0.035 : 0.005},
          {InitialTarget{static_cast<int>(i), false}});
    }
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      if (arm_.isPrescribed(static_cast<int>(i))) continue;
      const bool turns = coordinates[i].isRotation;
      add("initial." + coordinates[i].name + ".speed", turns ? "rad/s" : "m/s",
          "speed at the start", start_.qDot.size() ? start_.qDot[k] : 0.0,
          {turns ? -10.0 : -2.0, turns ? 10.0 : 2.0, turns ? 0.1 : 0.02},
          {InitialTarget{static_cast<int>(i), true}});
    }
  }

  /// One number for all muscles, where it is the same in all.
  void addGroups() {
    addGroup("activation.time_scale", "time_scale", "time scale of all muscles");
    addGroup("activation.activation1", "activation1", "activation1 of all muscles");
    addGroup("activation.activation2", "activation2", "activation2 of all muscles");
    addGroup("activation.activation_time_constant", "activation_time_constant",
             "time constant of rising activation of all muscles");
    addGroup("activation.deactivation_time_constant", "deactivation_time_constant",
             "time constant of falling activation of all muscles");
    addGroup("muscles.fiber_damping", "fiber_damping", "damping of all muscles");
    addGroup("muscles.damping", "damping", "damping of all muscles");
    addGroup("muscles.tendon_strain_scale", "tendon_strain_scale", "compliance of all tendons");
    addGroup("muscles.active_force_scale", "active_force_scale", "strength of all muscles");
    addGroup("emg.gain", "gain", "factor on all excitations");
  }
  void addGroup(const char* name, const std::string& quantity, const char* meaning) {
    ModelParameter group;
    for (const ModelParameter& parameter : parameters_) {
      const bool isMember =
          !parameter.isGroup && parameter.name.ends_with("." + quantity) &&
          (std::holds_alternative<MuscleTarget>(parameter.targets.front()) ||
           std::holds_alternative<MuscleNumberTarget>(parameter.targets.front()) ||
           std::holds_alternative<EmgTarget>(parameter.targets.front()));
      if (!isMember) continue;
      if (group.targets.empty()) {
        group = parameter;
      } else if (parameter.value != group.value) {
        return;
      } else {
        group.targets.push_back(parameter.targets.front());
      }
    }
    if (group.targets.size() < 2) return;
    group.name = name;
    group.meaning = meaning;
    group.isGroup = true;
    parameters_.push_back(std::move(group));
  }

  struct TouchedWrap {
    std::string name;
    double radius;
    std::optional<Surface> general;
  };

  const Model& model_;
  const MusculoskeletalSystem& arm_;
  const StartPoint& start_;
  const EmgMapping& mapping_;
  std::vector<TouchedWrap> touched_;
  PostureSamples postures_{model_, arm_.skeleton()};
  std::vector<ModelParameter> parameters_;
};

}  // namespace

SchutteNumber schutteNumber(MuscleQuantity quantity) {
  for (const MuscleRule& rule : muscleRules) {
    if (rule.quantity == quantity) return rule.member;
  }
  return nullptr;
}

double* limitForceValue(CoordinateLimitForce& force, int component) {
  double* const values[] = {&force.upperLimit,     &force.upperStiffness, &force.lowerLimit,
                            &force.lowerStiffness, &force.damping,        &force.transition};
  return values[component];
}
double* springForceValue(SpringGeneralizedForce& force, int component) {
  double* const values[] = {&force.stiffness, &force.restLength, &force.viscosity};
  return values[component];
}

std::vector<ModelParameter> collectParameters(const Model& model, const MusculoskeletalSystem& arm,
                                              const StartPoint& start, const EmgMapping& mapping) {
  return Collector(model, arm, start, mapping).collect();
}

}  // namespace bio
