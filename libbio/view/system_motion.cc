#include "view/system_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bio/model/units.h"
#include "bio/simulation/simulate.h"
#include "bio/tables/table_file.h"
#include "bio/tables/unknown_column.h"

namespace bio::view {
namespace {

/// Meaning of a column in a model.
enum class Meaning { coordinate, activation, fibreLength, nothingShown, foreign };
enum class Unit { asHeader, degrees, radians };
struct ColumnMeaning {
  Meaning meaning = Meaning::foreign;
  std::string name = {};       ///< of the coordinate or muscle
  Unit unit = Unit::asHeader;  ///< of an angle, by the column's own name
};

std::vector<std::string> partsOf(const std::string& path) {
  std::vector<std::string> parts;
  std::size_t from = path.starts_with("/") ? 1 : 0;
  for (std::size_t slash; (slash = path.find('/', from)) != path.npos; from = slash + 1) {
    parts.push_back(path.substr(from, slash - from));
  }
  parts.push_back(path.substr(from));
  return parts;
}

bool hasMuscle(const Model& model, const std::string& name) {
  return std::any_of(model.muscles.begin(), model.muscles.end(),
                     [&](const Muscle& muscle) { return muscle.name == name; });
}

/// @param joint  empty: any
const Coordinate* coordinateOf(const Model& model, const std::string& joint,
                               const std::string& name) {
  for (const Joint& j : model.joints) {
    if (!joint.empty() && j.name != joint) continue;
    for (const Coordinate& c : j.coordinates) {
      if (c.name == name) return &c;
    }
  }
  return nullptr;
}

/// `state` as OpenSim calls it, also with its unit behind.
ColumnMeaning muscleState(const std::string& muscle, const std::string& state) {
  if (state == "activation") return {Meaning::activation, muscle};
  if (state == "fiber_length" || state == "fiber_length_m") return {Meaning::fibreLength, muscle};
  return {Meaning::nothingShown, muscle};
}

/// Names with slashes: OpenSim 4's /jointset/J/C/value, and J/C/value of OpenSim 3.3.
ColumnMeaning meaningOfPath(const std::string& column, const Model& model) {
  std::vector<std::string> parts = partsOf(column);
  const bool inJoints = parts.front() == "jointset", inForces = parts.front() == "forceset";
  if (inJoints || inForces) parts.erase(parts.begin());
  if (!inForces && parts.size() == 3) {
    const Meaning meaning = parts[2] == "value" ? Meaning::coordinate : Meaning::nothingShown;
    if (coordinateOf(model, parts[0], parts[1])) return {meaning, parts[1]};
    // one of several of its name is called by joint and name
    const std::string full = parts[0] + "/" + parts[1];
    if (coordinateOf(model, parts[0], full)) return {meaning, full};
  }
  if (coordinateOf(model, "", column)) return {Meaning::coordinate, column};
  if (!inJoints && parts.size() == 2 && hasMuscle(model, parts[0])) {
    return muscleState(parts[0], parts[1]);
  }
  return {};
}

ColumnMeaning meaningOf(const std::string& column, const Model& model) {
  if (column == "time" || column == "time_s") return {Meaning::nothingShown};
  if (column.find('/') != column.npos) return meaningOfPath(column, model);
  if (coordinateOf(model, "", column)) return {Meaning::coordinate, column};
  if (hasMuscle(model, column)) return {Meaning::nothingShown, column};
  // OpenSim 3: C_u is a speed, M.activation a state
  const std::pair<std::string, ColumnMeaning> endings[] = {
      {"_deg", {Meaning::coordinate, "", Unit::degrees}},
      {"_rad", {Meaning::coordinate, "", Unit::radians}},
      {"_u", {Meaning::nothingShown}},
      {"_speed", {Meaning::nothingShown}},
      {"_speed_rad_s", {Meaning::nothingShown}}};
  for (const auto& [ending, meaning] : endings) {
    if (!column.ends_with(ending)) continue;
    const std::string name = column.substr(0, column.size() - ending.size());
    if (coordinateOf(model, "", name)) return {meaning.meaning, name, meaning.unit};
  }
  const std::size_t dot = column.rfind('.');
  if (dot != column.npos && hasMuscle(model, column.substr(0, dot))) {
    return muscleState(column.substr(0, dot), column.substr(dot + 1));
  }
  return {};
}

/// Straight lines over the cells that are NaN; empty if all are.
Eigen::VectorXd filled(const Eigen::VectorXd& times, const Eigen::VectorXd& values) {
  std::vector<double> knownTimes, known;
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    if (!std::isfinite(values[k])) continue;
    knownTimes.push_back(times[k]);
    known.push_back(values[k]);
  }
  if (known.empty()) return {};
  if (known.size() == static_cast<std::size_t>(values.size())) return values;
  const auto count = static_cast<Eigen::Index>(known.size());
  const Eigen::VectorXd t = Eigen::Map<Eigen::VectorXd>(knownTimes.data(), count);
  const Eigen::VectorXd v = Eigen::Map<Eigen::VectorXd>(known.data(), count);
  return times.unaryExpr([&](double time) { return valueAt(t, v, time); });
}

}  // namespace

