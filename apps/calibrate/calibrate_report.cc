#include "calibrate/calibrate_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "bio/model/units.h"
#include "calibrate/calibrate_tables.h"
#include "calibrate/held_out_prediction.h"
#include "calibrate/latent_excitations.h"
#include "options/excitation_figure.h"
#include "output/text.h"
#include "report/interval_drawing.h"

namespace app {
namespace {

/// Angles are shown in degrees, everything else in its unit.
bio::ShownUnit shownUnit(const bio::MeasuredGroup& channel) {
  if (channel.areAngles) return {bio::degreesPerRadian, "deg"};
  return {1, unitText(channel.unit)};
}

std::vector<double> inUnit(const Eigen::VectorXd& values, const bio::ShownUnit& unit) {
  const Eigen::VectorXd result = values * unit.factor;
  return {result.begin(), result.end()};
}

/// Where the samples of a series begin.
Eigen::Index beginOf(const bio::TrialSet& set, std::size_t series) {
  Eigen::Index begin = 0;
  for (std::size_t i = 0; i < series; ++i) begin += set.series()[i].values.size();
  return begin;
}

Figure overlay(const bio::TrialSet& set, std::size_t index, const Eigen::MatrixXd& before,
               const Eigen::MatrixXd& after, const char* role) {
  const bio::MeasuredSeries& series = set.series()[index];
  const Eigen::Index begin = beginOf(set, index), n = series.values.size();
  const std::string& file = set.trials()[series.trial].file;
  const Eigen::VectorXd was = before.middleCols(begin, n).transpose();
  const Eigen::VectorXd is = after.middleCols(begin, n).transpose();
  const bio::ShownUnit unit = shownUnit(set.channels()[series.channel]);
  const auto rms = [&](const Eigen::VectorXd& y) {
    return std::sqrt((y - series.values).squaredNorm() / static_cast<double>(n)) * unit.factor;
  };
  Figure figure{
      .title = fmt::format("{} ({})", file, role),
      .xLabel = "Time [s]",
      .yLabel = fmt::format("{} [{}]", nameOf(series.what), unit.name),
      .caption = fmt::format("RMS error {0:.3g} {2} before calibration, {1:.3g} {2} after.",
                             rms(was), rms(is), unit.name)};
  figure.series.push_back({.name = "measured",
                           .x = series.times,
                           .y = inUnit(series.values, unit),
                           .style = SeriesStyle::points});
  figure.series.push_back(
      {.name = "before", .x = series.times, .y = inUnit(was, unit), .style = SeriesStyle::dashed});
  figure.series.push_back({.name = "calibrated", .x = series.times, .y = inUnit(is, unit)});
  return figure;
}

/// Residuals of one channel.
Figure residualFigure(const CalibrateFindings& f, std::size_t channel) {
  const bio::MeasuredGroup& shown = f.training.channels()[channel];
  const bio::ShownUnit unit = shownUnit(shown);
  Figure figure{
      .title = measuresOnlyAngles(f.training) ? "Residuals" : "Residuals of " + shown.name,
      .xLabel = "Time [s]",
      .yLabel = fmt::format("Measured − calibrated [{}]", unit.name),
      .caption =
          "Residuals of the calibrated model. White noise scatters about 0; slow waves "
          "indicate an error of the model."};
  const auto add = [&](const bio::TrialSet& set, const Eigen::MatrixXd& after, bool held) {
    for (std::size_t i = 0; i < set.series().size() && figure.series.size() < 8; ++i) {
      const bio::MeasuredSeries& series = set.series()[i];
      if (set.channels()[series.channel].name != shown.name) continue;
      const Eigen::VectorXd r =
          series.values - after.middleCols(beginOf(set, i), series.values.size()).transpose();
      figure.series.push_back(
          {.name = set.trials()[series.trial].file + (held ? " (held out)" : ""),
           .x = series.times,
           .y = inUnit(r, unit),
           .style = held ? SeriesStyle::dashed : SeriesStyle::line});
    }
  };
  add(f.training, f.calibration.after, false);
  if (f.heldOut) add(*f.heldOut, f.calibration.heldOutAfter, true);
  return figure;
}

/// Mean interval between measured values of the first series [s].
double interval(const bio::TrialSet& set) {
  const std::vector<double>& times = set.series().front().times;
  return times.size() < 2 ? 0.0
                          : (times.back() - times.front()) / static_cast<double>(times.size() - 1);
}

Figure autocorrelationFigure(const CalibrateFindings& f) {
  const bio::ResidualNoise& noise = f.calibration.noise;
  const double step = interval(f.training);
  const double bound = 2 / std::sqrt(static_cast<double>(f.calibration.after.size()));
  Figure figure{.title = "Autocorrelation of the residuals",
                .xLabel = "Lag [s]",
                .yLabel = "Correlation [1]",
                .caption = "White noise stays within the band (two standard deviations)."};
  Series series{.name = "residuals"};
  Series band{.name = "white noise", .style = SeriesStyle::dashed};
  for (std::size_t k = 0; k < noise.autocorrelation.size(); ++k) {
    const double lag = static_cast<double>(k) * step;
    series.x.push_back(lag);
    series.y.push_back(noise.autocorrelation[k]);
    band.x.push_back(lag);
    band.y.push_back(0);
    band.bandLow.push_back(-bound);
    band.bandHigh.push_back(bound);
  }
  figure.series = {std::move(series), std::move(band)};
  return figure;
}

std::string intervalText(double lower, double upper) {
  if (std::isnan(lower) || std::isnan(upper)) return "–";
  const auto end = [](double x) {
    return std::isinf(x) ? std::string(x < 0 ? "−∞" : "∞") : numberText(x);
  };
  return fmt::format("{} … {}", end(lower), end(upper));
}

Table estimateTable(const CalibrateFindings& f) {
  const bool bootstrapped = f.options.bootstrap > 0;
  Table table{"",
              {"parameter", "unit", "model", "estimate", "± sd", "95 % interval", "prior or bounds",
               "data alone", "identifiable"},
              {}};
  table.columns[5] = fmt::format("{:g} % interval", f.options.confidence * 100);
  if (!f.options.profile.empty()) table.columns.push_back("profile interval");
  if (bootstrapped) table.columns.push_back("bootstrap interval");
  for (const bio::CalibratedParameter& parameter : f.calibration.parameters) {
    if (bio::isKnot(parameter.target)) continue;
    const auto& prior = parameter.asked.prior;
    std::vector<std::string> row = {
        parameter.asked.name,
        parameter.asked.unit,
        numberText(parameter.model),
        numberText(parameter.value),
        numberText(parameter.sd, 3),
        intervalText(parameter.lower, parameter.upper),
        prior ? fmt::format("{} ± {}", numberText(prior->mean), numberText(prior->sd, 3))
              : intervalText(parameter.asked.lower, parameter.asked.upper),
        std::isinf(parameter.determinacy.bound) ? "± ∞"
                                                : "± " + numberText(parameter.determinacy.bound, 3),
        parameter.identifiable ? "yes"
        : parameter.atBound    ? "at its bound"
                               : "no"};
    if (!f.options.profile.empty()) {
      row.push_back(parameter.profile && parameter.identifiable
                        ? intervalText(parameter.profile->lower, parameter.profile->upper)
                        : "–");
    }
    if (bootstrapped)
      row.push_back(intervalText(parameter.bootstrapLower, parameter.bootstrapUpper));
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// Estimates and what was known before, in deviations of the latter.
VectorDrawing intervals(const CalibrateFindings& f) {
  const double z = info::normalQuantile(f.options.confidence);
  std::vector<IntervalRow> rows;
  for (const bio::CalibratedParameter& parameter : f.calibration.parameters) {
    if (bio::isKnot(parameter.target)) continue;
    const auto scaled = [&](double value) { return (value - parameter.model) / parameter.priorSd; };
    IntervalRow row{.name = parameter.asked.name, .estimate = scaled(parameter.value)};
    if (const auto& prior = parameter.asked.prior) {
      row.before =
          std::pair(scaled(prior->mean - z * prior->sd), scaled(prior->mean + z * prior->sd));
    }
    if (!std::isnan(parameter.lower))
      row.interval = std::pair(scaled(parameter.lower), scaled(parameter.upper));
    rows.push_back(std::move(row));
  }
  return {"Estimates and priors",
          intervalDrawing(rows, "Difference from the model's value [prior sd]"),
          fmt::format("Bars are {:g} % confidence intervals. An estimate without a bar is not "
                      "identifiable or is at its bound.",
                      f.options.confidence * 100)};
}

Figure profileFigure(const bio::CalibratedParameter& parameter) {
  const info::Profile& profile = parameter.profile->profile;
  Figure figure{.title = fmt::format("Profile likelihood of {}", parameter.asked.name),
                .xLabel = info::label(parameter.asked),
                .yLabel = "Negative log posterior [nats]",
                .caption =
                    "The smallest cost with the parameter fixed and all others re-estimated. "
                    "Values below the dashed line are in the confidence region."};
  Series curve{.name = "profile"}, threshold{.name = "threshold", .style = SeriesStyle::dashed};
  for (const info::ProfilePoint& point : profile.points) {
    curve.x.push_back(point.value);
    curve.y.push_back(point.cost);
    threshold.x.push_back(point.value);
    threshold.y.push_back(profile.threshold);
  }
  figure.series = {std::move(curve), std::move(threshold)};
  return figure;
}

/// Sentence for residuals of more than noise; else empty.
std::string aboveNoise(const CalibrateFindings& f) {
  if (!f.calibration.leavesMoreThanNoise()) return "";
  return fmt::format(
      " Neighbouring samples scatter by only {:.3g} deg: these parameters do not explain the rest "
      "of the residual. Another parameter may, or an effect that the model lacks.",
      f.calibration.noiseFloor * bio::degreesPerRadian);
}

/// One sentence for each channel where not only angles were measured.
std::string channelNoiseText(const CalibrateFindings& f) {
  std::string text;
  for (std::size_t i = 0; i < f.training.channels().size(); ++i) {
    const bio::MeasuredGroup& channel = f.training.channels()[i];
    const bio::ResidualNoise& noise = f.calibration.channelNoise[i];
    const bio::ShownUnit unit = shownUnit(channel);
    const bool isGiven = channel.areAngles ? f.options.noise.has_value()
                                           : f.options.channelNoise.contains(channel.name);
    text += fmt::format("{}{}: {:.3g} {} {}", text.empty() ? "Noise of " : "; ", channel.name,
                        noise.sd * unit.factor, unit.name,
                        isGiven ? "(given)" : "(from the residuals)");
    if (noise.correlationTime > 1) {
      text += fmt::format(", {:.3g} samples count as one independent value", noise.correlationTime);
    }
  }
  return text + fmt::format(". The reduced χ² is {:.3g}.", f.calibration.reducedChiSquare);
}

std::string noiseText(const CalibrateFindings& f) {
  if (!measuresOnlyAngles(f.training)) return channelNoiseText(f);
  const bio::ResidualNoise& noise = f.calibration.noise;
  if (f.options.noise) {
    return fmt::format("White noise of {:.3g} deg was given; the reduced χ² is {:.3g}.{}",
                       noise.sd * bio::degreesPerRadian, f.calibration.reducedChiSquare,
                       f.calibration.reducedChiSquare > 1.5
                           ? " The residuals are larger than this noise: the model does not fit "
                             "the data to within the noise, and the intervals are too narrow."
                           : "");
  }
  if (noise.correlationTime <= 1) {
    return fmt::format(
               "The residuals are white with a standard deviation of {:.3g} deg, which was taken "
               "as the noise.",
               noise.sd * bio::degreesPerRadian) +
           aboveNoise(f);
  }
  return fmt::format(
             "The residuals have a standard deviation of {:.3g} deg and are correlated: {:.3g} "
             "samples ({:.2g} s) count as one independent value, so the intervals are {:.2g} times "
             "wider than for white noise. Part of the residual is error of the model; the bias "
             "that it causes in the estimates is not covered by the intervals.",
             noise.sd * bio::degreesPerRadian, noise.correlationTime,
             noise.correlationTime * interval(f.training), std::sqrt(noise.correlationTime)) +
         aboveNoise(f);
}

/// "fell from 12° to 1.49° on the calibration trial"
std::string changeWords(double before, double after, const std::string& unit, const char* role,
                        std::size_t trials) {
  const std::string was = fmt::format("{:.3g}{}", before, unit),
                    is = fmt::format("{:.3g}{}", after, unit);
  const std::string change =
      !std::isfinite(before) ? "is " + is
      : was == is            ? "stayed at " + is
                  : fmt::format("{} from {} to {}", after < before ? "fell" : "rose", was, is);
  return fmt::format("{} on the {} trial{}", change, role, trials == 1 ? "" : "s");
}

/// RMS error before and after: of the angles, or of the first channel if there are none.
struct Change {
  double before, after;
  std::string unit;  ///< as it follows a number
  std::string of;    ///< "of NAME ", or empty for angles
};
Change changeOf(const CalibrateFindings& f, bool heldOut) {
  const bio::Calibration& c = f.calibration;
  const bio::TrialSet* set = heldOut ? f.heldOut : &f.training;
  if (!set) return {};
  const Eigen::MatrixXd& before = heldOut ? c.heldOutBefore : c.before;
  const Eigen::MatrixXd& after = heldOut ? c.heldOutAfter : c.after;
  for (const bio::MeasuredGroup& channel : set->channels()) {
    if (channel.areAngles) return {rmse(*set, before), rmseAfter(f, heldOut), "°", ""};
  }
  const bio::MeasuredGroup& first = set->channels().front();
  return {std::sqrt(set->meanSquareOf(before, 0)), std::sqrt(set->meanSquareOf(after, 0)),
          " " + shownUnit(first).name, fmt::format("of {} ", first.name)};
}

std::string verdictOf(const CalibrateFindings& f) {
  const bio::Calibration& c = f.calibration;
  if (!c.failure.empty()) return fmt::format("No estimate: {}.", c.failure);
  std::ptrdiff_t all = 0, identifiable = 0;
  for (const auto& parameter : c.parameters) {
    all += !parameter.ofTrial;
    identifiable += !parameter.ofTrial && parameter.identifiable;
  }
  const Change training = changeOf(f, false), other = changeOf(f, true);
  std::string text = "RMS error " + training.of +
                     changeWords(training.before, training.after, training.unit, "calibration",
                                 f.training.trials().size());
  if (f.heldOut) {
    std::string heldOut =
        changeWords(other.before, other.after, other.unit, "held-out", f.heldOut->trials().size());
    for (const std::string verb : {"fell ", "rose "}) {  // "fell from … and from …"
      if (text.starts_with("RMS error " + training.of + verb) && heldOut.starts_with(verb))
        heldOut.erase(0, verb.size());
    }
    text += " and " + heldOut;
  }
  text += ". " + identifiableWords(identifiable, all) + ".";
  if (!c.converged)
    text += fmt::format(" The search found no minimum ({}).", info::describe(c.why));
  return text;
}

}  // namespace

Report calibrateReport(const CalibrateFindings& f) {
  const bio::Calibration& c = f.calibration;
  Report report;
  std::vector<std::string> files;
  for (const bio::Trial& trial : f.training.trials()) files.push_back(trial.file);
  report.title = fmt::format("Calibration of {} on {}", f.modelFile, fmt::join(files, ", "));
  report.verdict = verdictOf(f);
  if (!c.failure.empty()) return report;
  // what was not fitted is the better judge, so it comes first
  report.mainFigure = f.heldOut
                          ? overlay(*f.heldOut, 0, c.heldOutBefore, c.heldOutAfter, "held out")
                          : overlay(f.training, 0, c.before, c.after, "calibration");
  if (f.playback) report.details.push_back(*f.playback);
  if (f.heldOut) {
    report.details.push_back(
        Section{"Held-out trials",
                "Trials that were not fitted: how well the calibrated model predicts them."});
    report.details.push_back(predictionTable(f));
    for (std::size_t i = 1; i < f.heldOut->series().size(); ++i) {
      report.details.push_back(overlay(*f.heldOut, i, c.heldOutBefore, c.heldOutAfter, "held out"));
    }
  }
  report.details.push_back(
      Section{"Estimates",
              "What the calibration trials say of each parameter, beside what was known before."});
  report.details.push_back(estimateTable(f));
  for (const bio::CalibratedParameter& parameter : c.parameters) {
    if (!parameter.why.empty() && !bio::isKnot(parameter.target))
      report.details.push_back(Paragraph{parameter.why + "."});
  }
  report.details.emplace_back(intervals(f));
  addLatent(f, report);
  if (c.parameters.size() > 1) report.details.push_back(correlationTable(f));
  for (const bio::CalibratedParameter& parameter : c.parameters) {
    if (parameter.profile) report.details.push_back(profileFigure(parameter));
  }
  const std::size_t shown = f.heldOut ? 0 : 1;
  if (f.training.series().size() > shown) {
    report.details.push_back(
        Section{f.heldOut ? "Calibration trials" : "Other calibration trials",
                "Trials that were fitted, simulated before and after calibration."});
    for (std::size_t i = shown; i < f.training.series().size(); ++i) {
      report.details.push_back(overlay(f.training, i, c.before, c.after, "calibration"));
    }
  }
  addExcitations(
      excitationFigures(f.training.trials().front(),
                        f.heldOut ? &f.heldOut->trials().front() : nullptr, f.training.system()),
      report);
  report.details.push_back(Section{
      "Residuals", "What the calibrated model leaves unexplained, and what was taken as noise."});
  report.details.push_back(Paragraph{noiseText(f)});
  for (std::size_t i = 0; i < f.training.channels().size(); ++i) {
    report.details.push_back(residualFigure(f, i));
  }
  if (!c.noise.autocorrelation.empty()) report.details.push_back(autocorrelationFigure(f));
  if (c.starts.size() > 1) report.details.push_back(startTable(f));
  report.details.push_back(Paragraph{
      fmt::format("{} iterations; {}. “Data alone” is the Cramér–Rao bound without priors, all "
                  "parameters being unknown. A parameter counts as identifiable if this bound, "
                  "combined with the prior, is at most half the prior standard deviation.",
                  c.iterations, info::describe(c.why))});
  return report;
}

}  // namespace app
