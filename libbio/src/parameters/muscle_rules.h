#pragma once

// Names and priors of the numbers of Schutte's muscles; not public.

#include "bio/parameters/parameters.h"

namespace bio {

struct MuscleRule {
  MuscleQuantity quantity;
  const char* name;
  const char* unit;
  const char* meaning;
  double SchutteParameters::*member;  ///< null: a scale of a curve
  double lower, upper, sd;            ///< fractions of the value
};
inline constexpr MuscleRule muscleRules[] = {
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

}  // namespace bio
