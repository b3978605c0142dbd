#include "bio/skeleton/articulated_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "bio/skeleton/tree_motion.h"
#include "skeleton/tree_builder.h"

namespace bio {
namespace {

std::map<std::string, const CoordinateCoupler*> couplersByDependent(const Model& model) {
  std::map<std::string, const CoordinateCoupler*> couplers;
  for (const CoordinateCoupler& coupler : model.couplers) couplers[coupler.dependent] = &coupler;
  return couplers;
}

std::vector<Coordinate> freeCoordinates(const Model& model, const SkeletonOptions& options) {
  const auto couplers = couplersByDependent(model);
  if (options.freeCoordinates.empty()) {
    throw std::invalid_argument("0 free coordinates, must be 1 or more");
  }
  std::vector<Coordinate> coordinates;
  std::set<std::string> seen;
  for (const std::string& name : options.freeCoordinates) {
    coordinates.push_back(findCoordinate(model, name));
    if (const auto c = couplers.find(name); c != couplers.end()) {
      throw std::invalid_argument(
          fmt::format("coordinate '{}' follows '{}' (coupler '{}') and cannot be free", name,
                      c->second->independent, c->second->name));
    }
    if (options.lockedValues.count(name)) {
      throw std::invalid_argument(fmt::format("coordinate '{}' is free and locked", name));
    }
    if (!seen.insert(name).second) {
      throw std::invalid_argument(fmt::format("coordinate '{}' is named free twice", name));
    }
  }
  for (const auto& [name, value] : options.lockedValues) {
    findCoordinate(model, name);
    if (!std::isfinite(value)) {
      throw std::invalid_argument(
          fmt::format("locked coordinate '{}' = {}, must be finite", name, value));
    }
    if (const auto c = couplers.find(name); c != couplers.end()) {
      throw std::invalid_argument(
          fmt::format("coordinate '{}' follows '{}' (coupler '{}'): lock that one instead", name,
                      c->second->independent, c->second->name));
    }
  }
  return coordinates;
}

/// Free, constant and coupled coordinates, each as a function of a free one or a constant.
std::map<std::string, CoordinateSource> coordinateSources(const Model& model,
                                                          const SkeletonOptions& options) {
  std::map<std::string, CoordinateSource> sources;
  for (const Joint& joint : model.joints) {
    for (const Coordinate& coordinate : joint.coordinates) {
      CoordinateSource source;
      const auto& free = options.freeCoordinates;
      const auto at = std::find(free.begin(), free.end(), coordinate.name);
      const auto locked = options.lockedValues.find(coordinate.name);
      if (at != free.end()) {
        source.freeIndex = static_cast<int>(at - free.begin());
      } else {
        source.value =
            locked != options.lockedValues.end() ? locked->second : coordinate.defaultValue;
      }
      sources[coordinate.name] = source;
    }
  }
  const auto couplers = couplersByDependent(model);
  for (const CoordinateCoupler& coupler : model.couplers) {
    if (couplers.count(coupler.independent)) {
      throw std::invalid_argument(
          fmt::format("coupler '{}': its independent coordinate '{}' is itself coupled",
                      coupler.name, coupler.independent));
    }
    const CoordinateSource& independent = sourceNamed(sources, coupler.independent);
    sourceNamed(sources, coupler.dependent);
    CoordinateSource source;
    source.freeIndex = independent.freeIndex;
    source.coupling = FunctionEvaluator(coupler.function);
    if (source.freeIndex < 0) source.value = source.coupling.evaluate(independent.value).value;
    sources[coupler.dependent] = source;
  }
  return sources;
}

/// Adds mass moments: the mass centre and central inertia of two rigid bodies as one.
void addBody(TreeSegment& segment, const Body& body, const Placement<double>& X_SB) {
  const auto& I = body.inertia;
  Eigen::Matrix3d added;
  added << I[0], I[3], I[4], I[3], I[1], I[5], I[4], I[5], I[2];
  added = (X_SB.R * added * X_SB.R.transpose()).eval();
  const double mass = segment.mass + body.mass;
  if (mass != 0) {
    // the reduced mass of the two, at the distance of their centres
    const Eigen::Vector3d center = X_SB.R * body.massCenter + X_SB.p;
    const Eigen::Vector3d apart = center - segment.massCenter;
    const double reduced = segment.mass * body.mass / mass;
    added +=
        reduced * (apart.squaredNorm() * Eigen::Matrix3d::Identity() - apart * apart.transpose());
    segment.massCenter += apart * (body.mass / mass);
  }
  segment.mass = mass;
  constexpr int row[6] = {0, 1, 2, 0, 0, 1};
  constexpr int column[6] = {0, 1, 2, 1, 2, 2};
  for (int e = 0; e < 6; ++e) segment.inertia[e] += added(row[e], column[e]);
}

}  // namespace

ArticulatedTree::ArticulatedTree(const Model& model, const SkeletonOptions& options)
    : coordinates_(freeCoordinates(model, options)),
      sources_(coordinateSources(model, options)),
      gravity_(model.gravity) {
  segments_.push_back(TreeSegment{"ground"});
  segmentMobility_.push_back(-1);
  places_["ground"] = BodyPlacement{};

  // walk outwards; bodies that do not move against their parent join its segment
  TreeBuilder builder(*this);
  std::vector<const Joint*> waiting;
  for (const Joint& joint : model.joints) waiting.push_back(&joint);
  while (!waiting.empty()) {
    std::vector<const Joint*> later;
    for (const Joint* joint : waiting) {
      if (places_.count(joint->parentBody)) {
        builder.add(*joint);
      } else {
        later.push_back(joint);
      }
    }
    if (later.size() == waiting.size()) {
      throw std::invalid_argument(
          fmt::format("joint '{}': body '{}' is not connected to the ground", later.front()->name,
                      later.front()->parentBody));
    }
    waiting = later;
  }
  numMassSegments_ = static_cast<int>(segments_.size());
  for (const Body& body : model.bodies) {
    const auto place = places_.find(body.name);
    if (place == places_.end()) {
      throw std::invalid_argument(fmt::format("body '{}' has no joint", body.name));
    }
    addBody(segments_[place->second.segment], body, place->second.X_SB);
  }
  for (int i = 0; i < numCoordinates(); ++i) {
    if (std::none_of(mobilities_.begin(), mobilities_.end(),
                     [i](const Mobility& m) { return m.coordinate == i; })) {
      throw std::invalid_argument(fmt::format("coordinate '{}' moves no body",
                                              coordinates_[static_cast<std::size_t>(i)].name));
    }
  }
}

int ArticulatedTree::addMovingPoint(const std::string& body, const PointMotion& motion) {
  const BodyPlacement place = placeOf(body);
  for (const std::string& name : motion.coordinate) {
    if (!name.empty()) sourceOf(name);
  }
  return TreeBuilder(*this).addPoint(place, motion);
}

bool ArticulatedTree::hasConstantInertia() const {
  return numMassSegments_ == 2 && segments_[1].firstMobility == segments_[1].lastMobility &&
         mobilities_.front().hasFixedScrew && motions_.front().isIdentity;
}

const BodyPlacement& ArticulatedTree::placeOf(const std::string& body) const {
  const auto place = places_.find(body);
  if (place == places_.end()) {
    throw std::invalid_argument(fmt::format("the model has no body called '{}'", body));
  }
  return place->second;
}

Eigen::VectorXd ArticulatedTree::defaultValues() const {
  Eigen::VectorXd q(numCoordinates());
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    q[i] = coordinates_[static_cast<std::size_t>(i)].defaultValue;
  }
  return q;
}

int ArticulatedTree::indexOf(const std::string& coordinate) const {
  for (std::size_t i = 0; i < coordinates_.size(); ++i) {
    if (coordinates_[i].name == coordinate) return static_cast<int>(i);
  }
  return -1;
}

const CoordinateSource& ArticulatedTree::sourceOf(const std::string& coordinate) const {
  return sourceNamed(sources_, coordinate);
}

std::vector<std::string> independentCoordinates(const Model& model) {
  const auto couplers = couplersByDependent(model);
  std::vector<std::string> names;
  for (const Joint& joint : model.joints) {
    for (const Coordinate& c : joint.coordinates) {
      if (!couplers.count(c.name)) names.push_back(c.name);
    }
  }
  return names;
}

template TreeMotion<double> ArticulatedTree::newMotion<double>() const;
template void ArticulatedTree::place<double>(const double*, TreeMotion<double>&) const;

}  // namespace bio
