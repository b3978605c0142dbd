#include "bio/parameters/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include "bio/model/nearest_name.h"
#include "parameters/parameter_collector.h"

namespace bio {
namespace {

// Places in a Model ------------------------------------------------------------------------------

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
    void operator()(SineFunction& f) const { f.offset += by; }
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
    muscle.*schutteNumber(target.quantity) = value;
  }
  void operator()(const MuscleNumberTarget& target) const {
    std::visit([&](auto& p) { p.at(p, target.place) = value; }, *model.muscles[target.muscle].hill);
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
    using Quantity = WrapTarget::Quantity;
    switch (target.quantity) {
      case Quantity::semiAxis:
        wrap.semiAxes[target.axis] = value;
        return;
      case Quantity::outerRadius:
        wrap.outerRadius = value;
        return;
      case Quantity::innerRadius:
        wrap.radius = value;
        return;
      case Quantity::rotation:
        wrap.frame.orientation[target.axis] = value;
        return;
      case Quantity::translation:
        wrap.frame.translation[target.axis] = value;
        return;
      case Quantity::radius:
        break;
    }
    if (wrap.shape != WrapShape::ellipsoid) {
      wrap.radius = value;
      return;
    }
    for (double& axis : wrap.semiAxes) {
      if (std::abs(axis - nominal) <= 1e-9 * nominal) axis = value;
    }
  }
  void operator()(const BodyTarget& target) const {
    Body& body = model.bodies[target.body];
    switch (target.quantity) {
      case BodyTarget::Quantity::mass:
        body.mass = value;
        break;
      case BodyTarget::Quantity::massCenter:
        body.massCenter[target.element] = value;
        break;
      case BodyTarget::Quantity::inertia:
        body.inertia[static_cast<std::size_t>(target.element)] = value;
        break;
    }
  }
  void operator()(const LimitForceTarget& target) const {
    limitForceNumber(model.limitForces[target.force], target.quantity) = value;
  }
  void operator()(const SpringForceTarget& target) const {
    springForceNumber(model.springForces[target.force], target.quantity) = value;
  }
  void operator()(const ForceNumberTarget& target) const { *forceNumber(model, target) = value; }
  void operator()(const ExpressionTarget& target) const {
    model.expressionForces[target.force].constants[target.constant].value = value;
  }
  void operator()(const GravityTarget& target) const { model.gravity[target.axis] = value; }
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

/// Whether the text is the pattern with something for every `*`. The last `*` passed takes one more
/// character whenever what follows it does not fit; earlier ones need never be looked at again.
bool matches(std::string_view pattern, std::string_view text) {
  std::size_t p = 0, t = 0, star = pattern.npos, taken = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      taken = t;
    } else if (p < pattern.size() && pattern[p] == text[t]) {
      ++p;
      ++t;
    } else if (star != pattern.npos) {
      p = star + 1;
      t = ++taken;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == pattern.npos;
}

}  // namespace

ParameterCatalogue::ParameterCatalogue(const Model& model, const MusculoskeletalSystem& system,
                                       const StartPoint& start, const EmgMapping& mapping)
    : model_(model), mapping_(mapping), start_(start) {
  const Eigen::Index n = system.skeleton().numCoordinates();
  if (start_.q.size() != n || (start_.qDot.size() != 0 && start_.qDot.size() != n)) {
    throw std::invalid_argument(
        fmt::format("start: {} coordinates and {} speeds, must be {} (or no speeds)",
                    start_.q.size(), start_.qDot.size(), n));
  }
  if (start_.qDot.size() == 0) start_.qDot = Eigen::VectorXd::Zero(n);
  for (const SystemMuscle& muscle : system.muscles()) muscles_.push_back(muscle.name);
  parameters_ = collectParameters(model_, system, start_, mapping_);
}

bool ParameterCatalogue::has(const std::string& name) const {
  return std::any_of(parameters_.begin(), parameters_.end(),
                     [&](const ModelParameter& p) { return p.name == name; });
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
        if (parameters_[i].isGroup || !matches(pattern, parameters_[i].name)) {
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
        throw std::invalid_argument(fmt::format("{} and {} set the same value, use one of them",
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

void ParameterCatalogue::requireBelowLimit(std::size_t index, double value,
                                           const std::string& what) const {
  const ModelParameter& p = parameters_.at(index);
  if (!(value >= p.limit)) return;
  throw std::invalid_argument(fmt::format("{}{} = {:.6g} {}, must be below {:.6g} {}: {}", what,
                                          p.name, value, p.unit, p.limit, p.unit, p.whyLimited));
}

std::vector<info::Parameter> ParameterCatalogue::asEstimated(
    const std::vector<std::size_t>& selection, bool withPriors) const {
  std::vector<info::Parameter> result;
  for (const std::size_t index : selection) {
    const ModelParameter& p = parameters_.at(index);
    info::Parameter parameter{p.name, p.unit, p.value, p.lower, p.upper, std::nullopt};
    if (withPriors) parameter.prior = info::GaussianPrior{p.value, p.sd};
    result.push_back(std::move(parameter));
  }
  return result;
}

void setTarget(ParameterCatalogue::Setting& setting, const ParameterTarget& target, double value,
               double nominal) {
  if (!std::isfinite(value)) {
    throw std::invalid_argument(fmt::format("a parameter is {}, must be finite", value));
  }
  EmgMapping& mapping = setting.mapping;
  if (const auto* emg = std::get_if<EmgTarget>(&target)) {
    switch (emg->what) {
      case EmgTarget::What::delay:
        mapping.delay = value;
        break;
      case EmgTarget::What::nonlinearity:
        mapping.nonlinearity = value;
        break;
      case EmgTarget::What::fatigue:
        mapping.fatigue = value;
        break;
      case EmgTarget::What::fatigueTime:
        mapping.fatigueTime = value;
        break;
      case EmgTarget::What::gain:
        mapping.gain[emg->muscle] = value;
        break;
      case EmgTarget::What::offset:
        mapping.offset[emg->muscle] = value;
        break;
      case EmgTarget::What::saturation:
        mapping.saturation[emg->muscle] = value;
        break;
      case EmgTarget::What::latent:
        mapping.latent.at(emg->muscle).values[static_cast<Eigen::Index>(emg->knot)] = value;
        break;
      case EmgTarget::What::crosstalk: {
        const auto at =
            std::find_if(mapping.crosstalk.begin(), mapping.crosstalk.end(),
                         [&](const auto& c) { return c.from == emg->from && c.to == emg->muscle; });
        if (at == mapping.crosstalk.end()) {
          mapping.crosstalk.push_back({emg->from, emg->muscle, value});
        } else {
          at->share = value;
        }
        break;
      }
    }
  } else if (const auto* initial = std::get_if<InitialTarget>(&target)) {
    (initial->isSpeed ? setting.start.qDot : setting.start.q)[initial->coordinate] = value;
  } else if (value != nominal) {
    std::visit(SetInModel{setting.model, value, nominal}, target);
  }
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
    requireBelowLimit(selection[i], value);
    setting.values[static_cast<Eigen::Index>(selection[i])] = value;
    for (const ParameterTarget& target : parameter.targets) {
      setTarget(setting, target, value, parameter.value);
    }
  }
  return setting;
}

}  // namespace bio
