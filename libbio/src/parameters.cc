#include "bio/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>

#include "bio/path_gradient.h"

namespace bio {
namespace {

using std::numbers::pi;

/// What is taken for granted about a kind of quantity: bounds, and how well it is known beforehand.
struct Habit {
  double lower, upper, deviation;
};
/// A positive quantity: bounds and deviation as fractions of its value.
Habit around(double value, double lower, double upper, double deviation) {
  return {value * lower, value * upper, value * deviation};
}
/// A position [m].
Habit position(double value, double deviation = 0.005) {
  return {value - 0.03, value + 0.03, deviation};
}

struct MuscleRule {
  MuscleQuantity quantity;
  const char* name;
  const char* unit;
  const char* meaning;
  double SchutteParameters::*member;  ///< null: a scale of a curve
  double lower, upper, deviation;     ///< fractions of the value
};
constexpr MuscleRule muscleRules[] = {
    {MuscleQuantity::maxIsometricForce, "max_isometric_force", "N", "maximum isometric force F0",
     &SchutteParameters::maxIsometricForce, 0.1, 10, 0.3},
    {MuscleQuantity::optimalFibreLength, "optimal_fiber_length", "m", "optimal fibre length ℓ0",
     &SchutteParameters::optimalFibreLength, 0.5, 2, 0.1},
    {MuscleQuantity::tendonSlackLength, "tendon_slack_length", "m", "tendon slack length ℓs",
     &SchutteParameters::tendonSlackLength, 0.5, 2, 0.05},
    {MuscleQuantity::pennation, "pennation_angle", "rad", "pennation at optimal fibre length",
     &SchutteParameters::pennation, 0, 0, 0},
    {MuscleQuantity::damping, "damping", "", "damping of the fibre in F0·t_s/ℓ0",
     &SchutteParameters::damping, 0.1, 10, 0.5},
    {MuscleQuantity::timeScale, "time_scale", "s", "time scale of activation and fibre velocity",
     &SchutteParameters::timeScale, 0.2, 5, 0.2},
    {MuscleQuantity::activation1, "activation1", "",
     "rate of rising activation per excitation, in 1/time_scale", &SchutteParameters::activation1,
     0.1, 10, 0.3},
    {MuscleQuantity::activation2, "activation2", "",
     "rate of activation without excitation, in 1/time_scale", &SchutteParameters::activation2, 0.1,
     10, 0.3},
    {MuscleQuantity::tendonStrainScale, "tendon_strain_scale", "",
     "stretches the tendon's force curve in strain; 1: as in the model", nullptr, 0.2, 5, 0.2},
    {MuscleQuantity::activeForceScale, "active_force_scale", "",
     "scales the active force–length curve; 1: as in the model", nullptr, 0.2, 5, 0.1},
    {MuscleQuantity::activeForceWidth, "active_force_width", "",
     "widens the active force–length curve about 1; 1: as in the model", nullptr, 0.5, 2, 0.1},
    {MuscleQuantity::passiveForceScale, "passive_force_scale", "",
     "scales the passive force curve; 1: as in the model", nullptr, 0.05, 20, 0.3},
};

const char* axisName(int axis) {
  constexpr const char* names[] = {"x", "y", "z"};
  return names[axis];
}

// Places in a Model ------------------------------------------------------------------------------

double* limitForceValue(CoordinateLimitForce& force, int component) {
  double* const values[] = {&force.upperLimit,     &force.upperStiffness, &force.lowerLimit,
                            &force.lowerStiffness, &force.damping,        &force.transition};
  return values[component];
}
double* springForceValue(SpringGeneralizedForce& force, int component) {
  double* const values[] = {&force.stiffness, &force.restLength, &force.viscosity};
  return values[component];
}

/// f + shift, for a point that follows a coordinate.
void shiftFunction(Function& function, double shift) {
  if (function.scale == 0) {
    function = Function{1, ConstantFunction{shift}};
    return;
  }
  const double by = shift / function.scale;
  struct Shift {
    double by;
    void operator()(ConstantFunction& f) const { f.value += by; }
    void operator()(LinearFunction& f) const { f.intercept += by; }
    void operator()(SplineFunction& f) const {
      for (double& y : f.y) y += by;
    }
    void operator()(PiecewiseLinearFunction& f) const {
      for (double& y : f.y) y += by;
    }
    void operator()(PolynomialFunction& f) const {
      if (f.coefficients.empty()) f.coefficients.push_back(0);
      f.coefficients.back() += by;
    }
  };
  std::visit(Shift{by}, function.shape);
}

void stretch(std::vector<double>& values, double factor, double about = 0) {
  for (double& x : values) x = about + factor * (x - about);
}

/// Sets a target of the model; `nominal` is the parameter's value there.
struct SetInModel {
  Model& model;
  double value, nominal;