double valueAt(const Eigen::VectorXd& times, const Eigen::VectorXd& values, double time) {
  const auto next = std::upper_bound(times.begin(), times.end(), time);
  if (next == times.begin()) return values[0];
  if (next == times.end()) return values[values.size() - 1];
  const auto k = next - times.begin();
  const double fraction = (time - times[k - 1]) / (times[k] - times[k - 1]);
  return values[k - 1] + fraction * (values[k] - values[k - 1]);
}

SystemMotion readSystemMotion(const std::filesystem::path& file, const Model& model,
                              bool ignoreExtra) {
  const Table table = readTable(file);
  SystemMotion motion;
  motion.time = timesOf(table);
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const std::string& column = table.columns[c];
    const ColumnMeaning meaning = meaningOf(column, model);
    if (meaning.meaning == Meaning::foreign) {
      if (ignoreExtra) continue;
      throw UnknownColumn(
          fmt::format("{}: column '{}' belongs to no coordinate or muscle of the model '{}'",
                      file.string(), column, model.name),
          column);
    }
    if (meaning.meaning == Meaning::nothingShown) continue;
    Eigen::VectorXd values = filled(motion.time, table.values.col(static_cast<Eigen::Index>(c)));
    if (values.size() == 0) continue;
    switch (meaning.meaning) {
      case Meaning::coordinate:
        if (coordinateOf(model, "", meaning.name)->isRotation &&
            (meaning.unit == Unit::degrees ||
             (meaning.unit == Unit::asHeader && table.inDegrees))) {
          values *= radiansPerDegree;
        }
        motion.coordinates[meaning.name] = values;
        break;
      case Meaning::activation:
        motion.activations[meaning.name] = values;
        break;
      default:
        motion.fibreLengths[meaning.name] = values;
    }
  }
  if (motion.coordinates.empty()) {
    throw std::invalid_argument(fmt::format("{}: no column gives a coordinate of the model '{}'",
                                            file.string(), model.name));
  }
  return motion;
}

SkeletonOptions skeletonFor(const Model& model, const std::vector<const SystemMotion*>& motions,
                            SkeletonOptions options) {
  constexpr double still = 1e-9;  // [rad] or [m]
  std::vector<std::string> moving;
  std::map<std::string, double> held;
  for (const Joint& joint : model.joints) {
    for (const Coordinate& coordinate : joint.coordinates) {
      const std::string& name = coordinate.name;
      const bool coupled =
          std::any_of(model.couplers.begin(), model.couplers.end(),
                      [&](const CoordinateCoupler& coupler) { return coupler.dependent == name; });
      if (coupled || options.lockedValues.count(name)) continue;
      bool moves = false;
      for (const SystemMotion* motion : motions) {
        const auto found = motion->coordinates.find(name);
        if (found == motion->coordinates.end()) continue;
        const Eigen::VectorXd& values = found->second;
        held.emplace(name, values[0]);
        moves = moves || values.maxCoeff() - values.minCoeff() > still ||
                std::abs(values[0] - held[name]) > still;
      }
      if (moves) moving.push_back(name);
    }
  }
  if (!moving.empty()) options.freeCoordinates = moving;
  for (const std::string& name : options.freeCoordinates) held.erase(name);
  options.lockedValues.merge(held);
  return options;
}

