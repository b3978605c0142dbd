#pragma once

#include <algorithm>
#include <numbers>
#include <set>
#include <stdexcept>
#include <string>

#include "bio/model/model.h"
#include "bio/skeleton/skeleton.h"

namespace bio {

/// Calls work(skeleton, from, to) for every coordinate that is neither locked nor coupled, free
/// alone, with its range and a margin of `beyond` of it on either side, at most 2π rad or 2 m in
/// all. A range of more is reduced to that width about the default, without margin. Coordinates
/// over which nothing can be simulated are skipped.
template <class Work>
void sweepCoordinates(const Model& model, double beyond, const Work& work) {
  std::set<std::string> dependent;
  for (const auto& constraint : model.couplers) dependent.insert(constraint.dependent);
  for (const Joint& joint : model.joints) {
    for (const Coordinate& c : joint.coordinates) {
      if (c.locked || dependent.count(c.name) > 0) continue;
      const double wide = c.isRotation ? std::numbers::pi : 1.0;
      const bool isOpen = !(c.rangeMax - c.rangeMin <= 2 * wide);
      const double lower = isOpen ? c.defaultValue - wide : c.rangeMin;
      const double upper = isOpen ? c.defaultValue + wide : c.rangeMax;
      const double more =
          isOpen ? 0 : std::min(beyond * (upper - lower), wide - (upper - lower) / 2);
      if (!(upper > lower)) continue;
      try {
        const Skeleton skeleton(model, {.freeCoordinates = {c.name}, .lockedValues = {}});
        work(skeleton, lower - more, upper + more);
      } catch (const std::invalid_argument&) {  // nothing that could be simulated
      }
    }
  }
}

}  // namespace bio
