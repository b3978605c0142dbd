#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <string_view>

#include "bio/muscle/number_type.h"

namespace bio::muscles {

/// Which values a number may have: from `low` to `high`, each end itself allowed or not.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool withLow = false;
  bool withHigh = false;
  /// NaN is never within; neither is infinity, unless it is an end that is allowed.
  constexpr bool holds(double x) const {
    return (x > low || (withLow && x == low)) && (x < high || (withHigh && x == high));
  }
};
inline constexpr Range anyNumber{};
inline constexpr Range positive{.low = 0};
inline constexpr Range notNegative{.low = 0, .withLow = true};
inline constexpr Range fraction{.low = 0, .high = 1, .withLow = true, .withHigh = true};
inline constexpr Range acute{.low = 0, .high = 1.5707963267948966, .withLow = true};

/// One number of a muscle class as OpenSim's model files have it.
struct MuscleProperty {
  /// OpenSim's property; of a sub-object with its class in front, e.g.
  /// "TendonForceLengthCurve/strain_at_one_norm_force"
  std::string_view name;
  std::string_view unit;  ///< empty: a pure number
  Range range;            ///< each number for itself; rules between numbers are the class's
};

/// The numbers that every class begins with, in this order, and their places.
namespace common {
inline constexpr std::size_t maxIsometricForce = 0, optimalFibreLength = 1, tendonSlackLength = 2,
                             pennation = 3, maxContractionVelocity = 4, count = 5;
inline constexpr std::array<MuscleProperty, count> properties{{
    {"max_isometric_force", "N", positive},
    {"optimal_fiber_length", "m", positive},
    {"tendon_slack_length", "m", positive},
    {"pennation_angle_at_optimal", "rad", acute},
    {"max_contraction_velocity", "optimal fibre lengths/s", positive},
}};
}  // namespace common

/// The numbers of class Muscle, at OpenSim's defaults.
template <class T>
struct HillParameters {
  T maxIsometricForce = T(1000.0);     ///< F0 [N] > 0
  T optimalFibreLength = T(0.1);       ///< ℓ0 [m] > 0
  T tendonSlackLength = T(0.2);        ///< ℓs [m] > 0
  T pennation = T(0.0);                ///< α0 at ℓ0 [rad], 0 ≤ α0 < π/2
  T maxContractionVelocity = T(10.0);  ///< V [ℓ0/s] > 0
  friend bool operator==(const HillParameters&, const HillParameters&) = default;
};

/// Switches of a muscle class, beside its measured numbers.
struct MuscleSwitches {
  bool ignoreTendonCompliance = false;    ///< the tendon is rigid
  bool ignoreActivationDynamics = false;  ///< activation = control
  double minControl = 0;  ///< bounds for optimisers; no law clamps a control with them
  double maxControl = 1;
  friend bool operator==(const MuscleSwitches&, const MuscleSwitches&) = default;
};

/// Throws std::invalid_argument "NAME is VALUE UNIT, must be RULE" unless the property's range
/// holds the value and it is finite.
void requireWithin(const MuscleProperty& property, double value);
/// Throws std::invalid_argument "NAME is VALUE, must be RULE" unless it holds.
void requireRule(bool holds, std::string_view name, double value, std::string_view rule);

/// The place of a property by OpenSim's name, Parameters::count if the class has none.
template <class Parameters>
constexpr std::size_t placeOf(std::string_view name) {
  std::size_t i = 0;
  while (i < Parameters::count && Parameters::properties[i].name != name) ++i;
  return i;
}

/// Every number of `parameters` within its range.
/// @throws std::invalid_argument
template <class Parameters>
void requireRanges(const Parameters& parameters) {
  for (std::size_t i = 0; i < Parameters::count; ++i) {
    requireWithin(Parameters::properties[i], plainValue(Parameters::at(parameters, i)));
  }
}

/// The numbers and switches in another number type.
template <template <class> class Parameters, class To, class From>
Parameters<To> inNumbers(const Parameters<From>& from) {
  Parameters<To> to;
  for (std::size_t i = 0; i < to.count; ++i) {
    Parameters<To>::at(to, i) = To(plainValue(Parameters<From>::at(from, i)));
  }
  to.takeSwitches(from);
  return to;
}

}  // namespace bio::muscles
