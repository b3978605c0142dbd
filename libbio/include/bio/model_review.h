#pragma once

#include <string>
#include <vector>

#include "bio/model.h"

namespace bio {

/// How much a remark weighs.
enum class Weight {
  unusual,  ///< allowed, to be looked at twice
  warning,  ///< probably another unit: whoever uses it should be told
  error     ///< simulations refuse it
};

/// Something about a model or a trial that is not as usual.
struct Remark {
  std::string subject;  ///< e.g. "coordinate 'elbow_flexion'"
  std::string message;  ///< one line: quantity = value, and what is usual
  Weight weight = Weight::unusual;
};

/// Lists what a reader of the model should look at twice. Only an inertia tensor with a negative
/// principal moment is an error.
///
/// Angles that look like degrees (|range|, |default| or a spring's rest beyond 4π rad); a default
/// outside its range; clamped coordinates (not simulated as such); inertias no body of that mass
/// can have (a moment larger than the sum of the other two, or a radius of gyration above 1 m) and
/// massless bodies at the end of the chain; lengths that look like millimetres (path points or mass
/// centres more than 3 m from their body's origin, wrap objects above 0.5 m); muscles whose
/// points are all at one place; muscles with F0 outside 1 to 20,000 N, ℓ0 outside 5 mm to 0.6 m,
/// slack length over ℓ0 outside 0.1 to 15, pennation above 45°, Schutte curves that are negative,
/// fall (tendon, passive) or do not peak near F/F0 = 1, ℓ/ℓ0 = 1 (active); transform axes that are
/// not of length 1; models without muscles, or without a free coordinate.
///
/// Warnings: coordinates that cannot be free since they move no mass.
std::vector<Remark> reviewModel(const Model& model);

/// The same but for the warnings, which need a skeleton: what the numbers by themselves say.
std::vector<Remark> reviewNumbers(const Model& model);

/// Why nothing of a model can be simulated: no muscle, none of a class that is simulated, or no
/// coordinate that moves a mass; then it serves for paths and pictures alone. Empty: something can.
std::string whyNotSimulated(const Model& model);

}  // namespace bio
