#include "bio/path/path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bio/path/posture_samples.h"
#include "path/path_reach.h"

namespace bio {
namespace {

// With so many pieces an elbow's are 1.3 degrees wide, and all stand but those with a kink. A range
// of more [rad] or [m] means that there is none.
constexpr std::size_t tablePieces = 120;
constexpr double widestRange = 10;

// The points on a surface from first to last contact, at most `step` apart in angle, in the
// surface's frame.
std::vector<Vec3<double>> arc(const PathSurface& surface, const SpanSurface& way,
                              const Vec3<double>& p_CP, const Vec3<double>& p_CQ, double step) {
  std::vector<Vec3<double>> points;
  const auto along = [&](const WrapContact<double>& contact, const Vec3<double>& axis,
                         double turning) {
    const int pieces = std::max(1, static_cast<int>(std::ceil(contact.angle / step)));
    const double rise = contact.p_CB.dot(axis) - contact.p_CA.dot(axis);
    for (int i = 0; i <= pieces; ++i) {
      const double part = static_cast<double>(i) / pieces;
      const Eigen::AngleAxisd turn(turning * contact.angle * part, axis);
      points.push_back(turn * contact.p_CA + rise * part * axis);
    }
  };
  if (surface.isSphere) {
    const SphereGeometry<double> g = sphereGeometry(surface.radius, way.way, p_CP, p_CQ);
    if (!g.touches) return points;
    along(wrapSphereContact(surface.radius, way.way, p_CP, p_CQ), g.normal, 1.0);
  } else {
    if (!cylinderGeometry(surface.radius, way.side, p_CP, p_CQ).touches) return points;
    along(wrapCylinderContact(surface.radius, way.side, p_CP, p_CQ), Vec3<double>::UnitZ(),
          way.side == Side::counterclockwise ? 1.0 : -1.0);
  }
  return points;
}

}  // namespace

MusclePath::MusclePath(const Model& model, const Skeleton& skeleton, const Muscle& muscle,
                       const std::vector<std::string>& wrapAsCylinder)
    : MusclePath(model, skeleton, muscle, wrapAsCylinder,
                 PostureSamples(model, skeleton).of(muscle)) {}

MusclePath::MusclePath(const Model& model, const Skeleton& skeleton, const Muscle& muscle,
                       const std::vector<std::string>& wrapAsCylinder,
                       const std::vector<Posture>& postures)
    : compiled_(compilePath(model, skeleton, muscle, wrapAsCylinder, postures)) {
  for (const PathPoint& point : muscle.path.points) parameters_.points.push_back(point.location);
  // a moving point that only locked coordinates move sits where its functions say
  for (const PathNode& node : compiled_.nodes) {
    if (node.motion >= 0) continue;
    const Vec3<double> d = node.p_S - node.X_SB.p;
    parameters_.points[node.point] = node.X_SB.R.transpose() * d;
  }
  parameters_.radii.assign(muscle.path.wraps.size(), 0.0);
  for (const PathSurface& surface : compiled_.surfaces) {
    parameters_.radii[surface.wrap] = surface.radius;
  }
}

bool MusclePath::moves() const {
  if (compiled_.function) return !compiled_.function->support().empty();
  return std::any_of(compiled_.variants.begin(), compiled_.variants.end(),
                     [](const PathVariant& variant) { return !variant.moving.empty(); });
}

void MusclePath::tabulate(const Skeleton& skeleton) {
  if (table_ || skeleton.numCoordinates() != 1) return;
  const Coordinate& coordinate = skeleton.coordinates().front();
  const double range = coordinate.rangeMax - coordinate.rangeMin;
  if (!(range > 0 && range < widestRange)) return;
  std::vector<RigidMotion<double, 1>> motions(skeleton.numSegments());
  const auto exact = [&](double at) {
    const Eigen::Matrix<double, 1, 1> q(at);
    skeleton.motions<double, 1>(q, motions.data());
    const LengthJet<1> jet = length<1>(q, motions.data());
    return PathTable::Value{jet.length, jet.dL_dq[0], jet.d2L_dq2(0, 0), jet.wrapped};
  };
  table_ = std::make_shared<const PathTable>(coordinate.rangeMin - range / 10,
                                             coordinate.rangeMax + range / 10, tablePieces, exact);
}

std::vector<Eigen::Vector3d> MusclePath::pathPoints(const Posture& posture, double step) const {
  unsigned used = 0;
  return trace(posture, step, used);
}

std::vector<std::size_t> MusclePath::touchedWraps(const Posture& posture) const {
  unsigned used = 0;
  trace(posture, std::numbers::pi, used);
  std::vector<std::size_t> wraps;
  for (std::size_t i = 0; i < compiled_.surfaces.size(); ++i) {
    if (((used >> i) & 1u) != 0) wraps.push_back(compiled_.surfaces[i].wrap);
  }
  std::sort(wraps.begin(), wraps.end());
  return wraps;
}

/// @param used  becomes the bits of the surfaces that are touched
std::vector<Eigen::Vector3d> MusclePath::trace(const Posture& posture, double step,
                                               unsigned& used) const {
  if (compiled_.function) return {};
  const auto& q = posture.q;
  const PathVariant& variant = activeVariant(
      compiled_, Eigen::Map<const Eigen::VectorXd>(q.data(), static_cast<Eigen::Index>(q.size())));
  const auto position = [&](std::size_t node) {
    return nodePosition(compiled_, compiled_.nodes[node], posture);
  };
  std::vector<Eigen::Vector3d> line = {position(variant.all.front().a)};
  for (const PathSpan& span : variant.all) {
    const Vec3<double> Q = position(span.b);
    if (span.chain >= 0) {
      const PathChain& chain = compiled_.chains[static_cast<std::size_t>(span.chain)];
      const ChainPlacements X_GC = placementsIn(posture, compiled_, chain);
      const PlacedChain placed = placeChain(compiled_, chain, X_GC);
      const ChainPath taut = tautChain(compiled_, chain, placed, X_GC, line.back(), Q, used);
      for (const Vec3<double>& p_G : chainPoints(placed, taut, step)) line.push_back(p_G);
      line.push_back(Q);
      continue;
    }
    for (const SpanSurface& way : span.surfaces) {
      if (((used >> way.surface) & 1u) != 0) continue;
      const PathSurface& surface = compiled_.surfaces[way.surface];
      const Vec3<double> p_CP = seenFrom(posture, surface.segment, surface.X_SC, line.back());
      const Vec3<double> p_CQ = seenFrom(posture, surface.segment, surface.X_SC, Q);
      if (surfaceIsOutOfPlay(surface, surface.radius, way, p_CP, p_CQ)) continue;
      const auto points = arc(surface, way, p_CP, p_CQ, step);
      if (points.empty()) continue;
      used |= 1u << way.surface;
      const Placement<double> X_GC = posture.placements[surface.segment] * surface.X_SC;
      for (const Vec3<double>& p_C : points) line.push_back(X_GC.R * p_C + X_GC.p);
      break;
    }
    line.push_back(Q);
  }
  return line;
}

std::vector<PathSwitch> MusclePath::switches() const {
  std::vector<PathSwitch> switches;
  for (const CompiledCondition& condition : compiled_.conditions) {
    for (const double value :
         {condition.lower - conditionMargin, condition.upper + conditionMargin}) {
      switches.push_back({condition.source.freeIndex, condition.source.coupling, value});
    }
  }
  return switches;
}

}  // namespace bio
