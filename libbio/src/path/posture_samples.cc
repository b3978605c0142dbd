#include "bio/path/posture_samples.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "bio/skeleton/segment_chain.h"

namespace bio {
namespace {

constexpr std::size_t numScattered = 2000;
constexpr std::size_t gridWidths[] = {0, 181, 31, 13};

/// √ of the first primes, one irrational number per coordinate.
std::vector<double> primeRoots(std::size_t count) {
  std::vector<double> roots;
  for (int candidate = 2; roots.size() < count; ++candidate) {
    bool isPrime = true;
    for (int d = 2; d * d <= candidate; ++d) isPrime = isPrime && candidate % d != 0;
    if (isPrime) roots.push_back(std::sqrt(static_cast<double>(candidate)));
  }
  return roots;
}

/// Points of the unit cube: a grid, or scattered.
std::vector<std::vector<double>> unitPoints(std::size_t dimensions) {
  std::vector<std::vector<double>> points;
  if (dimensions < std::size(gridWidths)) {
    points.push_back({});
    for (std::size_t k = 0; k < dimensions; ++k) {
      std::vector<std::vector<double>> finer;
      const std::size_t width = gridWidths[dimensions];
      for (const auto& point : points) {
        for (std::size_t i = 0; i < width; ++i) {
          finer.push_back(point);
          finer.back().push_back(static_cast<double>(i) / static_cast<double>(width - 1));
        }
      }
      points = std::move(finer);
    }
    return points;
  }
  const std::vector<double> roots = primeRoots(dimensions);
  for (std::size_t i = 1; i <= numScattered; ++i) {
    std::vector<double> point;
    for (const double root : roots) {
      const double x = static_cast<double>(i) * root;
      point.push_back(x - std::floor(x));
    }
    points.push_back(std::move(point));
  }
  return points;
}

}  // namespace

Posture postureOf(const Skeleton& skeleton, const std::vector<double>& q) {
  Posture posture{q, std::vector<Placement<double>>(skeleton.numSegments())};
  skeleton.placements(q.data(), posture.placements.data());
  return posture;
}

std::vector<Posture> samplePostures(const Skeleton& skeleton, const std::vector<int>& varying) {
  std::vector<double> reference;
  for (const Coordinate& c : skeleton.coordinates()) reference.push_back(c.defaultValue);
  std::vector<std::vector<double>> all;
  for (const std::vector<double>& point : unitPoints(varying.size())) {
    std::vector<double> q = reference;
    for (std::size_t k = 0; k < varying.size(); ++k) {
      const auto at = static_cast<std::size_t>(varying[k]);
      const Coordinate& c = skeleton.coordinates()[at];
      const double wide = c.isRotation ? std::numbers::pi : 1.0;
      const double lower = std::max(c.rangeMin, c.defaultValue - wide);
      const double upper = std::min(c.rangeMax, c.defaultValue + wide);
      q[at] = lower + (upper - lower) * point[k];
    }
    all.push_back(std::move(q));
  }
  const auto distance = [&](const std::vector<double>& q) {
    double sum = 0;
    for (const int k : varying) {
      const auto at = static_cast<std::size_t>(k);
      sum += (q[at] - reference[at]) * (q[at] - reference[at]);
    }
    return sum;
  };
  std::stable_sort(all.begin(), all.end(),
                   [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
  std::vector<Posture> postures = {postureOf(skeleton, reference)};
  for (const auto& q : all) postures.push_back(postureOf(skeleton, q));
  return postures;
}

std::vector<int> pathSupport(const Model& model, const Skeleton& skeleton, const Muscle& muscle) {
  if (muscle.path.function) return LengthFunction(*muscle.path.function, skeleton).support();
  const ArticulatedTree& tree = *skeleton.tree();
  std::set<int> support, segments;
  const auto follow = [&](const std::string& coordinate) {
    if (coordinate.empty()) return;
    const int index = skeleton.sourceOf(coordinate).freeIndex;
    if (index >= 0) support.insert(index);
  };
  for (const PathPoint& point : muscle.path.points) {
    segments.insert(static_cast<int>(tree.placeOf(point.body).segment));
    if (point.condition) follow(point.condition->coordinate);
    if (!point.motion) continue;
    for (const std::string& coordinate : point.motion->coordinate) follow(coordinate);
  }
  for (const PathWrap& wrap : muscle.path.wraps) {
    const std::string& body = findWrapObject(model, wrap.wrapObject).body;
    segments.insert(static_cast<int>(tree.placeOf(body).segment));
  }
  // two segments of the path move against each other by what is between each and the first
  for (const int segment : segments) {
    const SegmentChain chain(tree, *segments.begin(), segment);
    support.insert(chain.support().begin(), chain.support().end());
  }
  return {support.begin(), support.end()};
}

const std::vector<Posture>& PostureSamples::of(const Muscle& muscle) {
  if (muscle.path.function) return lists_[{-1}];  // no posture is asked for
  const bool few = skeleton_->numCoordinates() <= 4;
  const std::vector<int> varying =
      few ? std::vector<int>{} : pathSupport(*model_, *skeleton_, muscle);
  auto found = lists_.find(varying);
  if (found == lists_.end()) {
    found = lists_
                .emplace(varying,
                         few ? samplePostures(*skeleton_) : samplePostures(*skeleton_, varying))
                .first;
  }
  return found->second;
}

}  // namespace bio
