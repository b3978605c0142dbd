#pragma once

#include <vector>

namespace app {

struct PlanePoint {
  double x = 0, y = 0;
};

/// The line through fewer of its points, none of which was farther than `tolerance` from it (D.
/// Douglas and T. Peucker, 1973).
std::vector<PlanePoint> withoutInvisible(const std::vector<PlanePoint>& points, double tolerance);

/// The points without those that are nearer than `distance` to the last one kept.
std::vector<PlanePoint> withoutRepeated(const std::vector<PlanePoint>& points, double distance);

}  // namespace app
