#include "sensitivity/parameter_effects.h"

#include <algorithm>
#include <string_view>

#include "bio/path/path_gradient.h"

namespace bio::stepping {
namespace {

/// Row of a wrap object's number in a PathGradient.
std::size_t rowOf(const WrapTarget& target) {
  using Quantity = WrapTarget::Quantity;
  switch (target.quantity) {
    case Quantity::translation:
      return static_cast<std::size_t>(wrap_rows::translation + target.axis);
    case Quantity::rotation:
      return static_cast<std::size_t>(wrap_rows::rotation + target.axis);
    case Quantity::semiAxis:
      return static_cast<std::size_t>(wrap_rows::numbers + target.axis);
    case Quantity::outerRadius:
      return wrap_rows::numbers;
    case Quantity::innerRadius:
      return wrap_rows::numbers + 1;
    case Quantity::radius:
      break;
  }
  return wrap_rows::radius;
}

}  // namespace

/// Enters one step of a direction where its target is touched.
struct ParameterEffects::Enter {
  ParameterEffects& effects;
  const MusculoskeletalSystem& system;
  const Model& model;
  double value, weight;
  Eigen::Index column;

  void operator()(const MuscleTarget& target) const {
    const std::size_t i = indexOf(model.muscles[target.muscle].name);
    if (i == system.numMuscles()) return;
    OfMuscle& muscle = effects.muscles[i];
    const auto quantity = static_cast<std::size_t>(target.quantity);
    if (target.quantity == MuscleQuantity::activation1) {
      muscle.activation.push_back({1, column, weight});
    } else if (target.quantity == MuscleQuantity::activation2) {
      muscle.activation.push_back({2, column, weight});
    } else {
      // a scale multiplies the curve that the catalogue's model has; the system's is scaled already
      const bool isScale = quantity >= static_cast<std::size_t>(MuscleQuantity::tendonStrainScale);
      muscle.fibre.push_back({quantity, column, isScale ? weight / value : weight});
      if (target.quantity == MuscleQuantity::timeScale) {
        muscle.activation.push_back({0, column, weight});
      }
    }
  }
  void operator()(const MuscleNumberTarget& target) const {
    const Muscle& given = model.muscles[target.muscle];
    const std::size_t i = indexOf(given.name);
    if (i == system.numMuscles()) return;
    OfMuscle& muscle = effects.muscles[i];
    muscle.fibre.push_back({target.place, column, weight});
    const std::string_view name =
        std::visit([&](const auto& p) { return p.properties[target.place].name; }, *given.hill);
    const auto own = system.muscles()[i].activation.names();
    for (std::size_t k = 0; k < own.size(); ++k) {
      if (own[k] == name) muscle.activation.push_back({k, column, weight});
    }
  }
  void operator()(const PointTarget& target) const {
    const std::size_t i = indexOf(model.muscles[target.muscle].name);
    if (i == system.numMuscles()) return;
    effects.muscles[i].points.push_back(
        {3 * target.point + static_cast<std::size_t>(target.axis), column, weight});
  }
  void operator()(const WrapTarget& target) const {
    const std::string& name = model.wrapObjects[target.wrap].name;
    for (const Muscle& muscle : model.muscles) {
      const std::size_t i = indexOf(muscle.name);
      if (i == system.numMuscles()) continue;
      for (std::size_t place = 0; place < muscle.path.wraps.size(); ++place) {
        if (muscle.path.wraps[place].wrapObject != name) continue;
        effects.muscles[i].wraps.push_back(
            {wrap_rows::count * place + rowOf(target), column, weight});
      }
    }
  }
  void operator()(const BodyTarget& target) const {
    effects.addBody(system, target, model.bodies[target.body], column, weight);
  }
  void operator()(const LimitForceTarget& target) const {
    const CoordinateLimitForce& law = model.limitForces[target.force];
    effects.limitForces.push_back({law,
                                   system.skeleton().indexOf(law.coordinate),
                                   {static_cast<std::size_t>(target.quantity), column, weight}});
  }
  void operator()(const SpringForceTarget& target) const {
    const SpringGeneralizedForce& law = model.springForces[target.force];
    effects.springForces.push_back({law,
                                    system.skeleton().indexOf(law.coordinate),
                                    {static_cast<std::size_t>(target.quantity), column, weight}});
  }
  void operator()(const ForceNumberTarget& target) const {
    effects.addForce(system, model, target, column, weight);
  }
  void operator()(const ExpressionTarget& target) const {
    const ExpressionBasedCoordinateForce& law = model.expressionForces[target.force];
    effects.expressions.push_back({CoordinateExpression(law),
                                   system.skeleton().indexOf(law.coordinate),
                                   {target.constant, column, weight}});
  }
  void operator()(const GravityTarget& target) const {
    effects.gravity.push_back({static_cast<std::size_t>(target.axis), column, weight});
  }
  void operator()(const EmgTarget& target) const {
    if (target.what == EmgTarget::What::delay) {
      effects.delay.push_back({0, column, weight});
    } else {
      effects.emg.push_back({target, column, weight});
    }
  }
  void operator()(const InitialTarget& target) const {
    effects.start.push_back({target.coordinate, target.isSpeed, column, weight});
  }

