#include "bio/analysis/muscle_states.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "bio/muscle/fibre_rest.h"
#include "bio/muscle/muscle_parameters.h"
#include "bio/muscle/muscle_variant.h"
#include "bio/muscle/schutte_muscle.h"
#include "bio/tables/file_error.h"
#include "tables/recording_layouts.h"
#include "tables/text_file.h"

namespace bio {
namespace {

using Row = std::map<std::string, double, std::less<>>;

const std::vector<std::string> stateColumns = {"max_isometric_force",
                                               "optimal_fiber_length",
                                               "tendon_slack_length",
                                               "pennation",
                                               "max_contraction_velocity",
                                               "activation",
                                               "fiber_length",
                                               "path_length",
                                               "path_speed"};

/// Columns that such a file has beside them when it comes from OpenSim or from here.
const std::set<std::string, std::less<>> resultColumns = {
    "fiber_velocity",      "tendon_force",  "fiber_force",         "active_fiber_force",
    "passive_fiber_force", "tendon_length", "cos_pennation",       "active_fl",
    "passive_multiplier",  "fv_multiplier", "static_fiber_length", "static_tendon_force"};

/// Sets the property of that name. @return whether the class has one
template <class Parameters>
bool setProperty(Parameters& p, std::string_view name, double value) {
  const std::size_t place = muscles::placeOf<Parameters>(name);
  if (place == Parameters::count) return false;
  Parameters::at(p, place) = value;
  return true;
}

/// The variants of OpenSim's classes that a suffix names.
void applySuffix(muscles::AnyParameters& any, const std::string& suffix) {
  std::map<std::string, double> numbers;
  if (suffix == "_gait") {
    numbers = {{"FmaxTendonStrain", 0.033},
               {"KshapeActive", 0.5},
               {"KshapePassive", 4},
               {"Af", 0.3},
               {"Flen", 1.8}};
  } else if (suffix == "_undamped") {
    numbers = {{"fiber_damping", 0}};
  } else if (suffix == "_mobl") {
    auto* p = std::get_if<muscles::Millard2012Parameters<double>>(&any);
    if (p == nullptr) throw std::invalid_argument("suffix '_mobl' belongs to Millard's class");
    p->minActiveLength = 0.4327;
    p->transitionLength = 0.728;
    p->maxActiveLength = 1.595;
    p->shallowSlope = 0.4613;
    p->minActiveForce = 0;
    p->passiveShapeIsGiven = p->tendonShapeIsGiven = true;
    p->passiveUnitStrain = 0.6405;
    p->passiveLowStiffness = 0.0751;
    p->passiveUnitStiffness = 6.3163;
    p->passiveCurviness = 0.6658;
    p->tendonUnitStrain = 0.033;
    p->tendonUnitStiffness = 37.393;
    p->tendonToeForce = 0.2255;
    p->tendonCurviness = 0.4504;
  } else if (suffix == "_rigid") {
    std::visit([](auto& p) { p.ignoreTendonCompliance = true; }, any);
  } else if (!suffix.empty()) {
    throw std::invalid_argument(
        fmt::format("suffix '{}', must be _gait, _mobl, _rigid or _undamped", suffix));
  }
  for (const auto& [name, value] : numbers) {
    if (!std::visit([&, &n = name, v = value](auto& p) { return setProperty(p, n, v); }, any)) {
      throw std::invalid_argument(fmt::format("suffix '{}': the class has no {}", suffix, name));
    }
  }
}

/// @throws std::invalid_argument if the cell is empty
double fibreLengthIn(const Row& row) {
  const auto found = row.find("fiber_length");
  if (found == row.end())
    throw std::invalid_argument("fiber_length is empty, must be given unless the tendon is rigid");
  return found->second;
}

MuscleState schutteState(const Row& row, const std::map<std::string, double>& properties) {
  if (!properties.empty()) {
    throw std::invalid_argument(
        fmt::format("column '{}': the class has no such property", properties.begin()->first));
  }
  SchutteParameters p;
  p.maxIsometricForce = row.at("max_isometric_force");
  p.optimalFibreLength = row.at("optimal_fiber_length");
  p.tendonSlackLength = row.at("tendon_slack_length");
  p.pennation = row.at("pennation");
  p.tendonForceLength = schutteTendonCurve();
  p.activeForceLength = schutteActiveCurve();
  const SchutteCurves curves(p);
  const SchutteMuscle<double> muscle(schutteQuantities(p), curves);
  const double a = row.at("activation"), L = row.at("path_length");
  const FibreRate<double> rate = muscle.fibreVelocity(a, fibreLengthIn(row), L);
  const StaticEquilibrium rest = staticEquilibrium(muscle, a, L);
  return {{}, rate.fibreVelocity, rate.tendonForce, rest.fibreLength, rest.tendonForce};
}

MuscleState stateOf(const std::string& className, const Row& row,
                    const std::map<std::string, double>& properties) {
  const std::string schutte = "Schutte1993Muscle_Deprecated";
  if (className == schutte) return schutteState(row, properties);
  const std::size_t cut = className.find('_');
  muscles::AnyParameters any = muscles::MuscleClasses::defaultsOf(className.substr(0, cut));
  if (cut != std::string::npos) applySuffix(any, className.substr(cut));
  std::visit(
      [&](auto& p) {
        for (std::size_t i = 0; i < muscles::common::count; ++i)
          p.at(p, i) = row.at(stateColumns[i]);
        for (const auto& [name, value] : properties) {
          if (!setProperty(p, name, value))
            throw std::invalid_argument(
                fmt::format("column '{}': the class has no such property", name));
        }
      },
      any);
  const double a = row.at("activation"), L = row.at("path_length");
  return std::visit(
      [&](const auto& muscle) {
        MuscleState state;
        if (muscle.hasFibreState()) {
          const auto rate = muscle.fibreRate(a, fibreLengthIn(row), L);
          state.fibreVelocity = rate.fibreVelocity;
          state.tendonForce = rate.tendonForce;
        } else {
          const auto rate = muscle.rigidRate(a, L, row.at("path_speed"));
          state.fibreVelocity = rate.fibreVelocity;
          state.tendonForce = rate.tendonForce;
        }
        const muscles::FibreRest rest = muscles::restingFibre(muscle, a, L);
        state.staticFibreLength = rest.fibreLength;
        state.staticTendonForce = rest.tendonForce;
        return state;
      },
      muscles::compile(any));
}

/// One file's columns.
class StateReader {
 public:
  StateReader(const std::filesystem::path& file, const std::string& header) : file_(file.string()) {
    columns_ = cellsOf(header, ',');
    std::set<std::string> seen;
    for (const std::string& name : columns_) {
      if (!seen.insert(name).second) fail(1, fmt::format("column '{}' is given twice", name));
    }
    if (!seen.contains("class")) fail(1, "no column 'class'");
    for (const std::string& name : stateColumns) {
      if (!seen.contains(name) && name != "path_speed")
        fail(1, fmt::format("no column '{}'", name));
    }
  }

