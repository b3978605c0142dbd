#include "design/design_report.h"

#include <fmt/format.h>

#include <cmath>

#include "design/planned_figures.h"
#include "output/json_text.h"
#include "output/text.h"
#include "playback/playback.h"

namespace app {
namespace {

using Json = nlohmann::ordered_json;
using bio::DesignedExperiment;
using Eigen::Index;

PlannedInputs planned(const DesignFindings& f) {
  return {f.model, f.design.inputs(), f.result.before.trial, f.result.after.trial};
}

/// Figures of what is predicted; a band shows what is observed.
Figure predicted(const DesignFindings& f, std::size_t channel) {
  const bio::MeasuredChannel& after = f.result.after.trial.measured[channel];
  const bio::MeasuredChannel& before = f.result.before.trial.measured[channel];
  const double factor = shownUnit(bio::unitOf(after.what, f.model)).factor;
  Series designed{.name = "designed", .x = asList(after.times), .y = asList(after.values * factor)};
  std::string caption;
  const auto& observed = f.design.question().observed;
  for (std::size_t o = 0; o < observed.size(); ++o) {
    if (observed[o].what != after.what) continue;
    const Eigen::VectorXd allowance =
        f.design.allowanceAt(f.result.after).col(static_cast<Index>(o)) * factor;
    designed.bandLow = asList(after.values * factor - allowance);
    designed.bandHigh = asList(after.values * factor + allowance);
    caption = fmt::format(
        "The band shows the designed experiment if the parameters are {} prior standard deviations "
        "off (to first order).",
        numberText(f.design.inputs().limits().robustness));
  }
  Figure figure = predictionFigure(planned(f), after.what, caption);
  figure.series.push_back(std::move(designed));
  figure.series.push_back({.name = "before",
                           .x = asList(before.times),
                           .y = asList(before.values * factor),
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

Table limitsKept(const DesignFindings& f) {
  Table table = limitTable(planned(f));
  const auto& all = f.design.inputs().limits().coordinates;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::string& name = all[i].coordinate;
    const bio::MotionRange& range = f.result.after.ranges[i];
    const bio::ShownUnit unit = planned(f).unitOf(name);
    addLimit(table, "lowest " + name, range.lowest, all[i].lower, unit);
    addLimit(table, "the same, parameters off", range.surprisedLowest, all[i].lower, unit);
    addLimit(table, "highest " + name, range.highest, all[i].upper, unit);
    addLimit(table, "the same, parameters off", range.surprisedHighest, all[i].upper, unit);
    addLimit(table, "largest speed of " + name, range.fastest, all[i].speed,
             {unit.factor, unit.name + "/s"});
  }
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
  if (!std::isfinite(before)) {
    return fmt::format(
        "{}The designed experiment determines {} to ±{} {} (Cramér–Rao bound), which {} does not "
        "determine at all.",
        stopped, f.parameters[0].name, numberText(after, 3), f.parameters[0].unit, f.trialFile);
  }
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
  const auto& ranges = f.result.after.ranges;
  const std::vector<bio::MotionExtremes> motions(ranges.begin(), ranges.end());
  const bio::DesignQuestion& question = f.design.question();
  tellPlan(planned(f), question.observed, question.period, motions, f.result, summary);
}

std::optional<Playback> designPlayback(const DesignFindings& f,
                                       const std::vector<std::string>& wrapAsCylinder) {
  return playbackOf(
      "The motion in three dimensions",
      {{"design.sto",
        nullptr,
        {{"designed", f.model, f.design.system(), f.result.after.motion},
         {"of the trial given", f.model, f.design.system(), f.result.before.motion}}}},
      wrapAsCylinder);
}

Report designReport(const DesignFindings& f) {
  Report report;
  report.title = fmt::format("Experiment designed from {} on {}", f.trialFile, f.modelFile);
  report.verdict = verdictOf(f);
  const std::size_t channels = f.result.after.trial.measured.size();
  report.mainFigure = predicted(f, 0);
  if (f.playback) report.details.push_back(*f.playback);
  report.details.push_back(
      Section{"What the experiment tells",
              "How accurately each parameter can be known from the trial given and from the "
              "designed experiment; a smaller bound is better."});
  report.details.push_back(boundTable(f));
  report.details.push_back(Paragraph{fmt::format(
      "A bound is the smallest standard deviation that an unbiased estimate can have (Cramér–Rao), "
      "with {}, and all other parameters of the model known{}. It holds only if the model is "
      "right.",
      measurementText(f.design.question().observed, f.design.question().period, f.model),
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
  report.details.push_back(knowledgeFigure(f));
  addFurther(
      channels, [&](std::size_t i) { return predicted(f, i); }, report);
  addInputFigures(planned(f), report);
  addLimits(limitsKept(f), report);
  addSearch(f.result, f.result.costBefore, 1, "Criterion (smaller is better)", report);
  report.details.push_back(Paragraph{fmt::format(
      "{} simulations with exact sensitivities, {} of which did not reach the end. design.sto "
      "holds the inputs and the predicted motion; `fisherhill replay` simulates it.",
      f.result.runs, f.result.impossible)});
  return report;
}

}  // namespace app
