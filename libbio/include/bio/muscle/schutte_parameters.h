#pragma once

#include <optional>

#include "bio/muscle/curves/function.h"

namespace bio {

/// Parameters of a Schutte muscle (schutte_muscle.h says what they mean).
struct SchutteParameters {
  double maxIsometricForce = 0;   ///< F0 [N] > 0
  double optimalFibreLength = 0;  ///< ℓ0 [m] > 0
  double tendonSlackLength = 0;   ///< ℓs [m] > 0
  double pennation = 0;           ///< α0 at ℓ0 [rad], 0 ≤ α0 < π/2
  double timeScale = 0.1;         ///< t_s [s] > 0
  double activation1 = 7.667;     ///< rate factor per excitation, rising [1]
  double activation2 = 1.459854;  ///< rate factor [1] > 0
  double damping = 0.1;           ///< B, normalised by F0·t_s/ℓ0 [1] > 0
  double minControl = 0;
  double maxControl = 1;
  SplineFunction tendonForceLength;                  ///< F/F0 over strain
  SplineFunction activeForceLength;                  ///< F/F0 over ℓ/ℓ0
  std::optional<SplineFunction> passiveForceLength;  ///< F/F0 over ℓ/ℓ0; absent: exp(8(l−1))/e⁴
  friend bool operator==(const SchutteParameters&, const SchutteParameters&) = default;
};

}  // namespace bio
