#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "info/discovery/likelihood/discovery_problem.h"

namespace reduced {

/// Quantities of the reduced elbow, then two for each trial's start.
enum : std::size_t {
  kForce = 0,      ///< F0 of four muscles [N]
  kLength = 4,     ///< ℓ_opt of four muscles [m]
  kMass = 8,       ///< of the forearm [kg]
  kTau = 9,        ///< τ_a [s]; the last of the nuisances
  kViscous,        ///< b [N·m·s/rad]
  kCoulomb,        ///< τ_c [N·m]
  kStribeck,       ///< [N·m]
  kStribeckSpeed,  ///< [rad/s]
  kDrag,           ///< [N·m·s²/rad²]
  kStiffness,      ///< [N·m/rad]
  kLimit,          ///< [N·m]
  kLimitFlexed,    ///< [rad]
  kLimitExtended,  ///< [rad]
  kPayload,        ///< [kg]
  kTilt,           ///< [rad]
  kConstant,       ///< [N·m]
  kHandForce,      ///< [N]
  kFatigue,        ///< share of force that is lost
  kFatigueTime,    ///< T [s]
  kDelay,          ///< [s]
  kShape,          ///< A
  kTriFromBic,     ///< share of BIC's signal in TRI's
  kBicFromTri,     ///< share of TRI's signal in BIC's
  kWrapBic,        ///< Δr [m]
  kWrapTri,        ///< Δr [m]
  kBias,           ///< [rad]
  kGain,
  kClock,   ///< [s]
  kShared,  ///< how many
};

std::vector<info::discover::Quantity> sharedQuantities();
/// @param hidden ids to leave out
std::vector<info::discover::Candidate> catalogue(const std::vector<std::string>& hidden = {});

}  // namespace reduced
