#include "ensemble/ensemble_draws.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>
#include <stdexcept>

#include "output/resumable_table.h"

namespace app {
namespace {

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

DrawTable::DrawTable(const std::vector<bio::DrawnParameter>& parameters,
                     const std::vector<double>& course, double shown, const std::string& shownUnit)
    : course_(course), shown_(shown), unit_(shownUnit) {
  for (const bio::DrawnParameter& parameter : parameters) {
    parameters_.push_back(parameter.unit.empty()
                              ? parameter.name
                              : fmt::format("{} [{}]", parameter.name, parameter.unit));
  }
}

std::vector<std::string> DrawTable::columns() const {
  std::vector<std::string> names = {"draw", "outcome", "failed_at_s"};
  for (const bio::EnsembleOutput& output : bio::ensembleOutputs())
    names.push_back(columnOf(output));
  names.insert(names.end(), parameters_.begin(), parameters_.end());
  for (const double t : course_) names.push_back(fmt::format("at {:.6g} s", t));
  return names;
}

std::string DrawTable::row(const bio::EnsembleRun& run, const Eigen::VectorXd& theta) const {
  std::string row = run.outcome;
  addNumber(row, run.failedAt);
  for (const bio::EnsembleOutput& output : bio::ensembleOutputs())
    addNumber(row, shown_ * output.of(run));
  for (const double value : theta) addNumber(row, value, "{}");
  for (const double value : run.atCourse) addNumber(row, shown_ * value, "{:.7g}");
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
  for (std::size_t i = 0; i < bio::ensembleOutputs().size(); ++i) row.outputs.push_back(next());
  for (std::size_t i = 0; i < parameters_.size(); ++i) row.parameters.push_back(next());
  std::size_t length = 0;
  for (std::size_t i = 0; i < at; ++i) length += cells[i].size() + 1;
  row.head = text.substr(0, length - 1);
  for (std::size_t i = 0; i < course_.size(); ++i) row.course.push_back(next());
  return row;
}

}  // namespace app
