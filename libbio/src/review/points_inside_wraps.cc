#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <stdexcept>

#include "bio/path/compiled_path.h"
#include "bio/path/posture_samples.h"
#include "bio/review/model_review.h"
#include "model/plausible.h"
#include "path/path_reach.h"
#include "path/surface/wrap_candidate.h"

// What of a review asks where the points of paths are.

namespace bio {
namespace {

/// Points on a surface are often written with few digits: what is less deep is on it [m].
constexpr double leastDepth = 1e-6;

/// A model in its default posture; all coordinates but coupled ones are free, so that moving points
/// and couplers are where they belong.
class DefaultPosture {
 public:
  explicit DefaultPosture(const Model& model)
      : skeleton_(model, {coordinatesOf(model), {}, true}),
        posture_(postureOf(skeleton_, valuesOf(skeleton_))) {}

  static std::vector<std::string> coordinatesOf(const Model& model) {
    std::set<std::string> dependent;
    for (const CoordinateCoupler& coupler : model.couplers) dependent.insert(coupler.dependent);
    std::vector<std::string> names;
    for (const Joint& joint : model.joints) {
      for (const Coordinate& coordinate : joint.coordinates) {
        if (!dependent.contains(coordinate.name)) names.push_back(coordinate.name);
      }
    }
    return names;
  }

  bool isActive(const PathPoint& point) const {
    return !point.condition ||
           bio::isActive(*point.condition, valueOf(point.condition->coordinate));
  }

  /// In the frame of a wrap object.
  Vec3<double> seenFrom(const PathSurface& surface, const PathPoint& point) const {
    Vec3<double> p_B = point.location;
    if (point.motion) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::string& coordinate = point.motion->coordinate[i];
        p_B[static_cast<Eigen::Index>(i)] =
            FunctionEvaluator(point.motion->location[i])
                .evaluate(coordinate.empty() ? 0 : valueOf(coordinate))
                .value;
      }
    }
    const BodyPlacement& place = skeleton_.placeOf(point.body);
    const Placement<double>& X_GS = posture_.placements[place.segment];
    const Vec3<double> p_S = place.X_SB.R * p_B + place.X_SB.p;
    return bio::seenFrom(posture_, surface.segment, surface.X_SC, X_GS.R * p_S + X_GS.p);
  }

  PathSurface surfaceOf(const WrapObject& object) const {
    return candidateWrap(object, skeleton_.placeOf(object.body), 0, {}).shape;
  }

 private:
  static std::vector<double> valuesOf(const Skeleton& skeleton) {
    const Eigen::VectorXd q = skeleton.defaultValues();
    return {q.begin(), q.end()};
  }
  double valueOf(const std::string& coordinate) const {
    const Skeleton::CoordinateSource& source = skeleton_.sourceOf(coordinate);
    if (source.freeIndex < 0) return source.value;
    return source.coupling.evaluate(posture_.q[static_cast<std::size_t>(source.freeIndex)]).value;
  }

  Skeleton skeleton_;
  Posture posture_;
};

/// Not where it only touches, nor beyond a cylinder's ends.
bool contains(const PathSurface& surface, const Vec3<double>& p_C) {
  const Surface shape = surfaceOf(surface, surface.radius);
  if (std::holds_alternative<CylinderSurface>(shape) && std::abs(p_C.z()) > surface.halfLength) {
    return false;
  }
  return std::visit(
      [&](const auto& each) { return each.value(p_C) < -leastDepth * each.gradient(p_C).norm(); },
      shape);
}

/// The path's points inside one of its wrap objects.
std::vector<std::string> pointsInside(const Model& model, const DefaultPosture& posture,
                                      const Path& path, const PathWrap& wrap) {
  std::vector<std::string> names;
  const WrapObject& object = findWrapObject(model, wrap.wrapObject);
  if (!object.active || sizeOf(object) > largestWrap) return names;
  const PathSurface surface = posture.surfaceOf(object);
  const int numPoints = static_cast<int>(path.points.size());
  const int first = std::max(wrap.firstPoint, 1);
  const int last = wrap.lastPoint < 1 ? numPoints : std::min(wrap.lastPoint, numPoints);
  if (first >= last) return names;
  for (int i = first; i <= last; ++i) {
    const PathPoint& point = path.points[static_cast<std::size_t>(i - 1)];
    if (posture.isActive(point) && contains(surface, posture.seenFrom(surface, point))) {
      names.push_back(point.name);
    }
  }
  return names;
}

}  // namespace

std::vector<Remark> reviewPathPoints(const Model& model) {
  std::vector<Remark> remarks;
  if (DefaultPosture::coordinatesOf(model).empty()) return remarks;
  try {
    const DefaultPosture posture(model);
    for (const Muscle& muscle : model.muscles) {
      if (!muscle.enabled) continue;
      for (const PathWrap& wrap : muscle.path.wraps) {
        for (const std::string& point : pointsInside(model, posture, muscle.path, wrap)) {
          remarks.push_back(
              {fmt::format("muscle '{}'", muscle.name),
               fmt::format(
                   "its point '{}' lies inside its wrap object '{}' in the default posture: "
                   "next to it the path is a straight line through the object, as in OpenSim",
                   point, wrap.wrapObject)});
        }
      }
    }
  } catch (const std::invalid_argument&) {  // a reason of another kind, told where it is simulated
  }
  return remarks;
}

}  // namespace bio