  /// numMuscles() where the system lacks the muscle.
  std::size_t indexOf(const std::string& name) const {
    std::size_t i = 0;
    while (i < system.numMuscles() && system.muscles()[i].name != name) ++i;
    return i;
  }
};

ParameterEffects::ParameterEffects(const MusculoskeletalSystem& system,
                                   const ParameterCatalogue::Setting& setting,
                                   const std::vector<ParameterDirection>& wanted)
    : muscles(system.numMuscles()) {
  Eigen::Index column = 0;
  for (const ParameterDirection& direction : wanted) {
    for (const TargetStep& step : direction) {
      std::visit(Enter{*this, system, setting.model, step.value, step.weight, column}, step.target);
    }
    ++column;
  }
}

void ParameterEffects::addBody(const MusculoskeletalSystem& system, const BodyTarget& target,
                               const Body& body, Eigen::Index column, double weight) {
  const BodyPlacement& place = system.skeleton().placeOf(body.name);
  if (place.segment == 0) return;
  const Eigen::Matrix3d& R = place.X_SB.R;
  const Eigen::Vector3d center = R * body.massCenter + place.X_SB.p;
  Segment change;
  if (target.quantity == BodyTarget::Quantity::mass) {
    change.mass = 1;
    change.massMoment = center;
    change.secondMoment = center * center.transpose();
  } else if (target.quantity == BodyTarget::Quantity::massCenter) {
    const Eigen::Vector3d axis = R.col(target.element);
    change.massMoment = body.mass * axis;
    change.secondMoment = body.mass * (axis * center.transpose() + center * axis.transpose());
  } else {
    // Σ m r rᵀ about the mass centre is ½ tr(I)·1 − I
    constexpr int rows[] = {0, 1, 2, 0, 0, 1};
    constexpr int columns[] = {0, 1, 2, 1, 2, 2};
    const int i = rows[target.element], j = columns[target.element];
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
    inertia(i, j) = inertia(j, i) = 1;
    const Eigen::Matrix3d central = 0.5 * inertia.trace() * Eigen::Matrix3d::Identity() - inertia;
    change.secondMoment = R * central * R.transpose();
  }
  change.mass *= weight;
  change.massMoment *= weight;
  change.secondMoment *= weight;
  // what moves several bodies of a segment is one change of that
  for (OfSegment& other : segments) {
    if (other.segment != place.segment || other.column != column) continue;
    other.change.mass += change.mass;
    other.change.massMoment += change.massMoment;
    other.change.secondMoment += change.secondMoment;
    return;
  }
  segments.push_back({place.segment, std::move(change), column});
}

void ParameterEffects::addForce(const MusculoskeletalSystem& system, const Model& model,
                                const ForceNumberTarget& target, Eigen::Index column,
                                double weight) {
  using Kind = ForceNumberTarget::Kind;
  std::size_t place = target.force;
  bool acts = false;
  const auto find = [&](const auto& acting, const std::string& name) {
    place = 0;
    while (place < acting.size() && acting[place].name != name) ++place;
    acts = place < acting.size();
  };
  switch (target.kind) {
    case Kind::pointSpring:
      acts = system.bodyForces().hasSpring(place);
      break;
    case Kind::bushing:
      acts = system.bodyForces().hasBushing(place);
      break;
    case Kind::elasticPath:
      find(system.elasticPaths(), model.elasticPaths[target.force].name);
      break;
    case Kind::actuator:
      find(system.actuators(), model.actuators[target.force].name);
      break;
  }
  if (!acts) return;
  const QuantityEffect effect{static_cast<std::size_t>(target.number), column, weight};
  for (OfForce& force : forces) {
    if (force.kind != target.kind || force.place != place) continue;
    force.numbers.push_back(effect);
    return;
  }
  forces.push_back({target.kind, place, {effect}});
}

}  // namespace bio::stepping
