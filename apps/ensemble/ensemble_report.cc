#include "ensemble/ensemble_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "output/text.h"

namespace app {
namespace {

using Json = nlohmann::ordered_json;

std::string csvCell(double value) {
  return cellText(value, 9);
}

/// The output of a channel that Sobol's indices are of, in words: "final value of elbow_flexion".
std::string outputWords(const EnsembleFindings& f, std::size_t c) {
  return fmt::format("{} of {}", bio::ensembleOutputs()[bio::ensembleOutputNamed(f.output)].words,
                     f.table.channels()[c].name);
}

/// Its name: "final", or "elbow_flexion.final".
std::string outputOf(const EnsembleFindings& f, std::size_t c) {
  if (f.table.isOneCoordinate()) return f.output;
  return f.table.channels()[c].name + "." + f.output;
}

/// An output of the model's own motion, in the channel's shown unit.
double nominalOf(const EnsembleFindings& f, std::size_t c, const bio::EnsembleOutput& output) {
  return f.table.channels()[c].unit.factor * output.of(f.ensemble.nominal().channels[c]);
}

std::string verdictOf(const EnsembleFindings& f) {
  const auto ok = f.outcomes.find("ok");
  const std::uint64_t finished = ok == f.outcomes.end() ? 0 : ok->second;
  const auto& parameters = f.ensemble.laws().parameters;
  std::string text = fmt::format("{} of {} simulations with {} drawn parameters reached the end.",
                                 finished, f.ensemble.count(), parameters.size());
  for (std::size_t c = 0; c < f.channels.size(); ++c) {
    const ShownChannel& channel = f.table.channels()[c];
    const bio::Spread& last = f.channels[c].outputs[2];
    text += fmt::format(" Median of the final {}: {}; 90 % lie between {} and {}.", channel.name,
                        withUnit(last.p50, channel.unit.name), numberText(last.p5),
                        withUnit(last.p95, channel.unit.name));
  }
  for (std::size_t c = 0; c < f.channels.size(); ++c) {
    const auto& sobol = f.channels[c].sobol;
    Eigen::Index most = 0;
    if (!sobol || !(sobol->indices.total.maxCoeff(&most) > 0)) continue;
    text += fmt::format(
        " {} contributes most to the variance of the {} (total Sobol index "
        "{}).",
        parameters[static_cast<std::size_t>(most)].name, outputWords(f, c),
        numberText(sobol->indices.total[most], 2));
  }
  return text;
}

Figure bandFigure(const EnsembleFindings& f, std::size_t c) {
  const Band& band = f.channels[c].band;
  const auto& [name, unit] = f.table.channels()[c];
  Figure figure{
      .title = fmt::format("{} over the ensemble", name),
      .xLabel = "Time [s]",
      .yLabel = fmt::format("{} [{}]", name, unitText(unit.name)),
      .caption = "Median, and the band from the 5th to the 95th percentile at each time."};
  figure.series.push_back(
      {.name = "median", .x = band.time, .y = band.p50, .bandLow = band.p5, .bandHigh = band.p95});
  figure.series.push_back(
      {.name = "nominal", .x = band.time, .y = band.nominal, .style = SeriesStyle::dashed});
  if (const auto& measured = f.ensemble.channels()[c].measured) {
    figure.series.push_back({.name = "measured",
                             .x = asList(measured->times),
                             .y = asList(measured->values * unit.factor),
                             .style = SeriesStyle::points});
  }
  return figure;
}

Table outputTable(const EnsembleFindings& f, std::size_t c) {
  const auto& [name, unit] = f.table.channels()[c];
  Table table{.title = f.table.isOneCoordinate() ? "" : "Outputs of " + name,
              .columns = {fmt::format("output [{}]", unitText(unit.name)), "nominal", "mean",
                          "standard deviation", "5 %", "median", "95 %"}};
  for (std::size_t i = 0; i < bio::ensembleOutputs().size(); ++i) {
    const bio::EnsembleOutput& output = bio::ensembleOutputs()[i];
    const bio::Spread& s = f.channels[c].outputs[i];
    table.rows.push_back({output.words, numberText(nominalOf(f, c, output)), numberText(s.mean),
                          numberText(s.sd), numberText(s.p5), numberText(s.p50),
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
  for (const bio::DrawnParameter& parameter : f.ensemble.laws().parameters) {
    table.rows.push_back({parameter.name, parameter.unit.empty() ? "1" : parameter.unit,
                          numberText(parameter.value), numberText(parameter.law.mean),
                          numberText(parameter.law.sd), numberText(parameter.law.quantile(0)),
                          numberText(parameter.law.quantile(1))});
  }
  return table;
}

Table sobolTable(const EnsembleFindings& f, std::size_t c) {
  const bio::SobolFinding& s = *f.channels[c].sobol;
  const auto& parameters = f.ensemble.laws().parameters;
  Table table{.title = fmt::format("Sobol's indices of the {}", outputWords(f, c)),
              .columns = {"parameter", "first order", "95 % interval", "total", "95 % interval"}};
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const auto interval = [&](const Eigen::MatrixX2d& of) {
      return fmt::format("{} to {}", numberText(of(at, 0), 3), numberText(of(at, 1), 3));
    };
    table.rows.push_back({parameters[i].name, numberText(s.indices.first[at], 3),
                          interval(s.intervals.first), numberText(s.indices.total[at], 3),
                          interval(s.intervals.total)});
  }
  return table;
}

Json channelJson(const EnsembleFindings& f, std::size_t c) {
  Json json;
  json["unit"] = f.table.channels()[c].unit.name;
  for (std::size_t i = 0; i < bio::ensembleOutputs().size(); ++i) {
    const bio::EnsembleOutput& output = bio::ensembleOutputs()[i];
    const bio::Spread& s = f.channels[c].outputs[i];
    json[output.name] = {{"nominal", nominalOf(f, c, output)},
                         {"mean", s.mean},
                         {"sd", s.sd},
                         {"p5", s.p5},
                         {"p50", s.p50},
                         {"p95", s.p95}};
  }
  if (!f.channels[c].sobol) return json;
  const bio::SobolFinding& s = *f.channels[c].sobol;
  Json indices = Json::array();
  const auto& parameters = f.ensemble.laws().parameters;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    indices.push_back({{"parameter", parameters[i].name},
                       {"first", s.indices.first[at]},
                       {"first_interval", {s.intervals.first(at, 0), s.intervals.first(at, 1)}},
                       {"total", s.indices.total[at]},
                       {"total_interval", {s.intervals.total(at, 0), s.intervals.total(at, 1)}}});
  }
  json["sobol"] = {{"output", f.output},
                   {"base_points", f.basePoints},
                   {"variance", s.indices.variance},
                   {"undefined", s.indices.undefined},
                   {"indices", indices}};
  return json;
}

/// Counts, and keeps for Sobol's indices, what the first pass shows of every row.
class RowCounts {
 public:
  RowCounts(EnsembleFindings& findings, bool decomposed)
      : f_(findings), isDecomposed_(decomposed), output_(bio::ensembleOutputNamed(f_.output)) {
    for (const bio::EnsembleChannel& channel : f_.ensemble.channels()) {
      ranges_.push_back(channel.what.isCoordinate()
                            ? &bio::findCoordinate(f_.ensemble.model(), channel.what.object)
                            : nullptr);
    }
  }

  void add(const DrawTable::Row& row) {
    ++f_.outcomes[row.outcome];
    for (std::size_t c = 0; c < f_.channels.size(); ++c) {
      const double* of = row.outputs.data() + c * bio::ensembleOutputs().size();
      if (isDecomposed_) f_.channels[c].decomposed.push_back(of[output_]);
      const double factor = f_.table.channels()[c].unit.factor;
      if (ranges_[c] != nullptr &&
          bio::leavesRange(*ranges_[c], of[min_] / factor, of[max_] / factor)) {
        ++f_.channels[c].leftRange;
      }
    }
  }

 private:
  EnsembleFindings& f_;
  bool isDecomposed_;
  std::size_t output_;
  std::size_t min_ = bio::ensembleOutputNamed("min"), max_ = bio::ensembleOutputNamed("max");
  std::vector<const bio::Coordinate*> ranges_;  ///< null for what is no coordinate
};

}  // namespace

void collect(EnsembleFindings& f, bool decomposed) {
  const std::vector<double>& time = f.table.course();
  const std::size_t outputs = bio::ensembleOutputs().size();
  f.channels.resize(f.table.channels().size());
  // per channel its outputs, then its course
  const std::size_t each = outputs + time.size();
  info::PassQuantiles columns = bio::spreadColumns(f.channels.size() * each);
  RowCounts counts(f, decomposed);
  bool isFirst = true;
  do {
    for (std::uint64_t number = 0; number < f.ensemble.count(); ++number) {
      const DrawTable::Row row = f.row(number);
      if (isFirst) counts.add(row);
      for (std::size_t c = 0; c < f.channels.size(); ++c) {
        for (std::size_t i = 0; i < outputs; ++i)
          columns.add(c * each + i, row.outputs[c * outputs + i]);
        for (std::size_t i = 0; i < time.size(); ++i)
          columns.add(c * each + outputs + i, row.course[c * time.size() + i]);
      }
    }
    isFirst = false;
  } while (!columns.endPass());
  for (std::size_t c = 0; c < f.channels.size(); ++c) {
    for (std::size_t i = 0; i < outputs; ++i)
      f.channels[c].outputs.push_back(bio::spreadOf(columns, c * each + i));
    Band& band = f.channels[c].band;
    for (std::size_t i = 0; i < time.size(); ++i) {
      const bio::Spread s = bio::spreadOf(columns, c * each + outputs + i);
      band.time.push_back(time[i]);
      band.nominal.push_back(
          f.table.channels()[c].unit.factor *
          f.ensemble.nominal().channels[c].atCourse[static_cast<Eigen::Index>(i)]);
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
  for (std::uint64_t i = 0; i < f.ensemble.count(); ++i) {
    out << i << ',' << f.row(i).head << '\n';
  }
}

void writeBand(const EnsembleFindings& f, std::ostream& out) {
  out << "time";
  for (const ShownChannel& channel : f.table.channels()) {
    for (const char* name : {"nominal", "mean", "p5", "p50", "p95"}) {
      out << ',' << f.table.columnOf(channel, name);
    }
  }
  out << '\n';
  for (std::size_t i = 0; i < f.table.course().size(); ++i) {
    out << fmt::format("{:.9g}", f.table.course()[i]);
    for (const ChannelFindings& channel : f.channels) {
      const Band& band = channel.band;
      for (const auto* column : {&band.nominal, &band.mean, &band.p5, &band.p50, &band.p95}) {
        out << ',' << csvCell((*column)[i]);
      }
    }
    out << '\n';
  }
}

void writeSobol(const EnsembleFindings& f, std::ostream& out) {
  const auto& parameters = f.ensemble.laws().parameters;
  out << "output,parameter,first,first_low,first_high,total,total_low,total_high\n";
  for (std::size_t c = 0; c < f.channels.size(); ++c) {
    const bio::SobolFinding& s = *f.channels[c].sobol;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      out << outputOf(f, c) << ',' << parameters[i].name;
      for (const double x :
           {s.indices.first[at], s.intervals.first(at, 0), s.intervals.first(at, 1),
            s.indices.total[at], s.intervals.total(at, 0), s.intervals.total(at, 1)}) {
        out << ',' << csvCell(x);
      }
      out << '\n';
    }
  }
}

void tellEnsemble(const EnsembleFindings& f, Summary& summary) {
  summary.set("draws", f.ensemble.count());
  Json ended = Json::object();
  for (const auto& [outcome, count] : f.outcomes) ended[outcome] = count;
  summary.set("outcomes", ended);
  Json laws = Json::array();
  for (const bio::DrawnParameter& parameter : f.ensemble.laws().parameters) {
    laws.push_back({{"name", parameter.name},
                    {"unit", parameter.unit},
                    {"mean", parameter.law.mean},
                    {"sd", parameter.law.sd},
                    {"from", parameter.law.quantile(0)},
                    {"to", parameter.law.quantile(1)}});
  }
  summary.set("parameters", laws);
  Json channels = Json::object();
  for (std::size_t c = 0; c < f.channels.size(); ++c) {
    channels[f.table.channels()[c].name] = channelJson(f, c);
  }
  const ShownChannel& first = f.table.channels().front();
  for (const auto& [key, value] : channels[first.name].items()) {
    if (!f.table.startsWithCoordinate() || key == "unit") continue;
    summary.set(key == "sobol" ? key : key + "_" + first.unit.name, value);
  }
  if (!f.table.isOneCoordinate()) summary.set("channels", channels);
}

Report ensembleReport(const EnsembleFindings& f) {
  Report report{.title = fmt::format("{} simulations of {} on {}", f.ensemble.count(), f.trialFile,
                                     f.modelFile),
                .verdict = verdictOf(f),
                .mainFigure = bandFigure(f, 0)};
  const std::size_t channels = f.channels.size();
  if (channels > 1) {
    report.details.push_back(
        Section{"Other channels", "Median and band of everything else that is observed."});
  }
  for (std::size_t c = 1; c < channels; ++c) report.details.push_back(bandFigure(f, c));
  report.details.push_back(
      Section{"Outputs",
              "Numbers of every simulation: nominal is the model with its own parameters, the rest "
              "is how the drawn parameters spread them."});
  for (std::size_t c = 0; c < channels; ++c) report.details.push_back(outputTable(f, c));
  if (f.channels.front().sobol) {
    report.details.push_back(
        Section{"Sensitivity",
                "The share of an output's variance that a parameter causes by itself (first order) "
                "and together with others (total); a total index near 0 means that the parameter "
                "does not matter."});
  }
  for (std::size_t c = 0; c < channels && f.channels[c].sobol; ++c) {
    report.details.push_back(sobolTable(f, c));
  }
  report.details.push_back(
      Section{"Simulations",
              "How the simulations ended, and what their parameters were drawn "
              "from."});
  report.details.push_back(outcomeTable(f));
  report.details.push_back(parameterTable(f));
  return report;
}

}  // namespace app
