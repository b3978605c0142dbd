#include "bio/path/radius_limit.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "bio/model/units.h"
#include "path/path_reach.h"

namespace bio {
namespace {

constexpr double noReach = std::numeric_limits<double>::infinity();

// The number at which the surface, growing, reaches a point.
double numberReaching(const EllipsoidSurface& surface, int number, const Vec3<double>& p) {
  Vec3<double> x = p.cwiseQuotient(surface.semiAxes());
  x[number] = 0;
  const double left = 1 - x.squaredNorm();
  return left > 0 ? std::abs(p[number]) / std::sqrt(left) : noReach;
}
double numberReaching(const TorusSurface& surface, int number, const Vec3<double>& p) {
  const double rho = std::hypot(p.x(), p.y());
  if (number == 1) return std::hypot(rho - surface.ringRadius(), p.z());
  const double across = surface.tubeRadius() * surface.tubeRadius() - p.z() * p.z();
  return across > 0 ? rho - std::sqrt(across) : noReach;
}
double numberReaching(const SphereSurface&, int, const Vec3<double>& p) {
  return p.norm();
}
double numberReaching(const CylinderSurface&, int, const Vec3<double>& p) {
  return p.head<2>().norm();
}

}  // namespace

RadiusLimit radiusLimit(const CompiledPath& path, std::size_t wrap,
                        const std::vector<Posture>& postures, int number) {
  std::map<std::size_t, RadiusLimit> ofNodes;
  double radius = 0;
  for (const Posture& posture : postures) {
    const PathVariant& variant =
        activeVariant(path, Eigen::Map<const Eigen::VectorXd>(
                                posture.q.data(), static_cast<Eigen::Index>(posture.q.size())));
    for (const PathSpan& span : variant.all) {
      for (const SpanSurface& way : span.surfaces) {
        const PathSurface& surface = path.surfaces[way.surface];
        if (surface.wrap != wrap) continue;
        const Surface shape = surfaceOf(surface, surface.radius);
        radius = std::visit([&](const auto& each) { return each.number(number); }, shape);
        for (const std::size_t node : {span.a, span.b}) {
          const Vec3<double> p_G = nodePosition(path, path.nodes[node], posture);
          const Vec3<double> p_C = seenFrom(posture, surface.segment, surface.X_SC, p_G);
          const double distance = std::visit(
              [&](const auto& each) { return numberReaching(each, number, p_C); }, shape);
          RadiusLimit& least = ofNodes[node];
          if (distance < least.radius) least = {distance, path.nodes[node].point, posture.q};
        }
      }
    }
  }
  RadiusLimit least;
  for (const auto& [node, limit] : ofNodes) {
    if (limit.radius > radius && limit.radius < least.radius) least = limit;
  }
  return least;
}

std::string describe(const RadiusLimit& limit, const Path& path, const Skeleton& skeleton) {
  std::string text = fmt::format("path point {} lies inside at", path.points[limit.point].name);
  const auto& coordinates = skeleton.coordinates();
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const bool turns = coordinates[i].isRotation;
    text += fmt::format("{} {} = {:.3g} {}", i == 0 ? "" : ",", coordinates[i].name,
                        turns ? limit.q[i] * degreesPerRadian : limit.q[i], turns ? "deg" : "m");
  }
  return text;
}

}  // namespace bio