  MuscleState read(std::size_t line, const std::string& text) const {
    const std::vector<std::string> cells = cellsOf(text, ',');
    if (cells.size() != columns_.size())
      fail(line, fmt::format("{} cells, must be {}", cells.size(), columns_.size()));
    Row row = {{"path_speed", 0}};
    std::map<std::string, double> properties;
    std::string className;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const std::string& name = columns_[c];
      if (name == "class") {
        className = cells[c];
      } else if (std::find(stateColumns.begin(), stateColumns.end(), name) != stateColumns.end()) {
        const bool mayBeEmpty = name == "fiber_length" || name == "path_speed";
        if (!mayBeEmpty || !cells[c].empty()) row[name] = number(line, name, cells[c]);
      } else if (!resultColumns.contains(name) && !cells[c].empty()) {
        properties[name] = number(line, name, cells[c]);
      }
    }
    try {
      MuscleState state = stateOf(className, row, properties);
      state.className = className;
      return state;
    } catch (const std::invalid_argument& error) {
      fail(line, error.what());
    }
  }

 private:
  [[noreturn]] void fail(std::size_t line, const std::string& message) const {
    throw FileError(fmt::format("{}:{}: {}", file_, line, message));
  }

  double number(std::size_t line, const std::string& column, const std::string& cell) const {
    return finiteNumber(file_, line, column, cell);
  }

  std::string file_;
  std::vector<std::string> columns_;
};

}  // namespace

std::vector<MuscleState> muscleStates(const std::filesystem::path& file) {
  std::vector<MuscleState> states;
  std::optional<StateReader> reader;
  std::istringstream lines(readTextFile(file));
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    if (!reader)
      reader.emplace(file, line);
    else
      states.push_back(reader->read(number, line));
  }
  if (!reader) throw FileError(fmt::format("{}: no header line", file.string()));
  if (states.empty()) throw FileError(fmt::format("{}: no row", file.string()));
  return states;
}

}  // namespace bio
