#pragma once

#include <string>
#include <vector>

#include "bio/model/model.h"

namespace bio {

/// Severity of a remark.
enum class Weight {
  unusual,  ///< allowed, but worth checking
  warning,  ///< probably a mistake, as another unit; every command reports it
  error     ///< simulations refuse it
};

/// An unusual property of a model or a trial.
struct Remark {
  std::string subject;  ///< e.g. "coordinate 'elbow_flexion'"
  std::string message;  ///< one line: quantity = value, and the usual range
  Weight weight = Weight::unusual;
};

/// Lists unusual properties of a model. Only an inertia tensor with a negative principal moment is
/// an error.
///
/// Angles that look like degrees (|range|, |default| or a spring's rest beyond 4π rad); a default
/// outside its range; clamped coordinates (not simulated as such); inertias no body of that mass
/// can have (a moment larger than the sum of the other two, or a radius of gyration above 1 m) and
/// massless bodies at the end of the chain; lengths that look like millimetres (path points or mass
/// centres more than 3 m from their body's origin, wrap objects above 0.5 m); muscles whose points
/// coincide; muscles with F0 outside 1 to 20,000 N, ℓ0 outside 5 mm to 0.6 m, slack length over ℓ0
/// outside 0.1 to 15, pennation above 45°, Schutte curves that are negative, fall (tendon, passive)
/// or do not peak near F/F0 = 1, ℓ/ℓ0 = 1 (active); transform axes that are not of length 1; models
/// without muscles, or without a free coordinate.
///
/// Warnings: coordinates that cannot be free since they move no mass. Then come the remarks of
/// reviewPathPoints.
std::vector<Remark> reviewModel(const Model& model);

/// Remarks that require no skeleton.
std::vector<Remark> reviewNumbers(const Model& model);

/// Active path points of enabled muscles that lie inside a wrap object of their path, by 1 µm or
/// more, in the default posture; of a cylinder, between its ends. Spans that end there pass through
/// the object, here and in OpenSim.
std::vector<Remark> reviewPathPoints(const Model& model);

/// Reason why a model cannot be simulated: no muscle, none of a class that can be simulated, or no
/// coordinate that moves a mass; such a model can be used for paths and pictures only. Empty if it
/// can be simulated.
std::string whyNotSimulated(const Model& model);

}  // namespace bio
