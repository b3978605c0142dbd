#pragma once

#include <utility>

#include "robots/robot_effects.h"

// What both robots' catalogues are written with.
namespace info::robot {

inline constexpr double kFrictionRate = 0.05;  // [rad/s], below it dry friction is smoothed

inline Eigen::VectorXd startsAt(const std::vector<double>& values) {
  return Eigen::VectorXd::Map(values.data(), static_cast<Eigen::Index>(values.size()));
}

// An amplitude that is 0 where the effect is absent: one quantity, one start.
inline discover::Candidate effectOf(const Model& model, std::string id, std::string name,
                                    std::string sentence, discover::EffectKind kind,
                                    std::size_t quantity, double start) {
  return {std::move(id),       std::move(name),
          std::move(sentence), kind,
          {quantity},          {model.quantities[quantity].sd},
          {startsAt({start})}, {}};
}

// A nuisance that may be off by `times` its tolerance.
inline discover::Candidate errorOf(const Model& model, std::string id, std::size_t quantity,
                                   double times = 5) {
  const discover::Quantity& q = model.quantities[quantity];
  return {std::move(id),
          q.name,
          "The model's " + q.name + " is wrong by more than its tolerance.",
          discover::EffectKind::parameter,
          {quantity},
          {times * q.sd},
          {startsAt({q.nominal})},
          {}};
}

}  // namespace info::robot
