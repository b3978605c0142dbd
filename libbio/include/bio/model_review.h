#pragma once

#include <string>
#include <vector>

#include "bio/model.h"

namespace bio {

/// Something about a model that is allowed but unusual.
struct Remark {
  std::string subject;  ///< e.g. "coordinate 'elbow_flexion'"
  std::string message;  ///< one line: quantity = value, and what is usual
};

/// Lists what a reader of the model should look at twice; nothing here stops a simulation.
///
/// Angles that look like degrees (|range|, |default| or a spring's rest beyond 4π rad); a default
/// outside its range; clamped coordinates (not simulated as such); inertias no body of that mass
/// can have (a moment larger than the sum of the other two, or a radius of gyration above 1 m) and
/// massless bodies at the end of the chain; lengths that look like millimetres (path points or mass
/// centres more than 3 m from their body's origin, wrap objects above 0.5 m); muscles with F0
/// outside 1 to 20,000 N, ℓ0 outside 5 mm to 0.6 m, slack length over ℓ0 outside 0.1 to 15,
/// pennation above 45°, Schutte curves that are negative, fall (tendon, passive) or do not peak
/// near F/F0 = 1, ℓ/ℓ0 = 1 (active); transform axes that are not of length 1; models without
/// muscles, or without a free coordinate.
std::vector<Remark> reviewModel(const Model& model);

}  // namespace bio
