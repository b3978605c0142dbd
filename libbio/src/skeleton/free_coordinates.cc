#include "bio/skeleton/free_coordinates.h"

#include <fmt/format.h>

#include <stdexcept>

#include "bio/skeleton/articulated_tree.h"

namespace bio {

std::vector<std::string> freeByDefault(const Model& model, const std::set<std::string>& locked,
                                       const std::set<std::string>& measured, bool mayBeNone) {
  std::vector<std::string> movable, unlocked;
  for (const std::string& name : independentCoordinates(model)) {
    if (locked.contains(name)) continue;
    movable.push_back(name);
    if (!findCoordinate(model, name).locked) unlocked.push_back(name);
  }
  if (unlocked.size() == 1) return unlocked;
  const auto amongMeasured = [&](const std::vector<std::string>& names) {
    std::vector<std::string> found;
    for (const std::string& name : names)
      if (measured.contains(name)) found.push_back(name);
    return found;
  };
  for (const auto& found : {amongMeasured(unlocked), amongMeasured(movable), unlocked})
    if (!found.empty()) return found;
  if (mayBeNone) return {};
  std::string message = "every coordinate of the model is locked: none can be free";
  for (const std::string& name : locked) message += "; " + name + " is locked by request";
  throw std::invalid_argument(message);
}

std::vector<std::string> prescribedByModel(const Model& model,
                                           const std::set<std::string>& otherwise) {
  std::vector<std::string> names;
  for (const std::string& name : independentCoordinates(model)) {
    const Coordinate& coordinate = findCoordinate(model, name);
    if (!coordinate.isPrescribed() || otherwise.contains(name)) continue;
    if (!coordinate.prescribedFunction) {
      throw std::invalid_argument(
          fmt::format("coordinate '{}': the model prescribes its motion by a function of a class "
                      "that is not known, so it must be prescribed by the trial, locked or free",
                      name));
    }
    names.push_back(name);
  }
  return names;
}

std::map<std::string, double> heldCoordinates(const Model& model,
                                              const std::set<std::string>& freeOrPrescribed,
                                              const std::map<std::string, double>& locks) {
  std::map<std::string, double> held;
  for (const std::string& name : independentCoordinates(model)) {
    if (freeOrPrescribed.contains(name)) continue;
    const auto at = locks.find(name);
    held[name] = at != locks.end() ? at->second : findCoordinate(model, name).defaultValue;
  }
  return held;
}

}  // namespace bio
