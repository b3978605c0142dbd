#include "bio/tables/observable.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

namespace bio {
namespace {

struct Ending {
  const char* text;
  Observable::Kind kind;
};
constexpr std::array<Ending, 2> coordinateEndings = {
    {{".speed", Observable::Kind::speed}, {".moment", Observable::Kind::moment}}};
constexpr std::array<Ending, 4> muscleEndings = {{{".fiber_length", Observable::Kind::fibreLength},
                                                  {".pennation", Observable::Kind::pennation},
                                                  {".tendon_force", Observable::Kind::tendonForce},
                                                  {".activation", Observable::Kind::activation}}};
constexpr std::array<const char*, 3> axisEndings = {".x", ".y", ".z"};

std::string endingOf(Observable::Kind kind) {
  for (const Ending& ending : coordinateEndings)
    if (ending.kind == kind) return ending.text;
  for (const Ending& ending : muscleEndings)
    if (ending.kind == kind) return ending.text;
  return "";
}

/// The name without the ending; empty: it has another one.
std::string before(const std::string& name, const std::string& ending) {
  return name.ends_with(ending) ? name.substr(0, name.size() - ending.size()) : "";
}

}  // namespace

std::string nameOf(const Observable& observable) {
  if (observable.kind == Observable::Kind::marker) {
    return observable.object + axisEndings[static_cast<std::size_t>(observable.axis)];
  }
  return observable.object + endingOf(observable.kind);
}

std::string unitOf(const Observable& observable, const Model& model) {
  using Kind = Observable::Kind;
  const auto turns = [&] { return findCoordinate(model, observable.object).isRotation; };
  switch (observable.kind) {
    case Kind::coordinate:
      return turns() ? "rad" : "m";
    case Kind::speed:
      return turns() ? "rad/s" : "m/s";
    case Kind::moment:
      return turns() ? "N·m" : "N";
    case Kind::marker:
    case Kind::fibreLength:
      return "m";
    case Kind::pennation:
      return "rad";
    case Kind::tendonForce:
      return "N";
    case Kind::activation:
      break;
  }
  return "";
}

bool readObservable(const std::string& column, const Model& model, Observable& found) {
  for (const Ending& ending : coordinateEndings) {
    const std::string name = before(column, ending.text);
    if (name.empty() || !coordinateOrNull(model, name)) continue;
    found = {ending.kind, name, 0};
    return true;
  }
  for (const Ending& ending : muscleEndings) {
    const std::string name = before(column, ending.text);
    const bool isMuscle = std::any_of(model.muscles.begin(), model.muscles.end(),
                                      [&](const Muscle& muscle) { return muscle.name == name; });
    if (!isMuscle) continue;
    found = {ending.kind, name, 0};
    return true;
  }
  for (std::size_t axis = 0; axis < axisEndings.size(); ++axis) {
    const std::string name = before(column, axisEndings[axis]);
    const bool isMarker =
        std::any_of(model.markers.begin(), model.markers.end(),
                    [&](const Marker& marker) { return marker.body + "." + marker.name == name; });
    if (!isMarker) continue;
    found = {Observable::Kind::marker, name, static_cast<int>(axis)};
    return true;
  }
  return false;
}

Observable observableNamed(const std::string& name, const Model& model) {
  Observable found = ofCoordinate(name);
  if (coordinateOrNull(model, name) || readObservable(name, model, found)) return found;
  throw std::invalid_argument(
      fmt::format("observe: '{}' is nothing that can be measured of this model", name));
}

}  // namespace bio
