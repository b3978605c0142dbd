#include "path/path_reach.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "bio/path/posture_samples.h"
#include "bio/skeleton/skeleton_motion.h"

namespace bio {
namespace {

template <int N>
Posture postureAt(const Skeleton& skeleton, const std::vector<double>& q) {
  std::vector<RigidMotion<double, N>> moved(skeleton.numSegments());
  const Eigen::Matrix<double, N, 1> coordinates =
      Eigen::Map<const Eigen::Matrix<double, N, 1>>(q.data());
  skeleton.motions<double, N>(coordinates, moved.data());
  Posture posture{q, {}};
  for (const auto& motion : moved) posture.placements.push_back(motion.value);
  return posture;
}

Posture postureAt(const Skeleton& skeleton, const std::vector<double>& q) {
  return skeleton.tree() ? postureOf(skeleton, q) : postureAt<1>(skeleton, q);
}

double interpolate(double a, double b, std::size_t i, std::size_t n) {
  return a + (b - a) * static_cast<double>(i) / static_cast<double>(n - 1);
}

}  // namespace

std::vector<Posture> samplePostures(const Skeleton& skeleton) {
  const std::size_t n = skeleton.coordinates().size();
  constexpr std::array<std::size_t, 4> resolution = {181, 31, 13, 7};
  const std::size_t perCoordinate = resolution.at(n - 1);

  // ranges, cut to a turn (or a metre) around the default where they say nothing
  std::vector<double> reference, lower, upper;
  for (const Coordinate& c : skeleton.coordinates()) {
    const double wide = c.isRotation ? std::numbers::pi : 1.0;
    reference.push_back(c.defaultValue);
    lower.push_back(std::max(c.rangeMin, c.defaultValue - wide));
    upper.push_back(std::min(c.rangeMax, c.defaultValue + wide));
  }
  std::vector<std::vector<double>> grid = {{}};
  for (std::size_t k = 0; k < n; ++k) {
    std::vector<std::vector<double>> finer;
    for (const auto& q : grid) {
      for (std::size_t i = 0; i < perCoordinate; ++i) {
        finer.push_back(q);
        finer.back().push_back(interpolate(lower[k], upper[k], i, perCoordinate));
      }
    }
    grid = std::move(finer);
  }
  const auto distance = [&](const std::vector<double>& q) {
    double sum = 0;
    for (std::size_t k = 0; k < n; ++k) sum += (q[k] - reference[k]) * (q[k] - reference[k]);
    return sum;
  };
  std::stable_sort(grid.begin(), grid.end(),
                   [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
  std::vector<Posture> postures = {postureAt(skeleton, reference)};
  for (const auto& q : grid) postures.push_back(postureAt(skeleton, q));
  return postures;
}

Vec3<double> nodePosition(const CompiledPath& path, const PathNode& node, const Posture& posture) {
  Vec3<double> p_S = node.p_S;
  if (node.motion >= 0) {
    const CompiledPointMotion& motion = path.motions[static_cast<std::size_t>(node.motion)];
    Vec3<double> local;
    for (std::size_t i = 0; i < 3; ++i) {
      const Skeleton::CoordinateSource& source = motion.source[i];
      double x = source.value;
      if (source.freeIndex >= 0) {
        x = source.coupling.evaluate(posture.q[static_cast<std::size_t>(source.freeIndex)]).value;
      }
      local[static_cast<Eigen::Index>(i)] = motion.location[i].evaluate(x).value;
    }
    p_S = node.X_SB.R * local + node.X_SB.p;
  }
  const Placement<double>& X = posture.placements[node.segment];
  return X.R * p_S + X.p;
}

Vec3<double> seenFrom(const Posture& posture, std::size_t segment, const Placement<double>& X_SC,
                      const Vec3<double>& p_G) {
  const Placement<double>& X = posture.placements[segment];
  const Vec3<double> p_S = X.R.transpose() * (p_G - X.p);
  return X_SC.R.transpose() * (p_S - X_SC.p);
}

ChainPlacements placementsIn(const Posture& posture, const CompiledPath& path,
                             const PathChain& chain) {
  return placementsOf(path, chain, [&](std::size_t segment) -> const Placement<double>& {
    return posture.placements[segment];
  });
}

double closestApproach(const PathSurface& surface, const Vec3<double>& p_CP,
                       const Vec3<double>& p_CQ) {
  const double never = std::numeric_limits<double>::infinity();
  if (surface.general && std::holds_alternative<TorusSurface>(*surface.general)) {
    const Vec3<double> d = p_CQ - p_CP;
    const double t = std::clamp(-p_CP.dot(d) / d.squaredNorm(), 0.0, 1.0);
    return (p_CP + t * d).norm() / sizeOf(*surface.general);
  }
  if (surface.general && std::holds_alternative<EllipsoidSurface>(*surface.general)) {
    const Vec3<double>& semiAxes = std::get<EllipsoidSurface>(*surface.general).semiAxes();
    const Vec3<double> P = p_CP.cwiseQuotient(semiAxes);
    const Vec3<double> d = p_CQ.cwiseQuotient(semiAxes) - P;
    const double t = -P.dot(d) / d.squaredNorm();
    return t > 0 && t < 1 ? (P + t * d).norm() : never;
  }
  Vec3<double> P = p_CP, d = p_CQ - p_CP;
  if (!surface.isSphere) P.z() = 0, d.z() = 0;
  const double t = -P.dot(d) / d.squaredNorm();
  if (!(t > 0 && t < 1)) return never;
  const double height = p_CP.z() + t * (p_CQ.z() - p_CP.z());
  if (!surface.isSphere && std::abs(height) > 1.02 * surface.halfLength) return never;
  return (P + t * d).norm() / surface.radius;
}

bool touches(const CompiledPath& path, const PathSpan& span, const SpanSurface& way,
             const Posture& posture) {
  const PathSurface& surface = path.surfaces[way.surface];
  const auto seen = [&](std::size_t node) {
    return seenFrom(posture, surface.segment, surface.X_SC,
                    nodePosition(path, path.nodes[node], posture));
  };
  const Vec3<double> P = seen(span.a), Q = seen(span.b);
  if (surfaceIsOutOfPlay(surface, surface.radius, way, P, Q)) return false;
  return surface.isSphere ? wrapSphere(surface.radius, way.way, P, Q).touches
                          : wrapCylinder(surface.radius, way.side, P, Q).touches;
}

}  // namespace bio
