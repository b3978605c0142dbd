#include "sensitivity/sensitivity_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bio/model/units.h"
#include "options/excitation_figure.h"
#include "output/json_text.h"
#include "output/text.h"

namespace app {
namespace {

/// Prior deviation over the joint bound: how much narrower the data make what is known.
Eigen::VectorXd informationGain(const bio::ParameterInformation& information) {
  Eigen::VectorXd gain(information.boundAlone.size());
  for (Eigen::Index i = 0; i < gain.size(); ++i) {
    gain[i] =
        information.parameters[static_cast<std::size_t>(i)].prior->sd / information.boundJoint[i];
  }
  return gain;
}

std::vector<double> scaled(const Eigen::VectorXd& values, double factor) {
  const Eigen::VectorXd result = values * factor;
  return {result.begin(), result.end()};
}

Figure sweepFigure(const SensitivityFindings& f, const bio::Sweep& sweep) {
  const double factor = shownFactor(f.coordinate);
  const std::string& unit = sweep.parameter.unit;
  Figure figure{.title = fmt::format("{} for {} values of {}", f.coordinate.name, sweep.runs.size(),
                                     sweep.parameter.name),
                .xLabel = "Time [s]",
                .yLabel = fmt::format("{} [{}]", f.coordinate.name, shownUnit(f.coordinate)),
                .caption = fmt::format("The model's own value is {}.",
                                       withUnit(sweep.parameter.value, unit))};
  const auto add = [&](const std::string& name, const bio::Trajectory& motion, SeriesStyle style) {
    figure.series.push_back({.name = name,
                             .x = motion.time,
                             .y = scaled(motion.q.row(0).transpose(), factor),
                             .style = style});
  };
  add("model", sweep.nominal, SeriesStyle::dashed);
  for (const bio::SweepRun& run : sweep.runs) {
    if (figure.series.size() < 7) add(withUnit(run.value, unit), run.motion, SeriesStyle::line);
  }
  for (const bio::MeasuredChannel& measured : f.trial.measured) {
    if (measured.what != bio::ofCoordinate(f.coordinate.name)) continue;
    figure.series.push_back({.name = "measured",
                             .x = {measured.times.begin(), measured.times.end()},
                             .y = scaled(measured.values, factor),
                             .style = SeriesStyle::points});
  }
  return figure;
}

Table sweepTable(const SensitivityFindings& f, const bio::Sweep& sweep) {
  const std::string unit = shownUnit(f.coordinate);
  Table table{.title = "Change in the motion",
              .columns = {fmt::format("{} [{}]", sweep.parameter.name,
                                      sweep.parameter.unit.empty() ? "1" : sweep.parameter.unit),
                          fmt::format("rms [{}]", unit), fmt::format("largest [{}]", unit)}};
  for (const bio::SweepRun& run : sweep.runs) {
    const bool done = run.motion.outcome == bio::Outcome::completed;
    table.rows.push_back(
        {numberText(run.value), numberText(run.rms * shownFactor(f.coordinate)),
         done ? numberText(run.largest * shownFactor(f.coordinate)) : run.motion.why});
  }
  return table;
}

/// The most influential parameters, how far each moves the motion over time.
Figure courseFigure(const SensitivityFindings& f) {
  const bio::ParameterInformation& information = *f.information;
  const double factor = shownFactor(f.coordinate);
  Figure figure{
      .title = "Parameters with the most influence on the motion",
      .xLabel = "Time [s]",
      .yLabel = fmt::format("Change in {} [{}]", f.coordinate.name, shownUnit(f.coordinate)),
      .caption =
          "Each curve: change in the motion, to first order, per prior standard deviation of the "
          "parameter."};
  for (const std::size_t i : ranking(information.normalisedSensitivity)) {
    if (figure.series.size() == 8) break;
    const auto column = static_cast<Eigen::Index>(i);
    const double sd = information.parameters[i].prior->sd;
    figure.series.push_back({.name = information.parameters[i].name,
                             .x = f.local->motion.time,
                             .y = scaled(f.local->q[0].col(column), factor * sd)});
  }
  return figure;
}

Table rankingTable(const SensitivityFindings& f, const std::string& title,
                   const Eigen::VectorXd& score, std::size_t most) {
  const bio::ParameterInformation& information = *f.information;
  const std::string unit = f.shownUnit();
  Table table{.title = title,
              .columns = {"parameter", "value",
                          fmt::format("influence on the {} [{}]",
                                      f.observed.empty() ? "motion" : "measurement", unit),
                          "prior ±", "bound alone ±", "bound jointly ±", "identifiable"}};
  for (const std::size_t i : ranking(score)) {
    if (table.rows.size() == most) break;
    const auto k = static_cast<Eigen::Index>(i);
    const info::Parameter& p = information.parameters[i];
    table.rows.push_back({p.name, withUnit(p.start, p.unit),
                          numberText(information.normalisedSensitivity[k] * f.shownFactor(), 3),
                          numberText(p.prior->sd, 3), numberText(information.boundAlone[k], 3),
                          numberText(information.boundJoint[k], 3),
                          information.identifiable[i] ? "yes" : "no"});
  }
  return table;
}

Figure profileFigure(const bio::ProfileFinding& finding) {
  Figure figure{.title = fmt::format("Profile likelihood of {}", finding.parameter.name),
                .xLabel = info::label(finding.parameter),
                .yLabel = "Smallest cost [nats]",
                .caption =
                    "For data equal to the model's own motion, with the given noise and priors. "
                    "The 95 % confidence interval is where the curve is below the dashed line."};
  Series curve{.name = "profile"}, line{.name = "95 %", .style = SeriesStyle::dashed};
  for (const info::ProfilePoint& point : finding.profile.points) {
    curve.x.push_back(point.value);
    curve.y.push_back(point.cost);
    line.x.push_back(point.value);
    line.y.push_back(finding.profile.threshold);
  }
  figure.series = {curve, line};
  return figure;
}

Table globalTable(const SensitivityFindings& f) {
  const std::string unit = shownUnit(f.coordinate);
  Table table{.title = "Global sensitivity over the prior range", .columns = {"parameter"}};
  if (f.global.morris) {
    table.columns.push_back(fmt::format("Morris μ* [{}]", unit));
    table.columns.push_back(fmt::format("Morris σ [{}]", unit));
  }
  if (f.global.sobol) {
    table.columns.push_back("Sobol first order");
    table.columns.push_back("Sobol total");
  }
  table.columns.push_back(fmt::format("local [{}]", unit));
  const Eigen::VectorXd& score =
      f.global.sobol ? f.global.sobol->total : f.global.morris->meanAbsolute;
  for (const std::size_t i : ranking(score)) {
    const auto k = static_cast<Eigen::Index>(i);
    std::vector<std::string> row = {f.parameters[i]};
    if (f.global.morris) {
      row.push_back(numberText(f.global.morris->meanAbsolute[k], 3));
      row.push_back(numberText(f.global.morris->sd[k], 3));
    }
    if (f.global.sobol) {
      row.push_back(fmt::format("{} ± {}", numberText(f.global.sobol->first[k], 2),
                                numberText(f.global.sobol->firstDeviation[k], 1)));
      row.push_back(fmt::format("{} ± {}", numberText(f.global.sobol->total[k], 2),
                                numberText(f.global.sobol->totalSd[k], 1)));
    }
    row.push_back(
        numberText(f.information->normalisedSensitivity[k] * shownFactor(f.coordinate), 3));
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// "elbow_flexion with 1 deg of noise"
std::string observationOf(const SensitivityFindings& f) {
  if (!f.observed.empty()) return f.observed;
  return fmt::format("{} with {} {} of noise", f.coordinate.name,
                     numberText(f.noise * shownFactor(f.coordinate)), shownUnit(f.coordinate));
}

/// In words, with its noise: "BRA.fiber_length (0.001 m)".
std::string channelWords(const SensitivityFindings& f, const bio::ChannelCandidate& channel) {
  using Kind = bio::Observable::Kind;
  const bool isAngle =
      (channel.what.kind == Kind::coordinate || channel.what.kind == Kind::speed) &&
      bio::findCoordinate(*f.model, channel.what.object).isRotation;
  const std::string unit = bio::unitOf(channel.what, *f.model);
  const double factor = isAngle ? bio::degreesPerRadian : 1;
  return fmt::format(
      "{} ({})", bio::nameOf(channel.what),
      isAngle ? withUnit(channel.sd * factor, channel.what.kind == Kind::speed ? "deg/s" : "deg")
              : withUnit(channel.sd, unitText(unit)));
}

Table gainTable(const SensitivityFindings& f, std::size_t most) {
  Table table{.title = "What other measurements would add",
              .columns = {"channel (noise)", "information [nats]", "parameter helped most",
                          "bound now ±", "bound then ±"}};
  for (const bio::ChannelGain& gain : f.gains) {
    if (table.rows.size() == most) break;
    table.rows.push_back({channelWords(f, gain.channel), numberText(gain.information, 3),
                          gain.parameter, numberText(gain.before, 3), numberText(gain.after, 3)});
  }
  return table;
}

/// Which further channel would tell most; empty where none would.
std::string gainSentence(const SensitivityFindings& f) {
  if (f.gains.empty() || f.gains.front().information < 0.1) return "";
  const bio::ChannelGain& best = f.gains.front();
  return fmt::format(
      " Of what could be measured beside it, {} would tell most: the bound on {} would fall from "
      "{} to {}.",
      channelWords(f, best.channel), best.parameter, numberText(best.before, 3),
      numberText(best.after, 3));
}

std::string verdictOf(const SensitivityFindings& f) {
  std::string text;
  for (const bio::Sweep& sweep : f.sweeps) {
    if (sweep.runs.empty()) continue;
    const auto most = std::max_element(
        sweep.runs.begin(), sweep.runs.end(),
        [](const bio::SweepRun& a, const bio::SweepRun& b) { return a.largest < b.largest; });
    text +=
        fmt::format("{} = {} instead of {} changes {} by up to {} {}. ", sweep.parameter.name,
                    withUnit(most->value, sweep.parameter.unit), numberText(sweep.parameter.value),
                    f.coordinate.name, numberText(most->largest * shownFactor(f.coordinate), 3),
                    shownUnit(f.coordinate));
  }
  if (!f.information) return text;
  const auto& information = *f.information;
  const auto count =
      std::count(information.identifiable.begin(), information.identifiable.end(), true);
  if (information.parameters.size() == 1) {
    return text +
           fmt::format("{} samples of {} determine {} to ±{} (Cramér–Rao bound).", f.samples,
                       observationOf(f), information.parameters[0].name,
                       withUnit(information.boundAlone[0], information.parameters[0].unit)) +
           gainSentence(f);
  }
  text += fmt::format(
      "{} from {} samples of {} (prior standard deviation at least halved). The {} is most "
      "sensitive "
      "to {}.",
      identifiableWords(count, static_cast<std::ptrdiff_t>(information.parameters.size())),
      f.samples, observationOf(f), f.observed.empty() ? "motion" : "measurement",
      information.parameters[ranking(information.normalisedSensitivity).front()].name);
  return text + gainSentence(f);
}

}  // namespace

double SensitivityFindings::shownFactor() const {
  return observed.empty() ? app::shownFactor(coordinate) : 1;
}
std::string SensitivityFindings::shownUnit() const {
  return observed.empty() ? app::shownUnit(coordinate) : "standard deviations of the noise";
}

std::vector<std::size_t> ranking(const Eigen::VectorXd& score) {
  std::vector<std::size_t> order(static_cast<std::size_t>(score.size()));
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return score[static_cast<Eigen::Index>(a)] > score[static_cast<Eigen::Index>(b)];
  });
  return order;
}

double shownFactor(const bio::Coordinate& coordinate) {
  return bio::positionUnit(coordinate.isRotation).factor;
}
std::string shownUnit(const bio::Coordinate& coordinate) {
  return bio::positionUnit(coordinate.isRotation).name;
}

void tellSensitivity(const SensitivityFindings& f, Summary& summary) {
  const std::string unit = shownUnit(f.coordinate);
  const double factor = shownFactor(f.coordinate);
  summary.set("status", "ok");
  summary.set("samples", f.samples);
  if (f.observed.empty()) summary.set("noise_" + unit, f.noise * factor);
  for (const bio::Sweep& sweep : f.sweeps) {
    auto runs = nlohmann::ordered_json::array();
    for (const bio::SweepRun& run : sweep.runs) {
      runs.push_back({{"value", run.value},
                      {"rms_change_" + unit, run.rms * factor},
                      {"max_change_" + unit, run.largest * factor},
                      {"completed", run.motion.outcome == bio::Outcome::completed}});
    }
    summary.set("sweep", {{"parameter", sweep.parameter.name},
                          {"unit", sweep.parameter.unit},
                          {"model_value", sweep.parameter.value},
                          {"runs", runs}});
  }
  if (!f.information) return;
  const bio::ParameterInformation& information = *f.information;
  auto parameters = nlohmann::ordered_json::array();
  for (const std::size_t i : ranking(information.normalisedSensitivity)) {
    const auto k = static_cast<Eigen::Index>(i);
    const info::Parameter& p = information.parameters[i];
    parameters.push_back(
        {{"name", p.name},
         {"unit", p.unit},
         {"value", p.start},
         {"prior_sd", p.prior->sd},
         {"normalised_sensitivity", information.normalisedSensitivity[k] * f.shownFactor()},
         {"bound_alone", orNull(information.boundAlone[k])},
         {"bound_joint", orNull(information.boundJoint[k])},
         {"identifiable", static_cast<bool>(information.identifiable[i])}});
  }
  summary.set("parameters", parameters);
  std::vector<std::string> names;
  for (const std::size_t i : ranking(informationGain(information))) {
    if (names.size() < 20) names.push_back(information.parameters[i].name);
  }
  summary.set("most_information", names);
  if (!f.observed.empty()) summary.set("observed", f.observed);
  auto further = nlohmann::ordered_json::array();
  for (const bio::ChannelGain& gain : f.gains) {
    further.push_back({{"channel", bio::nameOf(gain.channel.what)},
                       {"noise", gain.channel.sd},
                       {"unit", bio::unitOf(gain.channel.what, *f.model)},
                       {"information_nats", gain.information},
                       {"parameter", gain.parameter},
                       {"bound_before", gain.before},
                       {"bound_after", gain.after}});
  }
  if (!f.gains.empty()) summary.set("further_channels", further);
  summary.set("determined_combinations", information.determinedCombinations);
  summary.set("not_told_apart", information.sentences);
  summary.set("cost_ratio", f.costRatio);
  if (f.profile) {
    summary.set("profile", {{"parameter", f.profile->parameter.name},
                            {"bounded_below", f.profile->boundedBelow()},
                            {"bounded_above", f.profile->boundedAbove()}});
  }
  if (f.global.morris) summary.set("morris_runs", f.global.morris->runs);
  if (f.global.sobol) summary.set("sobol_runs", f.global.sobol->runs);
}

Report sensitivityReport(const SensitivityFindings& f) {
  Report report;
  report.title = fmt::format("Sensitivity of {} on {}", f.trialFiles.front(), f.modelFile);
  if (f.trialFiles.size() > 1) {
    report.title = fmt::format("Sensitivity of {} trials on {}", f.trialFiles.size(), f.modelFile);
  }
  report.verdict = verdictOf(f);
  if (!f.sweeps.empty()) {
    report.mainFigure = sweepFigure(f, f.sweeps.front());
    report.details.push_back(sweepTable(f, f.sweeps.front()));
  }
  if (auto excitations = excitationFigure(f.trial)) {
    excitations->title = fmt::format("Excitations of {}", f.trial.file);
    report.details.push_back(*std::move(excitations));
  }
  if (!f.information) return report;
  if (report.mainFigure) {
    report.details.push_back(courseFigure(f));
  } else {
    report.mainFigure = courseFigure(f);
  }
  const bio::ParameterInformation& information = *f.information;
  report.details.push_back(
      Section{"Influence on the motion", "By how much each parameter moves what is observed."});
  report.details.push_back(
      rankingTable(f, "Sorted by influence", information.normalisedSensitivity, 25));
  report.details.push_back(
      Section{"Identifiability", "How accurately these trials could determine each parameter."});
  report.details.push_back(
      Paragraph{"Bounds are Cramér–Rao standard deviations. Alone: every other parameter is known. "
                "Jointly: all are estimated together, each with its prior. A parameter is "
                "identifiable if its joint bound is at most half its prior standard deviation."});
  report.details.push_back(
      rankingTable(f, "Sorted by information gained", informationGain(information), 25));
  if (!information.sentences.empty()) {
    report.details.push_back(Section{"Parameters that are not separately identifiable"});
    for (const std::string& sentence : information.sentences) {
      report.details.push_back(Paragraph{sentence + "."});
    }
  }
  if (!f.gains.empty()) {
    report.details.push_back(gainTable(f, 12));
    report.details.push_back(Paragraph{
        "Each channel alone is added to what is measured, at the same times, with the noise "
        "given in brackets, which is usual in a laboratory."});
  }
  if (f.profile) report.details.push_back(profileFigure(*f.profile));
  if (f.global.morris || f.global.sobol) report.details.push_back(globalTable(f));
  report.details.push_back(
      Paragraph{fmt::format("Computing the motion with all {} sensitivities took {:.3g} times as "
                            "long as the motion alone.",
                            information.parameters.size(), f.costRatio)});
  return report;
}

}  // namespace app
