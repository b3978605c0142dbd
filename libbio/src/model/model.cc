#include "bio/model/model.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace bio {
namespace {

template <class Item>
const Item& findByName(const std::vector<Item>& items, const std::string& name, const char* kind) {
  for (const Item& item : items) {
    if (item.name == name) return item;
  }
  std::string known;
  for (const Item& item : items) known += (known.empty() ? "" : ", ") + item.name;
  throw std::invalid_argument(
      fmt::format("the model has no {} called '{}' (it has: {})", kind, name, known));
}

}  // namespace

const Body& findBody(const Model& model, const std::string& name) {
  return findByName(model.bodies, name, "body");
}

const Coordinate* coordinateOrNull(const Model& model, const std::string& name) {
  for (const Joint& joint : model.joints) {
    for (const Coordinate& coordinate : joint.coordinates) {
      if (coordinate.name == name) return &coordinate;
    }
  }
  return nullptr;
}

const Coordinate& findCoordinate(const Model& model, const std::string& name) {
  if (const Coordinate* found = coordinateOrNull(model, name)) return *found;
  std::string known;
  for (const Joint& joint : model.joints) {
    for (const Coordinate& coordinate : joint.coordinates) {
      known += (known.empty() ? "" : ", ") + coordinate.name;
    }
  }
  throw std::invalid_argument(
      fmt::format("the model has no coordinate called '{}' (it has: {})", name, known));
}

const WrapObject& findWrapObject(const Model& model, const std::string& name) {
  return findByName(model.wrapObjects, name, "wrap object");
}

const Muscle& findMuscle(const Model& model, const std::string& name) {
  return findByName(model.muscles, name, "muscle");
}

std::string simulatedClasses() {
  std::string list = "Schutte1993Muscle_Deprecated";
  for (const std::string_view name : muscles::MuscleClasses::names) {
    list += ", ";
    list += name;
  }
  return list;
}

}  // namespace bio
