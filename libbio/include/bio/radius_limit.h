#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "bio/compiled_path.h"

namespace bio {

/// Where the radius of a wrap object must end. At a radius at which an end of a span lies inside,
/// the span is straight, as in OpenSim: the muscle's length and moment arm jump as the arm moves,
/// and the wrap is gone without a word.
struct RadiusLimit {
  double radius = std::numeric_limits<double>::infinity();  ///< [m]
  std::size_t point = 0;  ///< the path point that meets the object first, its place in Path::points
  std::vector<double> q;  ///< the posture in which it does, free coordinates [rad] or [m]
};

/// The least distance, in all postures, of the ends of the spans that may touch a wrap object from
/// the cylinder's axis or the sphere's centre. A point that lies inside already, in any of them,
/// sets no limit.
/// @param wrap  its place in Path::wraps
RadiusLimit radiusLimit(const CompiledPath& path, std::size_t wrap,
                        const std::vector<Posture>& postures);

/// "path point TRIlong-P5 lies inside at elbow_flexion = 53 deg"
std::string describe(const RadiusLimit& limit, const Path& path, const Skeleton& skeleton);

}  // namespace bio
