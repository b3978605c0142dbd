#include "ensemble/ensemble_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "output/text.h"

namespace app {
namespace {

std::string csvCell(double value) {
  return cellText(value, 9);
}

/// Most memory for the motions' courses in a pass over the rows [bytes]; one column at least.
constexpr std::uint64_t mostKept = std::uint64_t{64} << 20;

std::string verdictOf(const EnsembleFindings& f) {
  const auto ok = f.outcomes.find("ok");
  const std::uint64_t finished = ok == f.outcomes.end() ? 0 : ok->second;
  const bio::Spread last = bio::spreadOf(f.outputs[2]);
  std::string text = fmt::format(
      "{} of {} simulations with {} drawn parameters reached the end. Median of the final {}: {} "
      "{}; 90 % lie between {} and {} {}.",
      finished, f.count, f.parameters.size(), f.coordinate, numberText(last.p50), f.table.unit(),
      numberText(last.p5), numberText(last.p95), f.table.unit());
  if (f.sobol && f.sobol->found.indices.variance > 0) {
    Eigen::Index most = 0;
    f.sobol->found.indices.total.maxCoeff(&most);
    text += fmt::format(" {} contributes most to the variance of {} (total Sobol index {}).",
                        f.parameters[static_cast<std::size_t>(most)].name, f.sobol->output,
                        numberText(f.sobol->found.indices.total[most], 2));
  }
  return text;
}

Figure bandFigure(const EnsembleFindings& f) {
  const Band& band = f.band;
  Figure figure{
      .title = fmt::format("{} over the ensemble", f.coordinate),
      .xLabel = "Time [s]",
      .yLabel = fmt::format("{} [{}]", f.coordinate, f.table.unit()),
      .caption = "Median, and the band from the 5th to the 95th percentile at each time."};
  figure.series.push_back(
      {.name = "median", .x = band.time, .y = band.p50, .bandLow = band.p5, .bandHigh = band.p95});
  figure.series.push_back(
      {.name = "nominal", .x = band.time, .y = band.nominal, .style = SeriesStyle::dashed});
  if (f.measured) {
    const Eigen::VectorXd shown = f.measured->values * f.table.shown();
    figure.series.push_back({.name = "measured",
                             .x = {f.measured->times.begin(), f.measured->times.end()},
                             .y = {shown.begin(), shown.end()},
                             .style = SeriesStyle::points});
  }
  return figure;
}

Table outputTable(const EnsembleFindings& f) {
  const std::string& unit = f.table.unit();
  Table table{.title = "Outputs",
              .columns = {fmt::format("output [{}]", unit), "nominal", "mean", "standard deviation",
                          "5 %", "median", "95 %"}};
  for (std::size_t i = 0; i < bio::ensembleOutputs().size(); ++i) {
    const bio::EnsembleOutput& output = bio::ensembleOutputs()[i];
    const bio::Spread s = bio::spreadOf(f.outputs[i]);
    table.rows.push_back({output.words, numberText(f.table.shown() * output.of(f.nominal)),
                          numberText(s.mean), numberText(s.sd), numberText(s.p5), numberText(s.p50),
                          numberText(s.p95)});
  }
  return table;
}

Table outcomeTable(const EnsembleFindings& f) {
  Table table{.title = "Outcomes of the simulations", .columns = {"outcome", "simulations"}};
  for (const auto& [outcome, count] : f.outcomes) {
    table.rows.push_back({outcome, std::to_string(count)});
  }
  return table;
}

Table parameterTable(const EnsembleFindings& f) {
  Table table{
      .title = "Distributions of the parameters",
      .columns = {"parameter", "unit", "model value", "mean", "standard deviation", "from", "to"}};
  for (const bio::DrawnParameter& parameter : f.parameters) {
    table.rows.push_back({parameter.name, parameter.unit.empty() ? "1" : parameter.unit,
                          numberText(parameter.value), numberText(parameter.law.mean),
                          numberText(parameter.law.sd), numberText(parameter.law.quantile(0)),
                          numberText(parameter.law.quantile(1))});
  }
  return table;
}

Table sobolTable(const EnsembleFindings& f) {
  const bio::SobolFinding& s = f.sobol->found;
  Table table{.title = fmt::format("Sobol's indices of {}", f.sobol->output),
              .columns = {"parameter", "first order", "95 % interval", "total", "95 % interval"}};
  for (std::size_t i = 0; i < f.parameters.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const auto interval = [&](const Eigen::MatrixX2d& of) {
      return fmt::format("{} to {}", numberText(of(at, 0), 3), numberText(of(at, 1), 3));
    };
    table.rows.push_back({f.parameters[i].name, numberText(s.indices.first[at], 3),
                          interval(s.intervals.first), numberText(s.indices.total[at], 3),
                          interval(s.intervals.total)});
  }
  return table;
}

}  // namespace

void collect(EnsembleFindings& f) {
  Band& band = f.band;
  band.time = f.table.course();
  f.outputs.assign(bio::ensembleOutputs().size(), {});
  const std::uint64_t each = std::max<std::uint64_t>(f.count, 1) * sizeof(double);
  const std::size_t together = std::max<std::uint64_t>(1, mostKept / each);
  for (std::size_t begin = 0; begin < band.time.size(); begin += together) {
    const std::size_t end = std::min(begin + together, band.time.size());
    std::vector<std::vector<double>> columns(end - begin);
    for (std::uint64_t number = 0; number < f.count; ++number) {
      const DrawTable::Row row = f.row(number);
      if (begin == 0) {
        ++f.outcomes[row.outcome];
        for (std::size_t i = 0; i < f.outputs.size(); ++i) f.outputs[i].push_back(row.outputs[i]);
      }
      for (std::size_t i = begin; i < end; ++i) {
        if (std::isfinite(row.course[i])) columns[i - begin].push_back(row.course[i]);
      }
    }
    for (std::size_t i = begin; i < end; ++i) {
      const bio::Spread s = bio::spreadOf(columns[i - begin]);
      band.nominal.push_back(f.table.shown() * f.nominal.atCourse[static_cast<Eigen::Index>(i)]);
      band.mean.push_back(s.mean);
      band.p5.push_back(s.p5);
      band.p50.push_back(s.p50);
      band.p95.push_back(s.p95);
    }
  }
}

void writeDraws(const EnsembleFindings& f, std::ostream& out) {
  std::vector<std::string> columns = f.table.columns();
  columns.resize(f.table.shortColumns());
  out << fmt::format("{}\n", fmt::join(columns, ","));
  for (std::uint64_t i = 0; i < f.count; ++i) out << i << ',' << f.row(i).head << '\n';
}

void writeBand(const EnsembleFindings& f, std::ostream& out) {
  const Band& band = f.band;
  out << "time";
  for (const char* name : {"nominal", "mean", "p5", "p50", "p95"}) {
    out << fmt::format(",{}_{}", name, f.table.unit());
  }
  out << '\n';
  for (std::size_t i = 0; i < band.time.size(); ++i) {
    out << fmt::format("{:.9g}", band.time[i]);
    for (const auto* column : {&band.nominal, &band.mean, &band.p5, &band.p50, &band.p95}) {
      out << ',' << csvCell((*column)[i]);
    }
    out << '\n';
  }
}

void writeSobol(const EnsembleFindings& f, std::ostream& out) {
  const bio::SobolFinding& s = f.sobol->found;
  out << "output,parameter,first,first_low,first_high,total,total_low,total_high\n";
  for (std::size_t i = 0; i < f.parameters.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    out << f.sobol->output << ',' << f.parameters[i].name;
    for (const double x :
         {s.indices.first[at], s.intervals.first(at, 0), s.intervals.first(at, 1),
          s.indices.total[at], s.intervals.total(at, 0), s.intervals.total(at, 1)}) {
      out << ',' << csvCell(x);
    }
    out << '\n';
  }
}

void tellEnsemble(const EnsembleFindings& f, Summary& summary) {
  summary.set("draws", f.count);
  nlohmann::ordered_json ended = nlohmann::ordered_json::object();
  for (const auto& [outcome, count] : f.outcomes) ended[outcome] = count;
  summary.set("outcomes", ended);
  nlohmann::ordered_json laws = nlohmann::ordered_json::array();
  for (const bio::DrawnParameter& parameter : f.parameters) {
    laws.push_back({{"name", parameter.name},
                    {"unit", parameter.unit},
                    {"mean", parameter.law.mean},
                    {"sd", parameter.law.sd},
                    {"from", parameter.law.quantile(0)},
                    {"to", parameter.law.quantile(1)}});
  }
  summary.set("parameters", laws);
  for (std::size_t i = 0; i < bio::ensembleOutputs().size(); ++i) {
    const bio::EnsembleOutput& output = bio::ensembleOutputs()[i];
    const bio::Spread s = bio::spreadOf(f.outputs[i]);
    summary.set(f.table.columnOf(output), {{"nominal", f.table.shown() * output.of(f.nominal)},
                                           {"mean", s.mean},
                                           {"sd", s.sd},
                                           {"p5", s.p5},
                                           {"p50", s.p50},
                                           {"p95", s.p95}});
  }
  if (!f.sobol) return;
  const bio::SobolFinding& s = f.sobol->found;
  nlohmann::ordered_json indices = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < f.parameters.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    indices.push_back({{"parameter", f.parameters[i].name},
                       {"first", s.indices.first[at]},
                       {"first_interval", {s.intervals.first(at, 0), s.intervals.first(at, 1)}},
                       {"total", s.indices.total[at]},
                       {"total_interval", {s.intervals.total(at, 0), s.intervals.total(at, 1)}}});
  }
  summary.set("sobol", {{"output", f.sobol->output},
                        {"base_points", f.sobol->basePoints},
                        {"variance", s.indices.variance},
                        {"undefined", s.indices.undefined},
                        {"indices", indices}});
}

Report ensembleReport(const EnsembleFindings& f) {
  Report report{
      .title = fmt::format("{} simulations of {} on {}", f.count, f.trialFile, f.modelFile),
      .verdict = verdictOf(f),
      .mainFigure = bandFigure(f)};
  report.details = {outputTable(f), outcomeTable(f)};
  if (f.sobol) report.details.push_back(sobolTable(f));
  report.details.push_back(parameterTable(f));
  return report;
}

}  // namespace app
