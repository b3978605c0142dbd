#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "bio/model/units.h"
#include "bio/review/trial_review.h"
#include "bio/skeleton/skeleton.h"

namespace bio {

std::vector<std::string> heldRemarks(const Trial& trial, const Model& model,
                                     const SkeletonOptions& options) {
  std::vector<std::string> remarks;
  const Skeleton skeleton(model, options);
  for (const MeasuredChannel& motion : trial.measured) {
    if (!motion.what.isCoordinate() || skeleton.indexOf(motion.what.object) >= 0) continue;
    const Coordinate& c = findCoordinate(model, motion.what.object);
    const Skeleton::CoordinateSource& source = skeleton.sourceOf(c.name);
    const bool isCoupled =
        std::any_of(model.couplers.begin(), model.couplers.end(),
                    [&](const CoordinateCoupler& coupler) { return coupler.dependent == c.name; });
    if (isCoupled) {
      remarks.push_back(fmt::format(
          "{}: '{}' is measured but not compared, since in the model it follows another coordinate",
          trial.file, c.name));
      continue;
    }
    const ShownUnit unit = positionUnit(c.isRotation);
    const double furthest = (motion.values.array() - source.value).abs().maxCoeff() * unit.factor;
    if (furthest <= 0.1) continue;
    const std::string measured = fmt::format(
        "{}: '{}' is measured, {:.4g} to {:.4g} {}", trial.file, c.name,
        motion.values.minCoeff() * unit.factor, motion.values.maxCoeff() * unit.factor, unit.name);
    if (options.lockedValues.contains(c.name)) {
      remarks.push_back(
          fmt::format("{}, and held at {:.4g} as requested", measured, source.value * unit.factor));
      continue;
    }
    const double mean = motion.values.mean();
    throw std::invalid_argument(fmt::format(
        "{}, but is not free and would be held at {:.4g}: --lock {}={} holds it at its mean, "
        "--coordinate {} frees it",
        measured, source.value * unit.factor, c.name,
        c.isRotation ? fmt::format("{:.4g}deg", mean * unit.factor) : fmt::format("{:.6g}", mean),
        c.name));
  }
  return remarks;
}

}  // namespace bio
