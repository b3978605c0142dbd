#pragma once

#include "bio/path/compiled_path.h"

namespace bio {

/// A path point in ground.
Vec3<double> nodePosition(const CompiledPath& path, const PathNode& node, const Posture& posture);

/// A point of the ground in a frame that sits in a segment.
Vec3<double> seenFrom(const Posture& posture, std::size_t segment, const Placement<double>& X_SC,
                      const Vec3<double>& p_G);

/// The surfaces of a chain in the ground.
ChainPlacements placementsIn(const Posture& posture, const CompiledPath& path,
                             const PathChain& chain);

/// Whether a span that is led over one surface with a closed form alone touches it in a posture.
bool touches(const CompiledPath& path, const PathSpan& span, const SpanSurface& way,
             const Posture& posture);

/// The least distance of a segment's inner points from the origin (of a cylinder: from its axis),
/// in units of the radius; infinite where it is that of an end, or beyond a cylinder's ends. Of an
/// ellipsoid in its semi-axes; of a torus in the radius of the sphere round it, ends included.
double closestApproach(const PathSurface& surface, const Vec3<double>& p_CP,
                       const Vec3<double>& p_CQ);

}  // namespace bio
