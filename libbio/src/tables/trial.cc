#include "bio/tables/trial.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <map>

#include "bio/model/nearest_name.h"
#include "bio/model/units.h"
#include "bio/tables/file_error.h"
#include "bio/tables/trial_table.h"
#include "bio/tables/unknown_column.h"
#include "info/dynamics/linear_table.h"
#include "model/listed_names.h"
#include "tables/column_meaning.h"

namespace bio {
namespace {

class TrialReader {
 public:
  TrialReader(Table table, const std::string& name, const Model& model, const TrialOptions& options)
      : file_(name), model_(model), options_(options), table_(std::move(table)) {}

  Trial read() {
    trial_.file = file_;
    trial_.times = timesOf(table_);
    if (const Eigen::Index rows = trial_.times.size(); rows < 2) {
      fail(fmt::format("holds {} row{}, must hold at least 2", rows, rows == 1 ? "" : "s"));
    }
    for (Eigen::Index row = 0; row < trial_.times.size(); ++row) {
      const double before = row == 0 ? -HUGE_VAL : trial_.times[row - 1];
      if (!(trial_.times[row] > before && std::isfinite(trial_.times[row]))) {
        fail(fmt::format("time = {} s in row {}, must be finite and rise", trial_.times[row], row));
      }
    }
    readHeader();
    readExperimentalConditions();
    sortColumns();
    takePrescribed();
    remarkIdleActuators();
    readExcitations();
    return std::move(trial_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw FileError(fmt::format("{}: {}", file_, message));
  }
  [[noreturn]] void fail(Eigen::Index column, Eigen::Index row, const std::string& message) const {
    fail(fmt::format("column '{}' at time = {} s: {}",
                     table_.columns[static_cast<std::size_t>(column)], trial_.times(row), message));
  }

  std::vector<std::string> names() const {
    std::vector<std::string> names = {"time"};
    for (const Muscle& muscle : model_.muscles) names.push_back(muscle.name);
    for (const Joint& joint : model_.joints)
      for (const Coordinate& coordinate : joint.coordinates) names.push_back(coordinate.name);
    return names;
  }

  // A line of the header that was meant to say something and does not.
  void readHeader() {
    std::vector<std::string> meant = knownLines();
    for (const auto& [key, value] : table_.metadata) {
      if (std::find(meant.begin(), meant.end(), key) != meant.end()) continue;
      std::string low = key;
      for (char& c : low) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      if (low.starts_with("known_")) {
        fail(fmt::format("header: '{}' is unknown, must be {}{}", key,
                         fmt::join(knownLines(), " or "), meantInstead(key, knownLines())));
      }
    }
    const auto latent = table_.metadata.find("latent_excitation");
    if (latent != table_.metadata.end()) readLatent(latent->second);
    meant.insert(meant.end(), {"inDegrees", "latent_excitation"});
    for (const auto& [key, value] : table_.metadata) {
      const std::string nearest = nearestName(key, meant);
      if (nearest.empty() || nearest == key) continue;
      trial_.warnings.push_back(
          fmt::format("{}: header: '{}' is unknown, did you mean '{}'?", file_, key, nearest));
    }
  }

  void readLatent(const std::string& text) {
    try {
      trial_.latent = latentInHeader(text);
    } catch (const std::invalid_argument& error) {
      fail(fmt::format("header: {}", error.what()));
    }
    for (const LatentDeclaration& declaration : trial_.latent) {
      const bool isKnown =
          std::any_of(model_.muscles.begin(), model_.muscles.end(),
                      [&](const Muscle& m) { return m.name == declaration.muscle; });
      if (isKnown) continue;
      fail(fmt::format("header: latent_excitation: the model has no muscle '{}'{}",
                       declaration.muscle, meantInstead(declaration.muscle, names())));
    }
  }

  void readExperimentalConditions() {
    try {
      trial_.conditions = experimentalConditionsIn(table_.metadata);
    } catch (const std::invalid_argument& error) {
      fail(error.what());
    }
    if (trial_.conditions.any() && !options_.experimentalConditions) {
      fail(fmt::format("recorded {} (header), which only 'discover' and 'replay' take into account",
                       inWords(trial_.conditions)));
    }
  }

  void sortColumns() {
    std::map<std::string, std::string> seen;  // meaning → column
    std::vector<MeasuredChannel> others;      // than coordinates
    for (std::size_t i = 0; i < table_.columns.size(); ++i) {
      const std::string& column = table_.columns[i];
      const ColumnMeaning meaning = meaningOf(model_, table_, column);
      if (meaning.kind == ColumnMeaning::Kind::extra) {
        if (!options_.ignoreExtra) {
          throw UnknownColumn(
              fmt::format("{}: column '{}' is neither a muscle nor a coordinate of the model, nor "
                          "a torque on one, nor anything else that can be measured, and such "
                          "columns are not ignored{}",
                          file_, column, meantInstead(column, names())),
              column);
        }
        trial_.warnings.push_back(fmt::format("{}: column '{}' is ignored", file_, column));
        continue;
      }
      if (meaning.kind == ColumnMeaning::Kind::time) continue;
      const bool isApplied = meaning.kind == ColumnMeaning::Kind::applied;
      const auto [found, isNew] = seen.emplace(
          (isApplied ? "." : "") + (meaning.actuator ? plainName(model_, column) : meaning.name),
          column);
      if (!isNew) {
        fail(fmt::format("columns '{}' and '{}' both give '{}', must be one", found->second, column,
                         meaning.name));
      }
      if (meaning.kind == ColumnMeaning::Kind::muscle) {
        columnOf_[meaning.name] = static_cast<Eigen::Index>(i);
      } else if (isApplied) {
        readApplied(static_cast<Eigen::Index>(i), meaning);
      } else if (meaning.kind == ColumnMeaning::Kind::channel) {
        others.push_back(readCourse(static_cast<Eigen::Index>(i), meaning));
      } else {
        trial_.measured.push_back(readCourse(static_cast<Eigen::Index>(i), meaning));
      }
    }
    std::move(others.begin(), others.end(), std::back_inserter(trial_.measured));
  }

  MeasuredChannel readCourse(Eigen::Index column, const ColumnMeaning& meaning) {
    const double unit = meaning.inDegrees ? radiansPerDegree : 1.0;
    std::vector<double> times, values;
    for (Eigen::Index row = 0; row < table_.values.rows(); ++row) {
      const double value = table_.values(row, column);
      if (std::isnan(value)) continue;
      times.push_back(trial_.times(row));
      values.push_back(value * unit);
    }
    if (times.empty()) {
      fail(fmt::format("column '{}' has no value, must have one or be left out",
                       table_.columns[static_cast<std::size_t>(column)]));
    }
    const auto count = static_cast<Eigen::Index>(times.size());
    const bool isCoordinate = meaning.kind == ColumnMeaning::Kind::coordinate;
    return {isCoordinate ? ofCoordinate(meaning.name) : meaning.what,
            Eigen::Map<Eigen::VectorXd>(times.data(), count),
            Eigen::Map<Eigen::VectorXd>(values.data(), count)};
  }

  // The measurement of a coordinate.
  std::vector<MeasuredChannel>::iterator find(const std::string& coordinate) {
    return std::find_if(
        trial_.measured.begin(), trial_.measured.end(),
        [&](const MeasuredChannel& channel) { return channel.what == ofCoordinate(coordinate); });
  }

  // A held coordinate may be measured, where it is held. A joint that a dynamometer holds gives way
  // by 0.3 to 0.7° (the recordings of validation/ankle), and a lock is typed to the degree.
  void dropHeld(const std::string& name, double value) {
    const auto at = find(name);
    if (at == trial_.measured.end()) return;
    const ShownUnit unit = positionUnit(findCoordinate(model_, name).isRotation);
    const double away = (at->values.array() - value).abs().maxCoeff();
    if (!(away < 2 / unit.factor)) {
      fail(
          fmt::format("column '{0}' is up to {1:.3g} {2} away from {3:.4g} {2}, at which '{0}' is "
                      "locked, must be within 2 {2}: --prescribe {0} takes its motion from the "
                      "column",
                      name, away * unit.factor, unit.name, value * unit.factor));
    }
    trial_.measured.erase(at);
  }

  // Prescribed coordinates are an input, not a measurement to compare with.
  void takePrescribed() {
    for (const std::string& name : options_.prescribed) {
      const auto at = find(name);
      if (at == trial_.measured.end()) {
        fail(
            fmt::format("has no column '{}', must have one: the motion of this coordinate is "
                        "prescribed",
                        name));
      }
      const double first = at->times[0], last = at->times[at->times.size() - 1];
      if (first > trial_.times[0] || last < trial_.times[trial_.times.size() - 1]) {
        fail(
            fmt::format("column '{}' has values from {:.6g} s to {:.6g} s, must have them from the "
                        "first row to the last: the motion of this coordinate is prescribed",
                        name, first, last));
      }
      trial_.prescribed.push_back(std::move(*at));
      trial_.measured.erase(at);
    }
    for (const auto& [name, value] : options_.held) {
      dropHeld(name, value);
      trial_.prescribed.push_back({ofCoordinate(name),
                                   Eigen::VectorXd::Constant(1, trial_.times[0]),
                                   Eigen::VectorXd::Constant(1, value)});
    }
  }

  void readApplied(Eigen::Index column, const ColumnMeaning& meaning) {
    Eigen::VectorXd values = table_.values.col(column);
    for (Eigen::Index row = 0; row < values.size(); ++row) {
      if (!std::isfinite(values[row])) fail(column, row, "is missing, must be given in every row");
    }
    if (!meaning.actuator) {
      trial_.applied.push_back({meaning.name, std::move(values)});
      return;
    }
    const double optimal = meaning.actuator->enabled ? meaning.actuator->optimalForce : 0;
    trial_.applied.push_back(
        {meaning.name, optimal * values, meaning.actuator->name, values, optimal});
  }

  // One line for all that no column controls.
  void remarkIdleActuators() {
    std::vector<std::string> idle;
    for (const CoordinateActuator& actuator : model_.actuators) {
      const bool isDriven =
          std::any_of(trial_.applied.begin(), trial_.applied.end(),
                      [&](const AppliedForce& force) { return force.actuator == actuator.name; });
      if (actuator.enabled && !isDriven) idle.push_back(actuator.name);
    }
    if (idle.empty()) return;
    trial_.warnings.push_back(
        fmt::format("{}: no column controls the CoordinateActuator{} {}: {} exert{} nothing", file_,
                    idle.size() > 1 ? "s" : "", fmt::join(idle, ", "),
                    idle.size() > 1 ? "they" : "it", idle.size() > 1 ? "" : "s"));
  }

  // One line for all muscles that no column drives.
  void warnWithoutColumn(const std::vector<std::string>& muscles) {
    if (muscles.size() == 1) {
      trial_.warnings.push_back(fmt::format("{}: muscle '{}' has no column, its excitation is {}",
                                            file_, muscles.front(), options_.baseline));
    } else if (!muscles.empty()) {
      trial_.warnings.push_back(fmt::format(
          "{}: {} of {} muscles have no column, their excitation is {}: {}", file_, muscles.size(),
          trial_.muscles.size(), options_.baseline, listedNames(muscles)));
    }
  }

  void readExcitations() {
    for (const Muscle& muscle : model_.muscles) {
      if (muscle.enabled) trial_.muscles.push_back(muscle.name);
    }
    for (const Muscle& muscle : model_.muscles) {
      if (!muscle.enabled && columnOf_.count(muscle.name)) trial_.muscles.push_back(muscle.name);
    }
    trial_.excitations.resize(table_.values.rows(),
                              static_cast<Eigen::Index>(trial_.muscles.size()));
    std::vector<std::string> withoutColumn;
    for (std::size_t m = 0; m < trial_.muscles.size(); ++m) {
      const auto target = static_cast<Eigen::Index>(m);
      const auto found = columnOf_.find(trial_.muscles[m]);
      if (found == columnOf_.end()) {
        trial_.excitations.col(target).setConstant(options_.baseline);
        withoutColumn.push_back(trial_.muscles[m]);
        continue;
      }
      for (Eigen::Index row = 0; row < table_.values.rows(); ++row) {
        const double value = table_.values(row, found->second);
        if (std::isnan(value)) fail(found->second, row, "excitation is missing, must be given");
        if (!(value >= 0 && value <= 1)) {
          fail(found->second, row, fmt::format("excitation = {}, must be 0 to 1", value));
        }
        trial_.excitations(row, target) = value;
      }
    }
    warnWithoutColumn(withoutColumn);
    if (columnOf_.empty() && !model_.muscles.empty())
      fail("drives no muscle of the model, must have a column for one");
  }

  std::string file_;
  const Model& model_;
  TrialOptions options_;
  Table table_;
  Trial trial_;
  std::map<std::string, Eigen::Index> columnOf_;  // by muscle
};

}  // namespace

Trial readTrial(const std::filesystem::path& file, const Model& model,
                const TrialOptions& options) {
  return trialFrom(readTable(file), file.string(), model, options);
}

Trial trialFrom(const Table& table, const std::string& name, const Model& model,
                const TrialOptions& options) {
  if (!(options.baseline >= 0 && options.baseline <= 1)) {
    throw std::domain_error(fmt::format("baseline = {}, must be 0 to 1", options.baseline));
  }
  return TrialReader(table, name, model, options).read();
}

const MeasuredChannel* Trial::measurementOf(const Observable& what) const {
  const auto at =
      std::find_if(measured.begin(), measured.end(),
                   [&](const MeasuredChannel& channel) { return channel.what == what; });
  return at == measured.end() ? nullptr : &*at;
}

double excitationAt(const Trial& trial, Eigen::Index muscle, double t) {
  return info::linearAt(trial.times, t).value(trial.excitations.col(muscle));
}

}  // namespace bio
