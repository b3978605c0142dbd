#include "report/polyline.h"

#include <cmath>
#include <cstddef>
#include <utility>

namespace app {
namespace {

/// Distance of a point from the stretch between two others.
double distanceFrom(const PlanePoint& a, const PlanePoint& b, const PlanePoint& point) {
  const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
  double t = square > 0 ? ((point.x - a.x) * dx + (point.y - a.y) * dy) / square : 0;
  t = t < 0 ? 0 : t > 1 ? 1 : t;
  return std::hypot(point.x - a.x - t * dx, point.y - a.y - t * dy);
}

}  // namespace

std::vector<PlanePoint> withoutInvisible(const std::vector<PlanePoint>& points, double tolerance) {
  if (points.size() < 3) return points;
  std::vector<bool> kept(points.size(), false);
  kept.front() = kept.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> open = {{0, points.size() - 1}};
  while (!open.empty()) {
    const auto [from, to] = open.back();
    open.pop_back();
    std::size_t farthest = from;
    double most = tolerance;
    for (std::size_t i = from + 1; i < to; ++i) {
      const double distance = distanceFrom(points[from], points[to], points[i]);
      if (distance <= most) continue;
      most = distance;
      farthest = i;
    }
    if (farthest == from) continue;
    kept[farthest] = true;
    open.emplace_back(from, farthest);
    open.emplace_back(farthest, to);
  }
  std::vector<PlanePoint> result;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (kept[i]) result.push_back(points[i]);
  return result;
}

std::vector<PlanePoint> withoutRepeated(const std::vector<PlanePoint>& points, double distance) {
  std::vector<PlanePoint> result;
  for (const PlanePoint& point : points) {
    const bool isNew = result.empty() ||
                       std::hypot(point.x - result.back().x, point.y - result.back().y) >= distance;
    if (isNew) result.push_back(point);
  }
  return result;
}

}  // namespace app
