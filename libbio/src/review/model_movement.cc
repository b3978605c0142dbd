#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "bio/review/model_review.h"
#include "simulation/moved_mass.h"

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

/// Coordinates that cannot move together in the default posture, though each can by itself; empty
/// if there are none.
std::string whyNotTogether(const Model& model, const std::vector<std::string>& free) {
  if (free.size() < 2) return "";
  try {
    const Skeleton skeleton(model, {free, {}});
    const std::string never = whatMovesNoMass(skeleton);
    if (!never.empty()) return never;
    const std::string here = whatMovesNoMassAt(skeleton, skeleton.defaultValues());
    return here.empty() ? ""
                        : here +
                              " in the default posture: a motion must start in another, or one "
                              "of them be locked";
  } catch (const std::invalid_argument&) {
    return "";  // a reason of another kind, told where they are freed
  }
}

}  // namespace

std::vector<Remark> reviewModel(const Model& model) {
  std::vector<Remark> remarks = reviewNumbers(model);
  std::vector<std::string> free;
  for (const Joint& joint : model.joints) {
    for (const Coordinate& coordinate : joint.coordinates) {
      if (coordinate.prescribed || !mayBeFree(model, coordinate)) continue;
      const std::string why = whyNotFree(model, coordinate);
      if (why.empty()) {
        free.push_back(coordinate.name);
      } else {
        remarks.push_back({"model", why, Weight::warning});
      }
    }
  }
  const std::string together = whyNotTogether(model, free);
  if (!together.empty()) remarks.push_back({"model", together, Weight::warning});
  for (Remark& inside : reviewPathPoints(model)) remarks.push_back(std::move(inside));
  return remarks;
}

std::string whyNotSimulated(const Model& model) {
  const auto isSimulated = [](const Muscle& muscle) { return muscle.canBeSimulated(); };
  if (!model.muscles.empty() &&
      std::none_of(model.muscles.begin(), model.muscles.end(), isSimulated)) {
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
