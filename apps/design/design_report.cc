#include "design/design_report.h"

#include <fmt/format.h>

#include <cmath>

#include "bio/analysis/replay.h"
#include "output/angle_unit.h"
#include "output/json_text.h"
#include "output/text.h"

namespace app {
namespace {

using Json = nlohmann::ordered_json;
using bio::DesignedExperiment;
using Eigen::Index;

double torqueAt(const DesignFindings& f, const DesignedExperiment& e, double t) {
  if (e.torque.empty()) return 0;
  return e.torque.at(t).value[f.design.arm().skeleton().indexOf(f.coordinate.name)];
}

Figure torqueFigure(const DesignFindings& f) {
  Figure figure{.title = "External torque",
                .xLabel = "Time [s]",
                .yLabel = fmt::format("Torque on {} [N·m]", f.coordinate.name),
                .caption = fmt::format("Limited to ±{} N·m and {} N·m/s.",
                                       numberText(f.design.limits().torque),
                                       numberText(f.design.limits().torqueRate))};
  for (const auto& [name, e, style] :
       {std::tuple{"designed", &f.result.after, SeriesStyle::line},
        std::tuple{"before", &f.result.before, SeriesStyle::dashed}}) {
    Series series{.name = name, .x = e->excitation.times(), .style = style};
    for (const double t : series.x) series.y.push_back(torqueAt(f, *e, t));
    figure.series.push_back(std::move(series));
  }
  return figure;
}

Figure excitationFigure(const DesignFindings& f, const bio::MuscleGroup& group) {
  Figure figure{
      .title = fmt::format("Excitation of {}", group.name),
      .xLabel = "Time [s]",
      .yLabel = "Excitation",
      .caption = fmt::format(
          "Muscles with this excitation: {}. The dashed line is the baseline excitation of {}.",
          fmt::join(group.muscles, ", "), group.muscles.front())};
  const bio::Table before = bio::designTable(f.design.arm(), f.result.before, f.coordinate.name);
  const bio::Table after = bio::designTable(f.design.arm(), f.result.after, f.coordinate.name);
  for (const auto& [name, table, style] : {std::tuple{"designed", &after, SeriesStyle::line},
                                           std::tuple{"before", &before, SeriesStyle::dashed}}) {
    const Index column = bio::columnIndex(*table, group.muscles.front());
    figure.series.push_back({.name = name,
                             .x = asList(table->values.col(0)),
                             .y = asList(table->values.col(column)),
                             .style = style});
  }
  return figure;
}

Figure angleFigure(const DesignFindings& f) {
  const bio::DesignLimits& limits = f.design.limits();
  Figure figure{
      .title = fmt::format("Predicted {}", f.coordinate.name),
      .xLabel = "Time [s]",
      .yLabel = fmt::format("{} [deg]", f.coordinate.name),
      .caption = fmt::format("The band shows the designed motion if the parameters are {} prior "
                             "standard deviations off (to first order). Limits: {} to {} deg.",
                             numberText(limits.surprise), numberText(limits.lower * radian),
                             numberText(limits.upper * radian))};
  const DesignedExperiment& after = f.result.after;
  Series designed{
      .name = "designed", .x = asList(after.measuredTimes), .y = asList(after.measured * radian)};
  const Eigen::VectorXd surprise = f.design.surpriseAt(after) * radian;
  designed.bandLow = asList(after.measured * radian - surprise);
  designed.bandHigh = asList(after.measured * radian + surprise);
  figure.series.push_back(std::move(designed));
  figure.series.push_back({.name = "before",
                           .x = asList(f.result.before.measuredTimes),
                           .y = asList(f.result.before.measured * radian),
                           .style = SeriesStyle::dashed});
  return figure;
}

/// How well the first parameter is known after so much of the experiment.
Figure knowledgeFigure(const DesignFindings& f) {
  const bio::ModelParameter& parameter = f.parameters.front();
  Figure figure{.title = fmt::format("Bound on {} over time", parameter.name),
                .xLabel = "Time [s]",
                .yLabel = fmt::format("Bound on {} [{}]", parameter.name, parameter.unit),
                .caption =
                    "Smallest standard deviation of an unbiased estimate from the measurements up "
                    "to that time.",
                .yScale = AxisScale::logarithmic};
  for (const auto& [name, e, style] :
       {std::tuple{"designed", &f.result.after, SeriesStyle::line},
        std::tuple{"before", &f.result.before, SeriesStyle::dashed}}) {
    figure.series.push_back({.name = name,
                             .x = asList(e->measuredTimes),
                             .y = asList(f.design.boundOverTime(*e)),
                             .style = style});
  }
  return figure;
}

Figure searchFigure(const DesignFindings& f) {
  Figure figure{.title = "Progress of the search",
                .xLabel = "Simulations",
                .yLabel = "Criterion (smaller is better)",
                .caption = "Best experiment so far that respects every limit."};
  Series series{.name = "best", .x = {0}, .y = {f.result.costBefore}};
  for (std::size_t i = 0; i < f.result.costs.size(); ++i) {
    series.x.push_back(f.result.foundAt[i]);
    series.y.push_back(f.result.costs[i]);
  }
  figure.series.push_back(std::move(series));
  return figure;
}

Table boundTable(const DesignFindings& f) {
  Table table{
      "Bounds",
      {"parameter", "value", "unit", "prior", "bound before", "bound after", "ratio", "role"},
      {}};
  const auto asked = f.design.question().parameters.size();
  for (std::size_t i = 0; i < f.parameters.size(); ++i) {
    const auto k = static_cast<Index>(i);
    const double prior = f.design.question().priorSd[k];
    const double before = f.result.before.bound[k], after = f.result.after.bound[k];
    table.rows.push_back({f.parameters[i].name, numberText(f.parameters[i].value),
                          f.parameters[i].unit,
                          std::isfinite(prior) ? numberText(prior, 3) : "nothing",
                          numberText(before, 3), numberText(after, 3),
                          numberText(before / after, 3), i < asked ? "of interest" : "nuisance"});
  }
  return table;
}

Table limitTable(const DesignFindings& f) {
  const DesignedExperiment& e = f.result.after;
  const bio::DesignLimits& limits = f.design.limits();
  Table table{"Limits", {"quantity", "designed", "limit", "unit"}, {}};
  if (f.design.hasTorque()) {
    table.rows.push_back(
        {"largest torque", numberText(e.largestTorque), numberText(limits.torque), "N·m"});
    table.rows.push_back({"largest torque rate", numberText(e.largestTorqueRate),
                          numberText(limits.torqueRate), "N·m/s"});
  }
  if (!f.design.groups().empty()) {
    table.rows.push_back({"largest excitation rate", numberText(e.largestExcitationRate),
                          numberText(limits.excitationRate), "1/s"});
  }
  table.rows.push_back(
      {"lowest angle", numberText(e.lowest * radian), numberText(limits.lower * radian), "deg"});
  table.rows.push_back({"lowest angle, parameters off", numberText(e.surprisedLowest * radian),
                        numberText(limits.lower * radian), "deg"});
  table.rows.push_back(
      {"highest angle", numberText(e.highest * radian), numberText(limits.upper * radian), "deg"});
  table.rows.push_back({"highest angle, parameters off", numberText(e.surprisedHighest * radian),
                        numberText(limits.upper * radian), "deg"});
  table.rows.push_back({"largest speed", numberText(e.fastest * radian),
                        numberText(limits.speed * radian), "deg/s"});
  return table;
}

double sdOf(const info::MonteCarloResult& monteCarlo, std::size_t i) {
  const auto k = static_cast<Index>(i);
  return std::sqrt(monteCarlo.covariance(k, k));
}

std::string verdictOf(const DesignFindings& f) {
  const char* stopped =
      f.result.stopped ? "Stopped early; this is the best experiment so far. " : "";
  if (!f.result.improved) {
    return fmt::format(
        "{}No experiment was found that is more informative than {} and respects the limits.",
        stopped, f.trialFile);
  }
  const double before = f.result.before.bound[0], after = f.result.after.bound[0];
  return fmt::format(
      "{}The designed experiment determines {} to ±{} {} instead of ±{} {} (Cramér–Rao bound), {} "
      "times better with the same duration, rate and noise.",
      stopped, f.parameters[0].name, numberText(after, 3), f.parameters[0].unit,
      numberText(before, 3), f.parameters[0].unit, numberText(before / after, 3));
}

}  // namespace

void tellDesign(const DesignFindings& f, Summary& summary) {
  Json before = Json::object(), after = Json::object(), factor = Json::object();
  const auto asked = f.design.question().parameters.size();
  for (std::size_t i = 0; i < asked; ++i) {
    const auto k = static_cast<Index>(i);
    const double b = f.result.before.bound[k], a = f.result.after.bound[k];
    before[f.parameters[i].name] = orNull(b);
    after[f.parameters[i].name] = orNull(a);
    factor[f.parameters[i].name] = orNull(b / a);
  }
  summary.set("improved", f.result.improved);
  summary.set("stopped", f.result.stopped);
  summary.set("bound_before", before);
  summary.set("bound_after", after);
  summary.set("bound_factor", factor);
  if (f.monteCarlo) {
    Json sds = Json::object(), means = Json::object();
    for (std::size_t i = 0; i < asked; ++i) {
      sds[f.parameters[i].name] = orNull(sdOf(*f.monteCarlo, i));
      means[f.parameters[i].name] = orNull(f.monteCarlo->mean[static_cast<Index>(i)]);
    }
    summary.set("monte_carlo_sd", sds);
    summary.set("monte_carlo_mean", means);
    summary.set("monte_carlo_converged", f.monteCarlo->converged);
    summary.set("monte_carlo_trials", f.monteCarlo->trials.size());
  }
  const DesignedExperiment& e = f.result.after;
  summary.set("noise_deg", f.design.question().noise * radian);
  summary.set("rate_Hz", 1 / f.design.question().period);
  if (f.design.hasTorque()) {
    summary.set("largest_torque_Nm", e.largestTorque);
    summary.set("largest_torque_rate_Nm_per_s", e.largestTorqueRate);
  }
  if (!f.design.groups().empty()) {
    summary.set("largest_excitation_rate_per_s", e.largestExcitationRate);
  }
  summary.set("lowest_deg", e.lowest * radian);
  summary.set("highest_deg", e.highest * radian);
  summary.set("largest_speed_deg_per_s", e.fastest * radian);
  summary.set("simulations", f.result.runs);
  summary.set("impossible_simulations", f.result.impossible);
}

Report designReport(const DesignFindings& f) {
  Report report;
  report.title = fmt::format("Experiment designed from {} on {}", f.trialFile, f.modelFile);
  report.verdict = verdictOf(f);
  report.mainFigure = angleFigure(f);
  report.details.push_back(boundTable(f));
  report.details.push_back(Paragraph{fmt::format(
      "A bound is the smallest standard deviation that an unbiased estimate can have (Cramér–Rao), "
      "with one measured angle every {} s, noise of {} deg, and all other parameters of the model "
      "known{}. It holds only if the model is right.",
      numberText(f.design.question().period), numberText(f.design.question().noise * radian),
      f.design.question().nuisance.empty() ? "" : " except the nuisance parameters")});
  if (f.monteCarlo) {
    Table table{"Simulated experiments",
                {"parameter", "truth", "mean estimate", "standard deviation", "bound", "ratio"},
                {}};
    for (std::size_t i = 0; i < f.design.question().parameters.size(); ++i) {
      const auto k = static_cast<Index>(i);
      const double sd = sdOf(*f.monteCarlo, i);
      const double bound = std::sqrt(f.monteCarlo->bound(k, k));
      table.rows.push_back({f.parameters[i].name, numberText(f.parameters[i].value, 6),
                            numberText(f.monteCarlo->mean[k], 6), numberText(sd, 3),
                            numberText(bound, 3), numberText(sd / bound, 3)});
    }
    report.details.push_back(table);
    report.details.push_back(
        Paragraph{fmt::format("{} of {} simulated experiments converged.", f.monteCarlo->converged,
                              f.monteCarlo->trials.size())});
  }
  if (f.design.hasTorque()) report.details.push_back(torqueFigure(f));
  for (const bio::MuscleGroup& group : f.design.groups()) {
    report.details.push_back(excitationFigure(f, group));
  }
  report.details.push_back(knowledgeFigure(f));
  report.details.push_back(limitTable(f));
  report.details.push_back(searchFigure(f));
  report.details.push_back(Paragraph{fmt::format(
      "{} simulations with exact sensitivities, {} of which did not reach the end. design.sto "
      "holds the inputs and the predicted motion; `fisherhill replay` simulates it.",
      f.result.runs, f.result.impossible)});
  return report;
}

}  // namespace app
