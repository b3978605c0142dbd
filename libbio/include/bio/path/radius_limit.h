#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "bio/path/compiled_path.h"

namespace bio {

/// Upper limit of the radius of a wrap object. If an end of a span lies inside the radius, the span
/// is straight, as in OpenSim: the muscle's length and moment arm would jump as the model moves,
/// and the wrap would silently vanish.
struct RadiusLimit {
  double radius = std::numeric_limits<double>::infinity();  ///< [m]
  std::size_t point = 0;  ///< index in Path::points of the point that the object reaches first
  std::vector<double> q;  ///< posture in which this happens, free coordinates [rad] or [m]
};

/// The smallest distance, over all postures, between the cylinder's axis or sphere's centre and the
/// ends of the spans that may touch the wrap object. A point that already lies inside in some
/// posture sets no limit.
/// The limit of an ellipsoid or a torus is that of one of its numbers while the others stay.
/// @param wrap its index in Path::wraps
/// @param number  of the surface's numbers (ImplicitSurface)
RadiusLimit radiusLimit(const CompiledPath& path, std::size_t wrap,
                        const std::vector<Posture>& postures, int number = 0);

/// "path point TRIlong-P5 lies inside at elbow_flexion = 53 deg"
std::string describe(const RadiusLimit& limit, const Path& path, const Skeleton& skeleton);

}  // namespace bio
