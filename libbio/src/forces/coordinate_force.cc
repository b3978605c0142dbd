#include "bio/forces/coordinate_force.h"

#include <fmt/format.h>
#include <Eigen/Dense>

#include <cmath>
#include <stdexcept>

#include "info/autodiff/dual.h"

namespace bio {
namespace {

/// Quintic step from 0 to 1 over 0 ≤ x ≤ 1, and its slope.
std::pair<double, double> smoothStep(double x) {
  if (x <= 0) return {0, 0};
  if (x >= 1) return {1, 0};
  return {x * x * x * (10 + x * (-15 + 6 * x)), 30 * x * x * (1 - x) * (1 - x)};
}

}  // namespace

CoordinateForceValue evaluate(const CoordinateLimitForce& law, double q, double qDot) {
  const double above = q - law.upperLimit;
  const double below = law.lowerLimit - q;
  const auto [up, upSlope] = smoothStep(above / law.transition);
  const auto [low, lowSlope] = smoothStep(below / law.transition);
  const double up_q = upSlope / law.transition;
  const double low_q = -lowSlope / law.transition;
  CoordinateForceValue value;
  value.force = -law.upperStiffness * up * above + law.lowerStiffness * low * below -
                law.damping * (up + low) * qDot;
  value.dForce_dq = -law.upperStiffness * (up_q * above + up) +
                    law.lowerStiffness * (low_q * below - low) -
                    law.damping * (up_q + low_q) * qDot;
  value.dForce_dqDot = -law.damping * (up + low);
  return value;
}

CoordinateForceValue evaluate(const SpringGeneralizedForce& law, double q, double qDot) {
  return {-law.stiffness * (q - law.restLength) - law.viscosity * qDot, -law.stiffness,
          -law.viscosity};
}

std::array<double, 6> parameterDerivatives(const CoordinateLimitForce& law, double q, double qDot) {
  const double above = q - law.upperLimit;
  const double below = law.lowerLimit - q;
  const double perTransition = 1 / law.transition;
  const auto [up, upSlope] = smoothStep(above * perTransition);
  const auto [low, lowSlope] = smoothStep(below * perTransition);
  // s_u and s_l over the distances beyond the limits
  const double up_a = upSlope * perTransition;
  const double low_b = lowSlope * perTransition;
  return {law.upperStiffness * (up_a * above + up) + law.damping * up_a * qDot,
          -up * above,
          law.lowerStiffness * (low_b * below + low) - law.damping * low_b * qDot,
          low * below,
          -(up + low) * qDot,
          (law.upperStiffness * up_a * above * above - law.lowerStiffness * low_b * below * below +
           law.damping * (up_a * above + low_b * below) * qDot) *
              perTransition};
}

std::array<double, 3> parameterDerivatives(const SpringGeneralizedForce& law, double q,
                                           double qDot) {
  return {-(q - law.restLength), law.stiffness, -qDot};
}

namespace {

std::vector<std::string> variablesOf(const ExpressionBasedCoordinateForce& law) {
  std::vector<std::string> names = {"q", "qdot"};
  for (const NamedConstant& constant : law.constants) names.push_back(constant.name);
  return names;
}

}  // namespace

CoordinateExpression::CoordinateExpression(const ExpressionBasedCoordinateForce& law)
    : expression_(law.expression, variablesOf(law)) {
  if (law.constants.size() > maxConstants) {
    throw std::invalid_argument(fmt::format("expression of '{}': {} constants, must be ≤ {}",
                                            law.name, law.constants.size(), maxConstants));
  }
  for (const NamedConstant& constant : law.constants) constants_.push_back(constant.value);
}

CoordinateForceValue CoordinateExpression::evaluate(double q, double qDot) const {
  using D = info::Dual<2>;
  D values[2 + maxConstants] = {D(q, 2, 0), D(qDot, 2, 1)};
  for (std::size_t i = 0; i < constants_.size(); ++i) values[2 + i] = D(constants_[i]);
  const D force = expression_.evaluate(values);
  return {force.value(), force.derivatives()[0], force.derivatives()[1]};
}

double CoordinateExpression::parameterDerivative(std::size_t constant, double q,
                                                 double qDot) const {
  using D = info::Dual<1>;
  D values[2 + maxConstants] = {D(q), D(qDot)};
  for (std::size_t i = 0; i < constants_.size(); ++i) {
    values[2 + i] = i == constant ? D(constants_[i], 1, 0) : D(constants_[i]);
  }
  return expression_.evaluate(values).derivatives()[0];
}

bool CoordinateExpression::vanishes() const {
  std::vector<std::optional<double>> known(2);
  known.insert(known.end(), constants_.begin(), constants_.end());
  return expression_.vanishes(known);
}

CoordinateForces::CoordinateForces(const Model& model, const Skeleton& skeleton) {
  const auto addLaws = [&](const auto& laws, auto&& lawOf) {
    for (const auto& law : laws) {
      findCoordinate(model, law.coordinate);
      const int index = skeleton.indexOf(law.coordinate);
      if (law.enabled && index >= 0) acting_.push_back({index, lawOf(law), law.name});
    }
  };
  addLaws(model.limitForces, [](const CoordinateLimitForce& law) { return law; });
  addLaws(model.springForces, [](const SpringGeneralizedForce& law) { return law; });
  addLaws(model.expressionForces,
          [](const ExpressionBasedCoordinateForce& law) { return CoordinateExpression(law); });
  for (Acting& acting : acting_) {
    const auto* expression = std::get_if<CoordinateExpression>(&acting.law);
    acting.vanishes = expression != nullptr && expression->vanishes();
  }
}

CoordinateForceValue CoordinateForces::evaluateLaw(const Acting& acting, double q, double qDot) {
  if (const auto* expression = std::get_if<CoordinateExpression>(&acting.law)) {
    return expression->evaluate(q, qDot);
  }
  if (const auto* limit = std::get_if<CoordinateLimitForce>(&acting.law)) {
    return evaluate(*limit, q, qDot);
  }
  return evaluate(std::get<SpringGeneralizedForce>(acting.law), q, qDot);
}

std::vector<std::string> CoordinateForces::names() const {
  std::vector<std::string> result;
  for (const Acting& acting : acting_) result.push_back(acting.name);
  return result;
}

}  // namespace bio
