#pragma once

#include <map>
#include <vector>

#include "bio/path/compiled_path.h"

namespace bio {

/// The skeleton at q, one value per free coordinate.
Posture postureOf(const Skeleton& skeleton, const std::vector<double>& q);

/// The default posture, then postures in which only the coordinates `varying` differ from it, over
/// their ranges and nearest to the default first: a grid of 181, 31², or 13³ postures, or for more
/// than three coordinates 2000 points of Kronecker's sequence {i √p_k}, p_k prime, which fills
/// every subset of coordinates evenly. Where a range says nothing it is cut to a turn (or 2 m)
/// around the default.
std::vector<Posture> samplePostures(const Skeleton& skeleton, const std::vector<int>& varying);

/// Indices of the free coordinates that move any point, wrap object or condition of a muscle's path
/// against another, rising. The skeleton must have a tree.
std::vector<int> pathSupport(const Model& model, const Skeleton& skeleton, const Muscle& muscle);

/// The postures for compiling the paths of a skeleton, each list made once:
/// samplePostures(skeleton) for up to four coordinates, otherwise those of the coordinates that
/// move a path; none for a path that is a function of coordinates.
class PostureSamples {
 public:
  /// Both must outlive this object.
  PostureSamples(const Model& model, const Skeleton& skeleton)
      : model_(&model), skeleton_(&skeleton) {}

  const std::vector<Posture>& of(const Muscle& muscle);

 private:
  const Model* model_;
  const Skeleton* skeleton_;
  std::map<std::vector<int>, std::vector<Posture>> lists_;
};

}  // namespace bio
