#pragma once

#include <Eigen/Dense>
#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "bio/path/chain_starts.h"
#include "bio/path/span.h"
#include "bio/path/surface/chain.h"

namespace bio {

struct CompiledPath;

/// Surfaces that a span of a path passes together, in the order in which it meets them, or one
/// without a closed form. Their segments may move against each other.
///
/// Which way a path goes round is decided once and then followed from posture to posture
/// (compilePath); the contacts in some of these postures are kept. Each evaluation starts from the
/// one nearest to it, so that the result does not depend on what was evaluated before.
struct PathChain {
  struct Member {
    std::size_t surface = 0;                          ///< in CompiledPath::surfaces
    Eigen::Vector3d hint = Eigen::Vector3d::UnitX();  ///< ChainObject::hint
  };
  int count = 0;
  std::array<Member, maxChain> members;
  bool inOneSegment = true;  ///< all members belong to one segment

  std::shared_ptr<const ChainStarts> starts;  ///< null: the hints alone decide
};

/// The objects of a chain, placed.
struct PlacedChain {
  std::size_t count = 0;
  std::array<ChainObject, maxChain> objects = {
      ChainObject{SphereSurface(1)}, ChainObject{SphereSurface(1)}, ChainObject{SphereSurface(1)},
      ChainObject{SphereSurface(1)}};

  std::span<const ChainObject> all() const { return {objects.data(), count}; }
};
/// @param radii  of Path::wraps, of cylinders and spheres; null: those compiled
PlacedChain placeChain(const CompiledPath& path, const PathChain& chain,
                       const ChainPlacements& X_GC, const double* radii = nullptr);

/// The taut string of a chain from P to Q, with derivatives over the ends and the objects'
/// placements by chainGradient and ChainChanges (chain_change.h). Objects come in the order of the
/// members. A cylinder is left out where both contacts lie beyond its ends, any object where an end
/// lies inside it. C¹ at touch and lift-off.
///
/// Allocates nothing.
/// @param placed  placeChain of the same chain and placements
/// @param used  bits of the surfaces that other spans use, which are left out; those touched are
/// added
/// @throws std::domain_error if no taut string is found
ChainPath tautChain(const CompiledPath& path, const PathChain& chain, const PlacedChain& placed,
                    const ChainPlacements& X_GC, const Vec3<double>& P, const Vec3<double>& Q,
                    unsigned& used);

/// The span over a chain within one segment, with first and second derivatives over the ends; P and
/// Q in that segment's frame.
SpanToSecondOrder<double> spanOver(const CompiledPath& path, const PathChain& chain,
                                   const Vec3<double>& p_SP, const Vec3<double>& p_SQ,
                                   unsigned& used, const double* radii = nullptr);

/// Points on the surfaces of a chain from P to Q, both left out, at most about `step` [rad] apart.
std::vector<Vec3<double>> chainPoints(const PlacedChain& placed, const ChainPath& taut,
                                      double step);

}  // namespace bio
