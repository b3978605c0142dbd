#pragma once

// What is taken for granted about the numbers of a muscle class; not public.

#include <algorithm>
#include <cmath>
#include <string_view>

#include "bio/muscle/muscle_property.h"

namespace bio {

/// Bounds and deviation of one number of a muscle.
struct HillPrior {
  bool counts;  ///< whether a motion depends on it
  double lower, upper, sd;
};

/// Prior of the number at a place of the table. The common lengths and forces as for Schutte's
/// class; a number of a curve or of the activation is known to a fifth of its value (to 0.05 where
/// it is 0) and kept within a half and twice of it, the fibre's damping within a tenth and ten
/// times; always within the property's own range.
template <class Parameters>
HillPrior hillPrior(const Parameters& p, std::size_t i) {
  const auto& property = Parameters::properties[i];
  // the largest pennation is a limit of the law and no measured number; a rigid tendon has no
  // curve, and activation that is the excitation no time constants
  const std::string_view name = property.name;
  const bool isTime =
      name.ends_with("activation_time_constant") || name == "activation_dynamics_smoothing";
  const bool isTendon =
      name.starts_with("TendonForceLengthCurve/") || name == "tendon_strain_at_one_norm_force";
  if (!p.isGiven(i) || name == "maximum_pennation_angle" ||
      (p.ignoreTendonCompliance && isTendon) || (p.ignoreActivationDynamics && isTime)) {
    return {false, 0, 0, 0};
  }
  const double value = Parameters::at(p, i);
  if (i == muscles::common::pennation) return {true, 0, 1.2, 0.05};
  struct Spread {
    double lower, upper, sd;
  };
  constexpr Spread common[] = {
      {0.1, 10, 0.3}, {0.5, 2, 0.1}, {0.5, 2, 0.05}, {0, 0, 0}, {0.2, 5, 0.2}};
  Spread spread = i < muscles::common::count ? common[i] : Spread{0.5, 2, 0.2};
  if (name == "fiber_damping") spread = {0.1, 10, 0.5};
  const double size = std::abs(value) > 0 ? std::abs(value) : 0.25;
  HillPrior prior{true, value * spread.lower, value * spread.upper, size * spread.sd};
  if (value <= 0) prior.lower = value - size, prior.upper = value + size;
  // a hair inside an end that is not allowed
  const auto& range = property.range;
  const double hair = 1e-3 * size;
  prior.lower = std::max(prior.lower, range.withLow ? range.low : range.low + hair);
  prior.upper = std::min(prior.upper, range.withHigh ? range.high : range.high - hair);
  return prior;
}

}  // namespace bio
