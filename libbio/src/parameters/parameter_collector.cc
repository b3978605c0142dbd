#include "parameters/parameter_collector.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "bio/path/path_gradient.h"
#include "bio/path/posture_samples.h"
#include "bio/path/radius_limit.h"
#include "parameters/hill_prior.h"
#include "parameters/muscle_rules.h"
#include "parameters/parameter_list.h"

namespace bio {
namespace {

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
  Collector(const Model& model, const MusculoskeletalSystem& system, const StartPoint& start,
            const EmgMapping& mapping)
      : model_(model), system_(system), start_(start), mapping_(mapping) {}

  std::vector<ModelParameter> collect() {
    for (std::size_t i = 0; i < system_.numMuscles(); ++i) addMuscle(system_.muscles()[i]);
    for (std::size_t i = 0; i < system_.numMuscles(); ++i) addPoints(system_.muscles()[i]);
    addWraps();
    addBodies();
    addForceParameters(model_, system_, list_);
    addEmgParameters(system_, mapping_, list_);
    addStartParameters(system_, start_, list_);
    addGroups();
    addLatentParameters(mapping_, list_);  // last: their number differs between trials
    return list_.take();
  }

 private:
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
      const DefaultPrior prior = rule.quantity == MuscleQuantity::pennation
                                     ? DefaultPrior{0, 1.2, 0.05}
                                     : around(value, rule.lower, rule.upper, rule.sd);
      list_.add(muscle.name + "." + rule.name, rule.unit, rule.meaning, value, prior,
                {MuscleTarget{index, rule.quantity}});
    }
  }

  // A muscle of another class, by the table of its class.
  void addHill(std::size_t index) {
    const Muscle& muscle = model_.muscles[index];
    std::visit(
        [&]<class Parameters>(const Parameters& p) {
          for (std::size_t i = 0; i < Parameters::count; ++i) {
            const HillPrior prior = hillPrior(p, i);
            if (!prior.counts) continue;
            const auto& property = Parameters::properties[i];
            const bool isPennation = i == muscles::common::pennation;
            list_.add(
                fmt::format("{}.{}", muscle.name, isPennation ? "pennation_angle" : property.name),
                property.unit.data(), fmt::format("of a {}", muscle.className), p.at(p, i),
                {prior.lower, prior.upper, prior.sd}, {MuscleNumberTarget{index, i}});
          }
        },
        *muscle.hill);
  }

  void addPoints(const SystemMuscle& muscle) {
    const std::size_t index = indexOf(muscle.name);
    const PathGradients gradients(model_, system_.skeleton(), model_.muscles[index], muscle.path);
    const auto& points = model_.muscles[index].path.points;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!gradients.isUsed(i)) continue;
      for (int axis = 0; axis < 3; ++axis) {
        const double value = muscle.path.parameters().points[i][axis];
        list_.add(fmt::format("{}.point{}.{}", muscle.name, i + 1, axisName(axis)), "m",
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
    for (const SystemMuscle& muscle : system_.muscles()) {
      const Muscle& given = model_.muscles[indexOf(muscle.name)];
      const Path& path = given.path;
      for (std::size_t i = 0; i < path.wraps.size(); ++i) {
        if (path.wraps[i].wrapObject != wrapObject) continue;
        const RadiusLimit limit =
            radiusLimit(muscle.path.compiled(), i, postures_.of(given), number);
        if (!(limit.radius < radius.limit)) continue;
        radius.limit = limit.radius;
        radius.whyLimited =
            fmt::format("{}'s {}", muscle.name, describe(limit, path, system_.skeleton()));
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
        list_.add(wrap.name + ".radius", "m",
                  fmt::format("radius of the wrap object in {}", wrap.body), radius,
                  around(radius, 0.3, 2, 0.15), {WrapTarget{index, WrapTarget::Quantity::radius}});
        limitRadius(list_.last(), wrap.name);
      }
      for (int axis = 0; axis < 3; ++axis) {
        const double value = wrap.frame.translation[axis];
        list_.add(fmt::format("{}.translation.{}", wrap.name, axisName(axis)), "m",
                  fmt::format("position of the wrap object in {}", wrap.body), value,
                  position(value), {WrapTarget{index, WrapTarget::Quantity::translation, axis}});
      }
      const bool isSphere = wrap.shape == WrapShape::sphere ||
                            (wrap.shape == WrapShape::ellipsoid && !touched.general &&
                             (wrap.semiAxes.array() - radius).abs().maxCoeff() <= 1e-9 * radius);
      for (int axis = 0; axis < 3 && !isSphere; ++axis) {
        const double value = wrap.frame.orientation[axis];
        list_.add(fmt::format("{}.rotation.{}", wrap.name, axisName(axis)), "rad",
                  fmt::format("orientation of the wrap object in {} (body-fixed x-y-z)", wrap.body),
                  value, {value - 0.6, value + 0.6, 0.1},
                  {WrapTarget{index, WrapTarget::Quantity::rotation, axis}});
      }
    }
  }

  // The semi-axes of an ellipsoid, the radii of a torus.
  void addNumbers(std::size_t index, const Surface& surface) {
    const WrapObject& wrap = model_.wrapObjects[index];
    const bool isTorus = wrap.shape == WrapShape::torus;
    using Quantity = WrapTarget::Quantity;
    constexpr const char* ofTorus[] = {"outer_radius", "inner_radius"};
    constexpr Quantity radii[] = {Quantity::outerRadius, Quantity::innerRadius};
    for (int n = 0; n < numNumbersOf(surface); ++n) {
      const double value = std::visit([&](const auto& each) { return each.number(n); }, surface);
      const std::string name = isTorus ? ofTorus[n] : fmt::format("semi_axis.{}", axisName(n));
      list_.add(
          fmt::format("{}.{}", wrap.name, name), "m",
          fmt::format("{} of the wrap object in {}", isTorus ? "radius" : "semi-axis", wrap.body),
          value, around(value, 0.3, 2, 0.15),
          {isTorus ? WrapTarget{index, radii[n]} : WrapTarget{index, Quantity::semiAxis, n}});
      ModelParameter& number = list_.last();
      limitRadius(number, wrap.name, n);
      if (!isTorus) continue;
      // a torus keeps its hole
      constexpr double hole = 1.05;
      if (radii[n] == Quantity::outerRadius)
        number.lower = std::max(number.lower, hole * wrap.radius);
      else
        number.upper = std::max(value, std::min(number.upper, wrap.outerRadius / hole));
    }
  }

  void addBodies() {
    for (std::size_t i = 0; i < model_.bodies.size(); ++i) {
      const Body& body = model_.bodies[i];
      if (system_.skeleton().placeOf(body.name).segment == 0) continue;
      const double large = body.mass > 0 ? 5 * body.mass : 1;
      list_.add(body.name + ".mass", "kg", "mass", body.mass,
                {0, large, std::max(0.15 * body.mass, 1e-3)},
                {BodyTarget{i, BodyTarget::Quantity::mass}});
      for (int axis = 0; axis < 3; ++axis) {
        const double value = body.massCenter[axis];
        list_.add(fmt::format("{}.mass_center.{}", body.name, axisName(axis)), "m",
                  "mass centre in the body", value, {value - 0.1, value + 0.1, 0.01},
                  {BodyTarget{i, BodyTarget::Quantity::massCenter, axis}});
      }
      constexpr const char* names[] = {"xx", "yy", "zz", "xy", "xz", "yz"};
      const double largest = std::max({body.inertia[0], body.inertia[1], body.inertia[2], 1e-6});
      for (int k = 0; k < 6; ++k) {
        const double value = body.inertia[static_cast<std::size_t>(k)];
        const DefaultPrior prior =
            k < 3 ? DefaultPrior{0, value + 4 * largest, 0.3 * largest}
                  : DefaultPrior{value - largest, value + largest, 0.1 * largest};
        list_.add(fmt::format("{}.inertia.{}", body.name, names[k]), "kg m²",
                  "inertia about the mass centre, body axes", value, prior,
                  {BodyTarget{i, BodyTarget::Quantity::inertia, k}});
      }
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
    for (const ModelParameter& parameter : list_.all()) {
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
    list_.add(std::move(group));
  }

  struct TouchedWrap {
    std::string name;
    double radius;
    std::optional<Surface> general;
  };

  const Model& model_;
  const MusculoskeletalSystem& system_;
  const StartPoint& start_;
  const EmgMapping& mapping_;
  std::vector<TouchedWrap> touched_;
  PostureSamples postures_{model_, system_.skeleton()};
  ParameterList list_;
};

}  // namespace

SchutteNumber schutteNumber(MuscleQuantity quantity) {
  for (const MuscleRule& rule : muscleRules) {
    if (rule.quantity == quantity) return rule.member;
  }
  return nullptr;
}

std::vector<ModelParameter> collectParameters(const Model& model,
                                              const MusculoskeletalSystem& system,
                                              const StartPoint& start, const EmgMapping& mapping) {
  return Collector(model, system, start, mapping).collect();
}

}  // namespace bio