namespace {

/// Slopes of a course over the 20 ms about each time that it has, for muscles with rigid tendons.
Eigen::RowVectorXd slopes(const Eigen::VectorXd& given, const Eigen::VectorXd& values,
                          const Eigen::VectorXd& times) {
  constexpr double half = 0.01;  // [s]
  const double first = given[0], last = given[given.size() - 1];
  return times
      .unaryExpr([&](double t) {
        const double from = std::max(first, t - half), to = std::min(last, t + half);
        return to > from ? (valueAt(given, values, to) - valueAt(given, values, from)) / (to - from)
                         : 0.0;
      })
      .transpose();
}

}  // namespace

TendonForces tendonForces(const Model& model, const SystemOptions& options,
                          const SystemMotion& motion, const Eigen::VectorXd& times) {
  TendonForces forces;
  if (motion.fibreLengths.empty()) {
    forces.whyNone = "the states give no fibre lengths";
    return forces;
  }
  try {
    const MusculoskeletalSystem system(model, options);
    Trajectory shown;
    shown.time = {times.begin(), times.end()};
    const auto n = static_cast<Eigen::Index>(system.numMuscles());
    shown.q.resize(system.skeleton().numCoordinates(), times.size());
    shown.qDot.setZero(shown.q.rows(), times.size());
    shown.fibreLength.resize(n, times.size());
    shown.activation.setZero(n, times.size());
    const auto sample = [&](const Eigen::VectorXd& values) -> Eigen::RowVectorXd {
      return times.unaryExpr([&](double t) { return valueAt(motion.time, values, t); }).transpose();
    };
    for (Eigen::Index i = 0; i < shown.q.rows(); ++i) {
      const Coordinate& coordinate = system.skeleton().coordinates()[static_cast<std::size_t>(i)];
      const auto found = motion.coordinates.find(coordinate.name);
      if (found == motion.coordinates.end()) {
        shown.q.row(i).setConstant(coordinate.defaultValue);
      } else {
        shown.q.row(i) = sample(found->second);
        shown.qDot.row(i) = slopes(motion.time, found->second, times);
      }
    }
    for (Eigen::Index i = 0; i < n; ++i) {
      const std::string& muscle = system.muscles()[static_cast<std::size_t>(i)].name;
      const auto found = motion.fibreLengths.find(muscle);
      if (found == motion.fibreLengths.end()) {
        forces.whyNone = fmt::format("the states give no fibre length of '{}'", muscle);
        return forces;
      }
      shown.fibreLength.row(i) = sample(found->second);
      if (system.muscles()[static_cast<std::size_t>(i)].muscle.hasFibreState()) continue;
      const auto active = motion.activations.find(muscle);
      if (active == motion.activations.end()) {
        forces.whyNone = fmt::format(
            "the states give no activation of '{}', whose rigid tendon needs it", muscle);
        return forces;
      }
      shown.activation.row(i) = sample(active->second);
    }
    const MuscleReport report = reportMuscles(system, shown);
    for (Eigen::Index i = 0; i < n; ++i) {
      forces.byMuscle[system.muscles()[static_cast<std::size_t>(i)].name] =
          report.tendonForce.row(i).transpose();
    }
  } catch (const std::invalid_argument& error) {
    forces.byMuscle.clear();
    forces.whyNone = error.what();
  }
  return forces;
}

}  // namespace bio::view
