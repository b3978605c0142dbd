#include "ensemble/ensemble_draws.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>
#include <stdexcept>

#include "output/resumable_table.h"
#include "sensitivity/sensitivity_report.h"

namespace app {
namespace {

/// "TRI.radius [m]"; without a unit the name alone.
std::string withBrackets(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : fmt::format("{} [{}]", name, unit);
}

ShownChannel shown(const bio::Observable& what, const bio::Model& model) {
  if (what.isCoordinate()) {
    const bio::Coordinate& coordinate = bio::findCoordinate(model, what.object);
    return {coordinate.name, {shownFactor(coordinate), shownUnit(coordinate)}};
  }
  const std::string unit = bio::unitOf(what, model);
  if (!unit.starts_with("rad")) return {nameOf(what), {1, unit}};
  return {nameOf(what), {bio::degreesPerRadian, "deg" + unit.substr(3)}};
}

/// At most nine digits: what other machines' libraries round otherwise is not shown.
void addNumber(std::string& row, double value, const char* format = "{:.9g}") {
  row += ',';
  if (std::isfinite(value)) row += fmt::format(fmt::runtime(format), value);
}

}  // namespace

std::vector<std::string> DrawTable::outputNames() {
  std::vector<std::string> names;
  for (const bio::EnsembleOutput& output : bio::ensembleOutputs()) names.push_back(output.name);
  return names;
}

DrawTable::DrawTable(const bio::TrialEnsemble& ensemble)
    : course_(ensemble.course()),
      startsWithCoordinate_(ensemble.channels().front().what.isCoordinate()) {
  for (const bio::DrawnParameter& parameter : ensemble.laws().parameters) {
    parameters_.push_back(withBrackets(parameter.name, parameter.unit));
  }
  for (const bio::EnsembleChannel& channel : ensemble.channels()) {
    channels_.push_back(shown(channel.what, ensemble.model()));
  }
}

std::string DrawTable::columnOf(const ShownChannel& channel, const std::string& number) const {
  if (isOneCoordinate()) return number + "_" + channel.unit.name;
  return withBrackets(channel.name + "." + number, channel.unit.name);
}

std::vector<std::string> DrawTable::columns() const {
  std::vector<std::string> names = {"draw", "outcome", "failed_at_s"};
  for (const ShownChannel& channel : channels_) {
    for (const bio::EnsembleOutput& output : bio::ensembleOutputs())
      names.push_back(columnOf(channel, output.name));
  }
  names.insert(names.end(), parameters_.begin(), parameters_.end());
  for (const ShownChannel& channel : channels_) {
    for (const double t : course_) names.push_back(fmt::format("{} at {:.6g} s", channel.name, t));
  }
  return names;
}

std::string DrawTable::row(const bio::EnsembleRun& run, const Eigen::VectorXd& theta) const {
  std::string row = run.outcome;
  addNumber(row, run.failedAt);
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    for (const bio::EnsembleOutput& output : bio::ensembleOutputs())
      addNumber(row, channels_[c].unit.factor * output.of(run.channels[c]));
  }
  for (const double value : theta) addNumber(row, value, "{}");
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    for (const double value : run.channels[c].atCourse)
      addNumber(row, channels_[c].unit.factor * value, "{:.7g}");
  }
  return row;
}

DrawTable::Row DrawTable::parse(std::uint64_t number, const std::string& text) const {
  const std::vector<std::string> cells = cellsOf(text);
  std::size_t at = 0;
  Row row{.outcome = cells[at++], .failedAt = 0};
  const auto next = [&] {
    const std::string& cell = cells.at(at++);
    if (cell.empty()) return std::nan("");
    double value = 0;
    const auto [stop, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error != std::errc() || stop != cell.data() + cell.size()) {
      throw std::runtime_error(
          fmt::format("row {} of the unfinished result: '{}' is not a number", number, cell));
    }
    return value;
  };
  row.failedAt = next();
  const std::size_t outputs = channels_.size() * bio::ensembleOutputs().size();
  for (std::size_t i = 0; i < outputs; ++i) row.outputs.push_back(next());
  for (std::size_t i = 0; i < parameters_.size(); ++i) row.parameters.push_back(next());
  std::size_t length = 0;
  for (std::size_t i = 0; i < at; ++i) length += cells[i].size() + 1;
  row.head = text.substr(0, length - 1);
  while (at < cells.size()) row.course.push_back(next());
  return row;
}

}  // namespace app
