#pragma once

#include <map>
#include <string>
#include <vector>

#include "bio/skeleton/articulated_tree.h"

namespace bio {

/// @throws std::invalid_argument unknown coordinate
const CoordinateSource& sourceNamed(const std::map<std::string, CoordinateSource>& sources,
                                    const std::string& coordinate);

/// Adds joints to a tree that is being made, parents before children.
class TreeBuilder {
 public:
  explicit TreeBuilder(ArticulatedTree& tree) : tree_(tree) {}

  /// @throws std::invalid_argument an axis of no length, a body with two joints
  void add(const Joint& joint);
  /// A massless segment that shifts in a body along its x, y and z; returns the segment.
  int addPoint(const BodyPlacement& body, const PointMotion& motion);

 private:
  struct Pending {
    Placement<double> placement;  ///< fixed, since the last turn or shift
    std::vector<ElementaryMotion> motions;
    std::vector<int> coordinates;  ///< of each motion
  };
  /// A turn about, or shift along, an axis by a function of a coordinate, empty: a constant.
  void append(Pending& pending, const std::string& where, bool turns,
              const TransformAxis& axis) const;
  /// A segment moved by pending motions, at least one, against its parent.
  int addSegment(const std::string& name, std::size_t parent, const Pending& pending);

  ArticulatedTree& tree_;
};

}  // namespace bio
