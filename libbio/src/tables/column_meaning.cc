#include "tables/column_meaning.h"

#include <algorithm>
#include <utility>

namespace bio {
namespace {

// "/a/b/c" → "c"
std::string lastPart(const std::string& path) {
  return path.substr(path.find_last_of('/') + 1);
}

ColumnMeaning channelOf(const Model& model, const Table& table, const std::string& bare,
                        bool suffix) {
  ColumnMeaning meaning;
  if (!readObservable(bare, model, meaning.what)) return {};
  const bool isAngle = meaning.what.kind == Observable::Kind::pennation ||
                       (meaning.what.kind == Observable::Kind::speed &&
                        findCoordinate(model, meaning.what.object).isRotation);
  if (suffix && !isAngle) return {};
  meaning.kind = ColumnMeaning::Kind::channel;
  meaning.name = bare;
  meaning.inDegrees = isAngle && (suffix || table.inDegrees);
  return meaning;
}

}  // namespace

std::string plainName(const Model& model, const std::string& column) {
  if (!column.starts_with('/')) return column;
  // "/jointset/j1/rz/value" where several joints have an rz
  if (column.starts_with("/jointset/") && column.ends_with("/value")) {
    const std::string full = column.substr(10, column.size() - 16);
    if (coordinateOrNull(model, full)) return full;
  }
  if (column.starts_with("/forceset/") && std::count(column.begin(), column.end(), '/') == 2) {
    return lastPart(column);
  }
  if (column.ends_with("/value")) return lastPart(column.substr(0, column.size() - 6));
  return column;
}

ColumnMeaning meaningOf(const Model& model, const Table& table, const std::string& column) {
  if (column == "time" || column == "time_s") return {ColumnMeaning::Kind::time, column, false};
  const std::string name = plainName(model, column);
  for (const Muscle& muscle : model.muscles) {
    if (muscle.name == name) return {ColumnMeaning::Kind::muscle, name, false};
  }
  for (const bool enabled : {true, false}) {  // one of the same name may be switched off
    for (const CoordinateActuator& actuator : model.actuators) {
      if (actuator.name != name || actuator.enabled != enabled) continue;
      return {ColumnMeaning::Kind::applied, actuator.coordinate, false, &actuator};
    }
  }
  const bool suffix = name.ends_with("_deg");
  const std::string bare = suffix ? name.substr(0, name.size() - 4) : name;
  if (const Coordinate* coordinate = coordinateOrNull(model, name)) {
    return {ColumnMeaning::Kind::coordinate, name, coordinate->isRotation && table.inDegrees,
            nullptr, ofCoordinate(name)};
  }
  for (const auto& [ending, ofRotation] : {std::pair{".torque", true}, {".force", false}}) {
    if (!name.ends_with(ending)) continue;
    const std::string pushed = name.substr(0, name.rfind('.'));
    const Coordinate* coordinate = coordinateOrNull(model, pushed);
    if (coordinate && coordinate->isRotation == ofRotation) {
      return {ColumnMeaning::Kind::applied, pushed, false};
    }
  }
  const Coordinate* coordinate = suffix ? coordinateOrNull(model, bare) : nullptr;
  if (coordinate && coordinate->isRotation)
    return {ColumnMeaning::Kind::coordinate, bare, true, nullptr, ofCoordinate(bare)};
  return channelOf(model, table, bare, suffix);
}

}  // namespace bio
