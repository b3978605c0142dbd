#pragma once

#include <Eigen/Dense>
#include <array>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "bio/model/model.h"
#include "bio/muscle/curves/curves.h"
#include "bio/path/length_function.h"
#include "bio/path/path_chain.h"
#include "bio/path/span.h"
#include "bio/path/surface/wrap_rule.h"
#include "bio/skeleton/rigid_motion.h"
#include "bio/skeleton/skeleton.h"

namespace bio {

/// A point of a path, in the frame of the segment that carries it.
struct PathNode {
  std::size_t point = 0;    ///< its index in Path::points
  std::size_t segment = 0;  ///< of the skeleton; 0 is the ground
  Placement<double> X_SB;   ///< its body in the segment
  Vec3<double> p_S;         ///< in the segment frame [m]; unused if it moves
  int motion = -1;          ///< index into CompiledPath::motions, −1: fixed in its body
  int condition = -1;       ///< index into CompiledPath::conditions, −1: always active
};

/// A location in a body as a function of free coordinates.
struct CompiledPointMotion {
  std::array<Skeleton::CoordinateSource, 3> source;
  std::vector<FunctionEvaluator> location;  ///< x, y, z over the coordinate
};

/// Active while lower ≤ coordinate ≤ upper, with OpenSim's tolerance of 1e-5 at both borders.
struct CompiledCondition {
  Skeleton::CoordinateSource source;
  double lower = 0;
  double upper = 0;
};

/// A cylinder about z, a sphere or a surface without a closed form, in the frame of its segment.
struct PathSurface {
  bool isSphere = false;
  std::size_t wrap = 0;     ///< its index in Path::wraps
  std::size_t segment = 0;  ///< of the skeleton
  Placement<double> X_SC;   ///< surface in the segment
  double radius = 0;        ///< [m]
  double halfLength = 0;    ///< cylinder [m]
  WrapQuadrant quadrant = WrapQuadrant::all;
  std::optional<Surface> general;  ///< an ellipsoid or a torus; then `radius` is its first number
};

/// The surface of any kind, as chains need it.
/// @param radius  of a cylinder or sphere [m]
Surface surfaceOf(const PathSurface& surface, double radius);

/// A surface that a span may touch, and the side on which it then passes.
struct SpanSurface {
  std::size_t surface = 0;
  Side side = Side::counterclockwise;  ///< cylinder
  Way way = Way::shorter;              ///< sphere
  SlipAngle slip = {};                 ///< cylinder
};

/// From node a to node b.
struct PathSpan {
  std::size_t a = 0;
  std::size_t b = 0;
  bool moves = false;
  std::vector<SpanSurface> surfaces;  ///< in the order in which they are tried
  int chain = -1;  ///< index into CompiledPath::chains if they are solved together, −1: one by one
};

/// The path while a given set of conditional points is active.
struct PathVariant {
  double fixedLength = 0;        ///< of the spans that do not move [m]
  std::vector<PathSpan> moving;  ///< in path order
  std::vector<PathSpan> all;     ///< moving and fixed, in path order
};

/// A muscle's path prepared for evaluation; the data of MusclePath.
struct CompiledPath {
  std::vector<PathNode> nodes;
  std::vector<CompiledPointMotion> motions;
  std::vector<CompiledCondition> conditions;
  std::vector<PathSurface> surfaces;
  std::vector<PathChain> chains;
  std::vector<PathVariant> variants;  ///< by the bits of the active conditions
  /// Instead of all of these; then there is one variant, without spans.
  std::optional<LengthFunction> function;
  std::vector<std::string> notes;
  std::vector<std::string> warnings;  ///< what a path does that its author will not expect
};

/// Where the surfaces of a chain are, by where their segments are: placementOf(segment).
template <class PlacementOf>
ChainPlacements placementsOf(const CompiledPath& path, const PathChain& chain,
                             const PlacementOf& placementOf) {
  ChainPlacements X;
  for (std::size_t j = 0; j < static_cast<std::size_t>(chain.count); ++j) {
    const PathSurface& surface = path.surfaces[chain.members[j].surface];
    X[j] = placementOf(surface.segment) * surface.X_SC;
  }
  return X;
}

/// Thrown for a path that cannot be computed here and that no option can change. Callers leave the
/// muscle out with a warning.
class UnsupportedWrap : public std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// One line for each ellipsoid that is taken for a cylinder: that this is no longer needed.
std::vector<std::string> adviceOnCylinders(const std::vector<std::string>& wrapAsCylinder);

/// The skeleton in one configuration.
struct Posture {
  std::vector<double> q;
  std::vector<Placement<double>> placements;  ///< of all segments
};

/// The postures in which compilePath checks which surfaces a span can touch: the default posture,
/// then a grid over the ranges of up to four coordinates, nearest to the default first. One list
/// serves all muscles. More coordinates: posture_samples.h.
std::vector<Posture> samplePostures(const Skeleton& skeleton);

/// See MusclePath.
/// @param postures  samplePostures(skeleton)
CompiledPath compilePath(const Model& model, const Skeleton& skeleton, const Muscle& muscle,
                         const std::vector<std::string>& wrapAsCylinder,
                         const std::vector<Posture>& postures);

/// Conditional points stay active this far beyond their range, as in OpenSim [rad] or [m].
constexpr double conditionMargin = 1e-5;

/// Whether a point with this condition is active where its coordinate has this value [rad] or [m].
template <class Condition>
bool isActive(const Condition& condition, double coordinate) {
  return coordinate >= condition.lower - conditionMargin &&
         coordinate <= condition.upper + conditionMargin;
}

/// The path variant that is active in a configuration.
template <class Q>
const PathVariant& activeVariant(const CompiledPath& path, const Q& q) {
  std::size_t bits = 0;
  for (std::size_t i = 0; i < path.conditions.size(); ++i) {
    const CompiledCondition& condition = path.conditions[i];
    const double coordinate =
        condition.source.coupling
            .evaluate(plainValue(q[static_cast<Eigen::Index>(condition.source.freeIndex)]))
            .value;
    bits |= (isActive(condition, coordinate) ? std::size_t{1} : std::size_t{0}) << i;
  }
  return path.variants[bits];
}

/// Whether a span with these ends in the surface's frame is straight because an end lies within the
/// radius, the path has slipped off a cylinder, or both contacts lie beyond a cylinder's ends.
template <class T>
bool surfaceIsOutOfPlay(const PathSurface& surface, const T& radius, const SpanSurface& way,
                        const Vec3<T>& p_CP, const Vec3<T>& p_CQ) {
  const double r = plainValue(radius);
  const auto at = [](const Vec3<T>& p) {
    return Vec3<double>(plainValue(p.x()), plainValue(p.y()), plainValue(p.z()));
  };
  const Vec3<double> P = at(p_CP), Q = at(p_CQ);
  if (surface.isSphere) return !(P.squaredNorm() > r * r && Q.squaredNorm() > r * r);
  if (!(P.head<2>().squaredNorm() > r * r && Q.head<2>().squaredNorm() > r * r)) return true;
  if (hasSlippedOff(way.slip, way.side, P, Q)) return true;
  const bool within =
      std::abs(P.z()) <= surface.halfLength && std::abs(Q.z()) <= surface.halfLength;
  return !within && !cylinderTouches(r, 2 * surface.halfLength, way.side, P, Q);
}

}  // namespace bio
