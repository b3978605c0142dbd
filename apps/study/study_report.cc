#include "study/study_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <stdexcept>

#include "output/text.h"
#include "study/study_subject.h"

namespace app {
namespace {

double valueOf(const std::vector<std::string>& row, const std::string& column) {
  const std::string& cell = cellOf(row, column);
  return cell.empty() ? std::numeric_limits<double>::quiet_NaN() : numberIn(cell);
}

/// Median over the subjects that have this figure; nothing if none has.
std::optional<double> median(const StudyFindings& f, const std::string& column) {
  std::vector<double> values;
  for (const auto& row : f.rows)
    if (const double value = valueOf(row, column); std::isfinite(value)) values.push_back(value);
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return (values[(n - 1) / 2] + values[n / 2]) / 2;
}

std::string fell(const StudyFindings& f, const char* before, const char* after, const char* what) {
  const auto from = median(f, before), to = median(f, after);
  if (!from || !to) return "";
  return fmt::format(" The median RMS error on {} trials went from {} to {} deg.", what,
                     numberText(*from, 3), numberText(*to, 3));
}

std::string countsInWords(const std::map<std::string, int>& counts) {
  std::vector<std::string> named;
  for (const auto& [name, count] : counts) named.push_back(fmt::format("{} {}", count, name));
  return fmt::format("{}", fmt::join(named, ", "));
}

std::string verdictOf(const StudyFindings& f) {
  std::string text =
      fmt::format("Of {} subjects: {}.", f.rows.size(), countsInWords(countsOf(f, "status")));
  if (!f.study.parameters.empty()) {
    text += fell(f, "rmse_train_before_deg", "rmse_train_deg", "training");
    text += fell(f, "rmse_held_out_before_deg", "rmse_held_out_deg", "held-out");
  }
  if (f.study.discover)
    text += fmt::format(" Verdicts: {}.", countsInWords(countsOf(f, "verdict")));
  return text;
}

Figure errorsFigure(const StudyFindings& f) {
  const bool isHeldOut = median(f, "rmse_held_out_deg").has_value();
  const std::string role = isHeldOut ? "held_out" : "train";
  Figure figure{.title = isHeldOut ? "Held-out error of each subject" : "Error of each subject",
                .xLabel = "Subject, in the order of the table [1]",
                .yLabel = "RMS error [deg]",
                .caption = fmt::format("On {} trials, with the model as given and as calibrated.",
                                       isHeldOut ? "held-out" : "training")};
  for (const auto& [name, column] : {std::pair{"model as given", "rmse_" + role + "_before_deg"},
                                     std::pair{"calibrated", "rmse_" + role + "_deg"}}) {
    Series series{.name = name, .style = SeriesStyle::points};
    for (std::size_t i = 0; i < f.rows.size(); ++i) {
      series.x.push_back(static_cast<double>(i + 1));
      series.y.push_back(valueOf(f.rows[i], column));
    }
    figure.series.push_back(std::move(series));
  }
  return figure;
}

/// Mean and scatter over the subjects, beside how precisely one subject's data tell the value.
Table parametersTable(const StudyFindings& f) {
  Table table{.title = "Estimates over all subjects",
              .columns = {"parameter [unit]", "subjects", "model", "mean", "scatter of subjects",
                          "typical standard deviation of one"}};
  std::vector<std::string> names;
  for (const StudyEstimate& estimate : f.estimates)
    if (std::find(names.begin(), names.end(), estimate.name) == names.end())
      names.push_back(estimate.name);
  for (const std::string& name : names) {
    double sum = 0, squares = 0, nominal = 0, variances = 0;
    int count = 0, known = 0;
    std::string unit;
    for (const StudyEstimate& estimate : f.estimates) {
      if (estimate.name != name) continue;
      sum += estimate.estimate;
      nominal += estimate.nominal;
      unit = estimate.unit;
      ++count;
      if (!(estimate.sd > 0)) continue;
      variances += estimate.sd * estimate.sd;
      ++known;
    }
    const double mean = sum / count;
    for (const StudyEstimate& estimate : f.estimates)
      if (estimate.name == name) squares += (estimate.estimate - mean) * (estimate.estimate - mean);
    table.rows.push_back({unit.empty() ? name : fmt::format("{} [{}]", name, unit),
                          std::to_string(count), numberText(nominal / count), numberText(mean),
                          count > 1 ? numberText(std::sqrt(squares / (count - 1)), 3) : "–",
                          known > 0 ? numberText(std::sqrt(variances / known), 3) : "–"});
  }
  return table;
}

Table subjectsTable(const StudyFindings& f) {
  Table table{.title = "Subjects"};
  const auto& columns = studyColumns();
  std::vector<std::size_t> shown;
  for (std::size_t i = 1; i < columns.size(); ++i) {
    const bool isEmpty = std::all_of(f.rows.begin(), f.rows.end(),
                                     [&](const auto& row) { return row[i - 1].empty(); });
    if (isEmpty) continue;
    shown.push_back(i - 1);
    table.columns.push_back(columns[i]);
  }
  for (const auto& row : f.rows) {
    std::vector<std::string> cells;
    for (const std::size_t i : shown) cells.push_back(row[i]);
    table.rows.push_back(std::move(cells));
  }
  return table;
}

}  // namespace

const std::string& cellOf(const std::vector<std::string>& row, const std::string& column) {
  const auto& columns = studyColumns();
  const auto at = std::find(columns.begin() + 1, columns.end(), column);
  if (at == columns.end()) throw std::logic_error("no column " + column);
  return row.at(static_cast<std::size_t>(at - columns.begin()) - 1);
}

std::map<std::string, int> countsOf(const StudyFindings& findings, const std::string& column) {
  std::map<std::string, int> counts;
  for (const auto& row : findings.rows)
    if (const std::string& cell = cellOf(row, column); !cell.empty()) ++counts[cell];
  return counts;
}

Report studyReport(const StudyFindings& f) {
  const std::string name = std::filesystem::path(f.study.file).filename().string();
  Report report{.title = f.study.title.empty() ? "Study " + name : f.study.title,
                .verdict = verdictOf(f)};
  if (!f.study.parameters.empty()) report.mainFigure = errorsFigure(f);
  report.details.emplace_back(subjectsTable(f));
  if (!f.estimates.empty()) report.details.emplace_back(parametersTable(f));
  if (f.playback) report.details.emplace_back(*f.playback);
  report.details.emplace_back(Paragraph{
      "subjects/NAME/calibrate/report.html and subjects/NAME/discover/report.html explain "
      "each subject's results; estimates.csv has every estimate."});
  return report;
}

}  // namespace app
