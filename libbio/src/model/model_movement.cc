#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "bio/model/model_review.h"
#include "skeleton/moved_mass.h"

// What of a review asks whether coordinates can move.

namespace bio {
namespace {

/// Not locked in the model, and of its own.
bool mayBeFree(const Model& model, const Coordinate& coordinate) {
  return !coordinate.locked &&
         std::none_of(model.couplers.begin(), model.couplers.end(),
                      [&](const CoordinateCoupler& c) { return c.dependent == coordinate.name; });
}

/// Why the coordinate cannot be free by itself; empty if it can.
std::string whyNotFree(const Model& model, const Coordinate& coordinate) {
  try {
    return whatMovesNoMass(Skeleton(model, {{coordinate.name}, {}}));
  } catch (const std::invalid_argument& error) {
    return fmt::format("coordinate '{}' cannot be free: {}", coordinate.name, error.what());
  }
}

}  // namespace

std::vector<Remark> reviewModel(const Model& model) {
  std::vector<Remark> remarks = reviewNumbers(model);
  for (const Joint& joint : model.joints) {
    for (const Coordinate& coordinate : joint.coordinates) {
      if (coordinate.prescribed || !mayBeFree(model, coordinate)) continue;
      const std::string why = whyNotFree(model, coordinate);
      if (!why.empty()) remarks.push_back({"model", why, Weight::warning});
    }
  }
  return remarks;
}

std::string whyNotSimulated(const Model& model) {
  if (model.muscles.empty()) return "it has no muscle";
  const auto isSimulated = [](const Muscle& muscle) { return muscle.canBeSimulated(); };
  if (std::none_of(model.muscles.begin(), model.muscles.end(), isSimulated)) {
    return fmt::format("none of its {} muscles is of a class that can be simulated",
                       model.muscles.size());
  }
  for (const Joint& joint : model.joints) {
    for (const Coordinate& coordinate : joint.coordinates) {
      if (mayBeFree(model, coordinate) && whyNotFree(model, coordinate).empty()) return "";
    }
  }
  return "no coordinate that is not locked moves a mass";
}

}  // namespace bio