  void operator()(const MuscleTarget& target) const {
    SchutteParameters& muscle = *model.muscles[target.muscle].schutte;
    switch (target.quantity) {
      case MuscleQuantity::tendonStrainScale:
        return stretch(muscle.tendonForceLength.x, value);
      case MuscleQuantity::activeForceScale:
        return stretch(muscle.activeForceLength.y, value);
      case MuscleQuantity::activeForceWidth:
        return stretch(muscle.activeForceLength.x, value, 1.0);
      case MuscleQuantity::passiveForceScale:
        return stretch(muscle.passiveForceLength->y, value);
      default:
        break;
    }
    for (const MuscleRule& rule : muscleRules) {
      if (rule.quantity == target.quantity) muscle.*rule.member = value;
    }
  }
  void operator()(const PointTarget& target) const {
    PathPoint& point = model.muscles[target.muscle].path.points[target.point];
    if (point.motion) {
      shiftFunction(point.motion->location[static_cast<std::size_t>(target.axis)], value - nominal);
    } else {
      point.location[target.axis] = value;
    }
  }
  void operator()(const WrapTarget& target) const {
    WrapObject& wrap = model.wrapObjects[target.wrap];
    if (target.component >= 4) {
      wrap.frame.orientation[target.component - 4] = value;
    } else if (target.component >= 1) {
      wrap.frame.translation[target.component - 1] = value;
    } else if (wrap.shape == WrapShape::ellipsoid) {
      for (double& axis : wrap.semiAxes) {
        if (std::abs(axis - nominal) <= 1e-9 * nominal) axis = value;
      }
    } else {
      wrap.radius = value;
    }
  }
  void operator()(const BodyTarget& target) const {
    Body& body = model.bodies[target.body];
    if (target.component == 0) {
      body.mass = value;
    } else if (target.component <= 3) {
      body.massCenter[target.component - 1] = value;
    } else {
      body.inertia[static_cast<std::size_t>(target.component - 4)] = value;
    }
  }
  void operator()(const LimitForceTarget& target) const {
    *limitForceValue(model.limitForces[target.force], target.component) = value;
  }
  void operator()(const SpringForceTarget& target) const {
    *springForceValue(model.springForces[target.force], target.component) = value;
  }
  void operator()(const EmgTarget&) const {}
  void operator()(const InitialTarget&) const {}
};

// Words ------------------------------------------------------------------------------------------

/// Spelling variants as one.
std::string canonical(std::string name) {
  const auto replace = [&](const std::string& from, const std::string& to) {
    const std::size_t place = name.rfind(from);
    if (place != std::string::npos && place + from.size() == name.size()) {
      name.replace(place, from.size(), to);
    }
  };
  replace(".optimal_fibre_length", ".optimal_fiber_length");
  replace(".pennation", ".pennation_angle");
  replace(".pennation_angle_at_optimal", ".pennation_angle");
  for (const char* axis : {"x", "y", "z"}) {
    replace(fmt::format(".com.{}", axis), fmt::format(".mass_center.{}", axis));
    replace(fmt::format(".mass_centre.{}", axis), fmt::format(".mass_center.{}", axis));
  }
  return name;
}

/// Edits from one word to another (Levenshtein).
std::size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t changed =
          diagonal + (std::tolower(a[i - 1]) == std::tolower(b[j - 1]) ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({changed, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

bool matches(const char* pattern, const char* text) {
  if (*pattern == '\0') return *text == '\0';
  if (*pattern == '*')
    return matches(pattern + 1, text) || (*text != '\0' && matches(pattern, text + 1));
  return *pattern == *text && matches(pattern + 1, text + 1);
}

// Collecting -------------------------------------------------------------------------------------

class Collector {
 public:
  Collector(const Model& model, const Arm& arm, const StartPoint& start, const EmgMapping& mapping)
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
    return std::move(parameters_);
  }

 private:
  void add(std::string name, const char* unit, std::string meaning, double value, Habit habit,
           std::vector<ParameterTarget> targets, bool isGroup = false) {
    parameters_.push_back({std::move(name), unit, std::move(meaning), value,
                           std::min(habit.lower, value), std::max(habit.upper, value),
                           habit.deviation, std::move(targets), isGroup});
  }

  std::size_t indexOf(const std::string& muscle) const {
    for (std::size_t i = 0; i < model_.muscles.size(); ++i) {
      if (model_.muscles[i].name == muscle) return i;
    }
    throw std::invalid_argument(fmt::format("the model has no muscle called '{}'", muscle));
  }

  void addMuscle(const ArmMuscle& muscle) {
    const std::size_t index = indexOf(muscle.name);
    const SchutteParameters& schutte = *model_.muscles[index].schutte;
    for (const MuscleRule& rule : muscleRules) {
      if (rule.quantity == MuscleQuantity::passiveForceScale && !schutte.passiveForceLength) {
        continue;  // a law without numbers
      }
      const double value = rule.member ? schutte.*rule.member : 1.0;
      const Habit habit = rule.quantity == MuscleQuantity::pennation
                              ? Habit{0, 1.2, 0.05}
                              : around(value, rule.lower, rule.upper, rule.deviation);
      add(muscle.name + "." + rule.name, rule.unit, rule.meaning, value, habit,
          {MuscleTarget{index, rule.quantity}});
    }
  }

  void addPoints(const ArmMuscle& muscle) {
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
      touched_.push_back({wraps[i].wrapObject, muscle.path.parameters().radii[i]});
    }
  }

  void addWraps() {
    for (const TouchedWrap& touched : touched_) {
      std::size_t index = 0;
      while (model_.wrapObjects[index].name != touched.name) ++index;
      const WrapObject& wrap = model_.wrapObjects[index];
      const double radius = touched.radius;
      add(wrap.name + ".radius", "m", fmt::format("radius of the wrap object in {}", wrap.body),
          radius, around(radius, 0.3, 2, 0.15), {WrapTarget{index, 0}});
      for (int axis = 0; axis < 3; ++axis) {
        const double value = wrap.frame.translation[axis];
        add(fmt::format("{}.translation.{}", wrap.name, axisName(axis)), "m",
            fmt::format("position of the wrap object in {}", wrap.body), value, position(value),
            {WrapTarget{index, 1 + axis}});
      }
      const bool isSphere = wrap.shape == WrapShape::sphere ||
                            (wrap.shape == WrapShape::ellipsoid &&
                             (wrap.semiAxes.array() - radius).abs().maxCoeff() <= 1e-9 * radius);
      for (int axis = 0; axis < 3 && !isSphere; ++axis) {
        const double value = wrap.frame.orientation[axis];
        add(fmt::format("{}.rotation.{}", wrap.name, axisName(axis)), "rad",
            fmt::format("orientation of the wrap object in {} (body-fixed x-y-z)", wrap.body),
            value, {value - 0.6, value + 0.6, 0.1}, {WrapTarget{index, 4 + axis}});
      }
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
        const Habit habit = k < 3 ? Habit{0, value + 4 * largest, 0.3 * largest}
                                  : Habit{value - largest, value + largest, 0.1 * largest};
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
      const Habit habit =
          rule.isAngle ? Habit{value - 1.5, value + 1.5, 0.1} : Habit{0, 10 * spread, 0.5 * spread};
      add(name + "." + rule.name, rule.unit, "passive force of the coordinate", value, habit,
          {target});
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
  }

  void addEmg() {
    for (const ArmMuscle& muscle : arm_.muscles()) {
      const auto at = mapping_.gain.find(muscle.name);
      const double gain = at == mapping_.gain.end() ? 1.0 : at->second;
      add(fmt::format("emg.{}.gain", muscle.name), "", "factor on the trial's excitation", gain,
          {0, 5, 0.2}, {EmgTarget{EmgTarget::What::gain, muscle.name}});
    }
    add("emg.delay", "s", "electromechanical delay", mapping_.delay, {0, 0.2, 0.02},
        {EmgTarget{EmgTarget::What::delay, ""}});
    add("emg.nonlinearity", "", "shape A of the EMG–excitation relation; 0: straight",
        mapping_.nonlinearity, {-3, 0, 1}, {EmgTarget{EmgTarget::What::nonlinearity, ""}});
  }

  void addStart() {
    const auto& coordinates = arm_.skeleton().coordinates();
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
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
    addGroup("muscles.damping", "damping", "damping of all muscles");
    addGroup("muscles.tendon_strain_scale", "tendon_strain_scale", "compliance of all tendons");
    addGroup("muscles.active_force_scale", "active_force_scale", "strength of all muscles");
    addGroup("emg.gain", "gain", "factor on all excitations");
  }
  void addGroup(const char* name, const std::string& quantity, const char* meaning) {
    ModelParameter group;
    for (const ModelParameter& parameter : parameters_) {
      const bool isMember = !parameter.isGroup && parameter.name.ends_with("." + quantity) &&
                            (std::holds_alternative<MuscleTarget>(parameter.targets.front()) ||
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
  };

  const Model& model_;
  const Arm& arm_;
  const StartPoint& start_;
  const EmgMapping& mapping_;
  std::vector<TouchedWrap> touched_;
  std::vector<ModelParameter> parameters_;
};

}  // namespace

ParameterCatalogue::ParameterCatalogue(const Model& model, const Arm& arm, const StartPoint& start,
                                       const EmgMapping& mapping)
    : model_(model), mapping_(mapping), start_(start) {
  const Eigen::Index n = arm.skeleton().numCoordinates();
  if (start_.q.size() != n || (start_.qDot.size() != 0 && start_.qDot.size() != n)) {
    throw std::invalid_argument(
        fmt::format("start: {} coordinates and {} speeds, must be {} (or no speeds)",
                    start_.q.size(), start_.qDot.size(), n));
  }
  if (start_.qDot.size() == 0) start_.qDot = Eigen::VectorXd::Zero(n);
  for (const ArmMuscle& muscle : arm.muscles()) muscles_.push_back(muscle.name);
  parameters_ = Collector(model_, arm, start_, mapping_).collect();
}

std::size_t ParameterCatalogue::find(const std::string& name) const {
  const std::string wanted = canonical(name);
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    if (parameters_[i].name == wanted) return i;
  }
  for (const char* axis : {".x", ".y", ".z"}) {  // TRI.x for TRI.translation.x
    if (!wanted.ends_with(axis)) continue;
    const std::string longer =
        wanted.substr(0, wanted.size() - 2) + ".translation" + std::string(axis);
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
      if (parameters_[i].name == longer) return i;
    }
  }
  std::vector<std::size_t> order(parameters_.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::vector<std::size_t> distance(order.size());
  for (std::size_t i : order) distance[i] = editDistance(wanted, parameters_[i].name);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return distance[a] < distance[b]; });
  std::string nearest;
  for (std::size_t i = 0; i < std::min<std::size_t>(3, order.size()); ++i) {
    nearest += (i ? ", " : "") + parameters_[order[i]].name;
  }
  throw std::invalid_argument(
      fmt::format("no parameter is called '{}'; nearest: {}", name, nearest));
}

std::vector<std::size_t> ParameterCatalogue::select(const std::vector<std::string>& names) const {
  std::vector<std::size_t> selection;
  const auto take = [&](std::size_t index) {
    if (std::find(selection.begin(), selection.end(), index) == selection.end()) {
      selection.push_back(index);
    }
  };
  for (const std::string& name : names) {
    if (name == "all" || name.find('*') != std::string::npos) {
      const std::string pattern = name == "all" ? "*" : canonical(name);
      const std::size_t before = selection.size();
      bool any = false;
      for (std::size_t i = 0; i < parameters_.size(); ++i) {
        if (parameters_[i].isGroup || !matches(pattern.c_str(), parameters_[i].name.c_str())) {
          continue;
        }
        any = true;
        take(i);
      }
      if (!any && selection.size() == before) {
        throw std::invalid_argument(fmt::format("no parameter matches '{}'", name));
      }
    } else {
      take(find(name));
    }
  }
  for (const std::size_t a : selection) {
    for (const std::size_t b : selection) {
      if (!parameters_[a].isGroup || a == b) continue;
      for (const ParameterTarget& target : parameters_[b].targets) {
        const auto& all = parameters_[a].targets;
        if (std::find(all.begin(), all.end(), target) == all.end()) continue;
        throw std::invalid_argument(fmt::format("{} and {} set the same number, take one of them",
                                                parameters_[a].name, parameters_[b].name));
      }
    }
  }
  return selection;
}

Eigen::VectorXd ParameterCatalogue::values(const std::vector<std::size_t>& selection) const {
  Eigen::VectorXd values(static_cast<Eigen::Index>(selection.size()));
  for (std::size_t i = 0; i < selection.size(); ++i) {
    values[static_cast<Eigen::Index>(i)] = parameters_.at(selection[i]).value;
  }
  return values;
}

std::vector<info::Parameter> ParameterCatalogue::asEstimated(
    const std::vector<std::size_t>& selection, bool withPriors) const {
  std::vector<info::Parameter> result;
  for (const std::size_t index : selection) {
    const ModelParameter& p = parameters_.at(index);
    info::Parameter parameter{p.name, p.unit, p.value, p.lower, p.upper, std::nullopt};
    if (withPriors) parameter.prior = info::GaussianPrior{p.value, p.deviation};
    result.push_back(std::move(parameter));
  }
  return result;
}

ParameterCatalogue::Setting ParameterCatalogue::at(const std::vector<std::size_t>& selection,
                                                   const Eigen::VectorXd& values) const {
  if (values.size() != static_cast<Eigen::Index>(selection.size())) {
    throw std::invalid_argument(fmt::format("{} values for {} parameters, must be as many",
                                            values.size(), selection.size()));
  }
  Setting setting{model_, mapping_, start_, {}};
  setting.values.resize(static_cast<Eigen::Index>(parameters_.size()));
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    setting.values[static_cast<Eigen::Index>(i)] = parameters_[i].value;
  }
  for (std::size_t i = 0; i < selection.size(); ++i) {
    const ModelParameter& parameter = parameters_.at(selection[i]);
    const double value = values[static_cast<Eigen::Index>(i)];
    if (!std::isfinite(value)) {
      throw std::invalid_argument(fmt::format("parameter {} = {} {}, must be finite",
                                              parameter.name, value, parameter.unit));
    }
    setting.values[static_cast<Eigen::Index>(selection[i])] = value;
    for (const ParameterTarget& target : parameter.targets) {
      if (const auto* emg = std::get_if<EmgTarget>(&target)) {
        if (emg->what == EmgTarget::What::delay) setting.mapping.delay = value;
        if (emg->what == EmgTarget::What::nonlinearity) setting.mapping.nonlinearity = value;
        if (emg->what == EmgTarget::What::gain) setting.mapping.gain[emg->muscle] = value;
      } else if (const auto* initial = std::get_if<InitialTarget>(&target)) {
        (initial->isSpeed ? setting.start.qDot : setting.start.q)[initial->coordinate] = value;
      } else if (value != parameter.value) {
        std::visit(SetInModel{setting.model, value, parameter.value}, target);
      }
    }
  }
  return setting;
}

}  // namespace bio
